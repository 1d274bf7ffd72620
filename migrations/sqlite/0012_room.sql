-- Finished speeds of the job, counted as they come: a listing need not look at them.
alter table jobs add column finished integer not null default 0 check (finished >= 0);
alter table jobs add column diverged integer not null default 0 check (diverged >= 0);
alter table jobs add column failed   integer not null default 0 check (failed >= 0);
-- Bytes that its results take.
alter table jobs add column stored_bytes integer not null default 0 check (stored_bytes >= 0);
-- A deleted job is seen by nobody; its rows go bit by bit, and it with the last of them.
alter table jobs add column deleted integer not null default 0 check (deleted in (0, 1));

update jobs set
    finished = (select count(*) from speed_results where job = jobs.id),
    diverged = (select count(*) from speed_results where job = jobs.id and status = 'diverged'),
    failed   = (select count(*) from speed_results where job = jobs.id and status = 'failed'),
    stored_bytes =
        (select coalesce(sum(length(point) + coalesce(length(spectra), 0) + coalesce(length(wear), 0)), 0)
         from speed_results where job = jobs.id)
        + (select coalesce(sum(length(body)), 0) from documents where job = jobs.id);

drop index speeds_by_status;
create index deleted_jobs on jobs (id) where deleted = 1;
create index finished_jobs on jobs (finished_at) where finished_at is not null;
