-- Revision of the numerics that a job's results are of; those before were of the first.
alter table jobs add column revision integer not null default 1;
-- Reductions are known by the layout in which they are stored and the revision of their numbers.
update reductions set layout = 1000000 * layout + 1;
