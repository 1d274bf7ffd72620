-- What steps cost on a kind of machine, not only on one with so many processors: data folders are moved, and services share tables.
drop table calibrations;
create table calibrations (
    version     text    not null,
    -- Processor, number and kind of vectors, in words.
    machine     text    not null,
    -- The measured costs, as JSON.
    body        text    not null check (json_valid(body)),
    created_at  text    not null,
    primary key (version, machine)
) strict;
