-- An eighth kind of job, run-ups; their legs, and how far they have got.
--
-- The checks are loosened in place, as in migration 20; a table that comes and goes makes every connection read the schema again.
pragma writable_schema = on;

update sqlite_schema set sql = replace(sql, '''campaign''))', '''campaign'', ''run_up''))') where type = 'table' and name = 'jobs';
update sqlite_schema set sql = replace(sql, '''branch_course''))', '''branch_course'', ''run_ups'', ''run_up_course'', ''run_up_spectra''))')
where type = 'table' and name = 'documents';

pragma writable_schema = reset;

create table schema_changed (marker integer);
drop table schema_changed;
