-- A sixth kind of job, branches; its legs, and how far it has followed them.
--
-- The checks are loosened in place, as in migration 20; a table that comes and goes makes every connection read the schema again.
pragma writable_schema = on;

update sqlite_schema set sql = replace(sql, '''case_study''))', '''case_study'', ''branches''))') where type = 'table' and name = 'jobs';
update sqlite_schema set sql = replace(sql, '''states''))', '''states'', ''branches'', ''branch_course''))')
where type = 'table' and name = 'documents';

pragma writable_schema = reset;

create table schema_changed (marker integer);
drop table schema_changed;
