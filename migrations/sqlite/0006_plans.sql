-- What a time step costs on this machine, measured once by each version of the program.
create table calibrations (
    version     text    not null,
    -- Processors of the machine: another number, another machine.
    processors  integer not null check (processors >= 1),
    -- The measured costs, as JSON.
    body        text    not null check (json_valid(body)),
    created_at  text    not null,
    primary key (version, processors)
) strict;

-- What the job was expected to cost when its speeds were queued, as JSON; sweeps only.
alter table jobs add column plan text check (plan is null or json_valid(plan));
