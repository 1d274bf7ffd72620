-- Verdict in one word on a finished sweep: lists of jobs show it without reading its speeds.
alter table jobs add column verdict text check (verdict is null or verdict in ('clear', 'watch', 'undecided', 'act'));
