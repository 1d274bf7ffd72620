-- A seventh kind of job, campaigns, whose results are speeds as those of sweeps are; and jobs that are set aside.
--
-- The checks are loosened in place, as in migration 20; a table that comes and goes makes every connection read the schema again.
pragma writable_schema = on;

update sqlite_schema
set sql = replace(replace(sql, '''branches''))', '''branches'', ''campaign''))'), '''running'', ''successful''', '''running'', ''paused'', ''successful''')
where type = 'table' and name = 'jobs';

pragma writable_schema = reset;

create table schema_changed (marker integer);
drop table schema_changed;

drop index unfinished_jobs;
create index unfinished_jobs on jobs (model) where status in ('accepted', 'running', 'paused');

-- A campaign may compare two models, neither of which goes while it is not finished.
alter table jobs add column compared_model text;
create index unfinished_comparisons on jobs (compared_model) where status in ('accepted', 'running', 'paused');
