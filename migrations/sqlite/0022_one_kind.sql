-- Whether all of a job must be computed on one kind of vectors; jobs before were computed wherever they were taken up.
alter table jobs add column one_kind integer not null default 0;
