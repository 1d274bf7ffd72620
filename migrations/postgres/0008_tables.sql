-- The tables of migrations/sqlite, where each says why it is. Text sorts and compares by its bytes, as in SQLite, and integers have 64
-- bits.
--
-- `rowid` is a column here: rows of models and of their owners are numbered as they come. Columns that indices cover for SQLite's sake are
-- left out of them: PostgreSQL stores large values elsewhere, and refuses them in an index.

-- What SQLite has of its own, for the same statements in both.
create function instr(whole text, part text) returns bigint
    language sql immutable strict parallel safe
    return position(part in whole);

-- An error where it is not, which refuses the row as well.
create function json_valid(body text) returns boolean
    language sql immutable parallel safe
    return body::json is not null;

create table models (
    rowid       bigint  not null unique generated always as identity,
    id          text    collate "C" not null primary key check (length(id) = 64),
    name        text    collate "C" not null,
    facts       text    collate "C" not null check (json_valid(facts)),
    size_bytes  bigint  not null check (size_bytes >= 0),
    created_at  text    collate "C" not null
);

create index models_by_age on models (created_at, id);

create table model_owners (
    rowid       bigint  not null unique generated always as identity,
    model       text    collate "C" not null references models (id) on delete cascade,
    owner       text    collate "C" not null,
    created_at  text    collate "C" not null,
    name        text    collate "C",
    tags        text    collate "C" not null default '[]' check (json_valid(tags)),
    notes       text    collate "C",
    primary key (model, owner)
);

create index models_by_owner on model_owners (owner);

create table reductions (
    model            text    collate "C" not null references models (id) on delete cascade,
    modes_per_speed  bigint  not null check (modes_per_speed >= 0),
    layout           bigint  not null,
    reduced          bytea   not null,
    report           text    collate "C" not null check (json_valid(report)),
    created_at       text    collate "C" not null,
    primary key (model, modes_per_speed)
);

create table trials (
    key         text    collate "C" not null primary key check (length(key) = 64),
    model       text    collate "C" not null references models (id) on delete cascade,
    version     text    collate "C" not null,
    body        text    collate "C" not null check (json_valid(body)),
    created_at  text    collate "C" not null
);

create index trials_by_model on trials (model);

create table jobs (
    id              text    collate "C" not null primary key check (length(id) = 36),
    kind            text    collate "C" not null,
    status          text    collate "C" not null default 'accepted'
                            check (status in ('accepted', 'running', 'paused', 'successful', 'failed', 'dismissed')),
    owner           text    collate "C" not null default '',
    model           text    collate "C",
    compared_model  text    collate "C",
    modes_per_speed bigint,
    facts           text    collate "C" check (facts is null or json_valid(facts)),
    request         text    collate "C" not null check (json_valid(request)),
    posted_to       text    collate "C",
    posted          text    collate "C" check (posted is null or json_valid(posted)),
    one_kind        bigint  not null default 0,
    revision        bigint  not null default 1,
    vectors         text    collate "C",
    progress        bigint  not null default 0 check (progress between 0 and 100),
    phase           text    collate "C" not null default '',
    speeds          bigint  not null check (speeds >= 0),
    finished        bigint  not null default 0 check (finished >= 0),
    diverged        bigint  not null default 0 check (diverged >= 0),
    failed          bigint  not null default 0 check (failed >= 0),
    stored_bytes    bigint  not null default 0 check (stored_bytes >= 0),
    crashes         bigint  not null default 0 check (crashes >= 0),
    parts           bigint  not null default 0 check (parts >= 0),
    plan            text    collate "C" check (plan is null or json_valid(plan)),
    choice          text    collate "C" check (choice is null or json_valid(choice)),
    error           text    collate "C" check (error is null or json_valid(error)),
    name            text    collate "C",
    tags            text    collate "C" not null default '[]' check (json_valid(tags)),
    notes           text    collate "C",
    deleted         bigint  not null default 0 check (deleted in (0, 1)),
    created_at      text    collate "C" not null,
    started_at      text    collate "C",
    finished_at     text    collate "C",
    updated_at      text    collate "C" not null,

    check ((status = 'failed') = (error is not null)),
    check ((status in ('successful', 'failed', 'dismissed')) = (finished_at is not null)),
    check (facts is not null or speeds = 0)
);

create index unfinished_jobs on jobs (model) where status in ('accepted', 'running', 'paused');
create index unfinished_comparisons on jobs (compared_model) where status in ('accepted', 'running', 'paused');
create index deleted_jobs on jobs (id) where deleted = 1;
create index finished_jobs on jobs (finished_at) where finished_at is not null;
create index jobs_by_owner on jobs (owner, id);

create table speed_results (
    job             text    collate "C" not null references jobs (id) on delete cascade,
    speed           bigint  not null check (speed >= 0),
    status          text    collate "C" not null check (status in ('completed', 'diverged', 'failed')),
    point           text    collate "C" not null check (json_valid(point)),
    spectra         bytea,
    unpacked_bytes  bigint  check (unpacked_bytes >= 0),
    wear            bytea,
    contact         bytea,
    created_at      text    collate "C" not null,
    primary key (job, speed)
);

create index spectra_sizes on speed_results (job, coalesce(unpacked_bytes, length(spectra)));

create table documents (
    job         text    collate "C" not null references jobs (id) on delete cascade,
    name        text    collate "C" not null,
    part        bigint  not null check (part >= 0),
    body        text    collate "C" not null check (json_valid(body)),
    created_at  text    collate "C" not null,
    primary key (job, name, part)
);

create table end_states (
    job    text    collate "C" not null primary key references jobs (id) on delete cascade,
    speed  bigint  not null check (speed >= 0),
    state  bytea   not null
);

create table idempotency_keys (
    owner        text    collate "C" not null,
    key          text    collate "C" not null,
    fingerprint  text    collate "C" not null,
    status       bigint  not null,
    location     text    collate "C" not null,
    body         text    collate "C" not null check (json_valid(body)),
    created_at   text    collate "C" not null,
    primary key (owner, key)
);

create index idempotency_keys_by_age on idempotency_keys (created_at);

create table calibrations (
    version     text    collate "C" not null,
    machine     text    collate "C" not null,
    body        text    collate "C" not null check (json_valid(body)),
    created_at  text    collate "C" not null,
    primary key (version, machine)
);

create table readiness (
    id      bigint  not null primary key check (id = 1),
    mark    text    collate "C" not null
);

-- Processes hear of each other's jobs: whoever follows one, or computes for it, looks it up when it has changed.
create function tell_of_job() returns trigger language plpgsql as $$
begin
    perform pg_notify('rubmap_jobs', coalesce(new.id, old.id));
    return null;
end
$$;

create trigger told after update or delete on jobs for each row execute function tell_of_job();

-- What one process does for all, such as a reduction, while it gives signs of life.
create table claims (
    name    text         collate "C" not null primary key,
    holder  text         collate "C" not null,
    until   timestamptz  not null
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
