-- An uploaded impeller sector.
--
-- The id is the digest of the package's *content*, so the same model uploaded twice, however it was zipped, is one
-- row. The zip itself lies beside the database as models/<id>.zip: it may be gigabytes and is only ever read whole.
create table models (
    id          text    not null primary key check (length(id) = 64),
    name        text    not null,
    -- What requests are checked against (sectors, contact nodes, units …), as JSON.
    facts       text    not null check (json_valid(facts)),
    -- Size of the zip as uploaded.
    size_bytes  integer not null check (size_bytes >= 0),
    created_at  text    not null
) strict;

create index models_by_age on models (created_at, id);

-- The expensive half of every job: a model reduced with one setting of the accuracy dial. Computed once, read by
-- every later job, gone with its model.
create table reductions (
    model            text    not null references models (id) on delete cascade,
    modes_per_speed  integer not null check (modes_per_speed >= 0),
    -- Layout of `reduced`; a program that knows another layout computes the reduction afresh.
    layout           integer not null,
    -- The reduced sector (postcard).
    reduced          blob    not null,
    -- What the reduction found and cost, as JSON: readable without the blob.
    report           text    not null check (json_valid(report)),
    created_at       text    not null,
    primary key (model, modes_per_speed)
) strict;
