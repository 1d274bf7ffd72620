-- Bytes of the spectra once they are unpacked; null where they are not packed (written before) or there are none.
alter table speed_results add column unpacked_bytes integer check (unpacked_bytes >= 0);
