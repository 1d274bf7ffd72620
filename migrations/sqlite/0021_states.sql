-- Where the whole wheel was at a recorded speed: one more document.
--
-- The check is loosened in place, as in migration 20; a table that comes and goes makes every connection read the schema again.
pragma writable_schema = on;

update sqlite_schema set sql = replace(sql, '''wheel_critical_speeds''))', '''wheel_critical_speeds'', ''states''))')
where type = 'table' and name = 'documents';

pragma writable_schema = reset;

create table schema_changed (marker integer);
drop table schema_changed;
