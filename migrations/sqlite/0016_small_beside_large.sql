-- The largest spectra of a job are asked for before they are read: with two thousand speeds a walk through their blobs (10 ms), here
-- one look. The report of a reduction is read at every poll and lies behind its blob.
create index reduction_reports on reductions (model, layout, modes_per_speed, report);
create index spectra_sizes on speed_results (job, coalesce(unpacked_bytes, length(spectra)));
