-- What steps cost on a kind of machine: services on several share these tables.
drop table calibrations;
create table calibrations (
    version     text    collate "C" not null,
    machine     text    collate "C" not null,
    body        text    collate "C" not null check (json_valid(body)),
    created_at  text    collate "C" not null,
    primary key (version, machine)
);

-- Processes that compute, while they give signs of life.
create table machines (
    process   text         collate "C" not null primary key,
    -- Name, processor and vectors, as JSON.
    machine   text         collate "C" not null check (json_valid(machine)),
    -- What steps cost on it, as JSON.
    costs     text         collate "C" not null check (json_valid(costs)),
    threads   bigint       not null,
    seen      timestamptz  not null
);
