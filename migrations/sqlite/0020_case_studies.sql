-- A fifth kind of job, case studies; contact in full beside every speed; and one table of critical speeds for the whole wheel.
--
-- Two checks are loosened in place, as SQLite's documentation of ALTER TABLE allows for checks ("the simpler procedure"): no row changes,
-- and what others add to these tables need not be repeated here. The change of a column below makes every connection read the schema again.
pragma writable_schema = on;

update sqlite_schema set sql = replace(sql, '''study''))', '''study'', ''case_study''))') where type = 'table' and name = 'jobs';
update sqlite_schema set sql = replace(sql, '''histories''))', '''histories'', ''wheel_critical_speeds''))')
where type = 'table' and name = 'documents';

pragma writable_schema = reset;

-- Forces per contact node and blade (postcard); null for speeds without contact, and for those of earlier versions.
alter table speed_results add column contact blob;
