-- Tables of a data folder.

create table models (
    id          text    not null primary key check (length(id) = 64),
    name        text    not null,
    -- Facts that requests are checked against (sectors, contact nodes, units …), as JSON.
    facts       text    not null check (json_valid(facts)),
    -- Size of the zip as uploaded, bytes.
    size_bytes  integer not null check (size_bytes >= 0),
    created_at  text    not null
) strict;

create index models_by_age on models (created_at, id);

-- Models belong to all who uploaded them; each has labels of his own.
create table model_owners (
    model       text    not null references models (id) on delete cascade,
    owner       text    not null,
    created_at  text    not null,
    name        text,
    tags        text    not null default '[]' check (json_valid(tags)),
    notes       text,
    primary key (model, owner)
) strict;

create index models_by_owner on model_owners (owner);

create table reductions (
    model            text    not null references models (id) on delete cascade,
    modes_per_speed  integer not null check (modes_per_speed >= 0),
    -- Layout of `reduced`; a program that knows another layout reduces again.
    layout           integer not null,
    -- Reduced sector (postcard).
    reduced          blob    not null,
    -- Findings and cost of the reduction, as JSON: readable without the blob.
    report           text    not null check (json_valid(report)),
    created_at       text    not null,
    primary key (model, modes_per_speed)
) strict;

-- Covers the reports, which are read without the blobs.
create index reduction_reports on reductions (model, layout, modes_per_speed, report);

create table jobs (
    -- A version 7 UUID: sorting by id is sorting by age, by which lists are paged.
    id              text    not null primary key check (length(id) = 36),
    -- Name of a kind in the program's list of kinds.
    kind            text    not null,
    status          text    not null default 'accepted'
                            check (status in ('accepted', 'running', 'paused', 'successful', 'failed', 'dismissed')),
    owner           text    not null default '',
    -- Model that the job computes from, or, once there is one, the model that it made. No reference: finished jobs outlive it.
    model           text,
    -- Second model, where two are compared.
    compared_model  text,
    modes_per_speed integer,
    -- Facts of the model when the job was accepted: results can be read without the model.
    facts           text    check (facts is null or json_valid(facts)),
    -- Whole request as resolved, with the settings chosen for it once they are.
    request         text    not null check (json_valid(request)),
    -- Request as it was posted, and where to; earlier versions did not keep it.
    posted_to       text,
    posted          text    check (posted is null or json_valid(posted)),
    -- Whether all of the job must be computed on processors with one kind of vectors, and that kind once it is known.
    one_kind        integer not null default 0,
    vectors         text,
    -- Revision of the numerics that computed the results.
    revision        integer not null default 1,
    -- Percent of the work done; never falls.
    progress        integer not null default 0 check (progress between 0 and 100),
    -- Part of the work that runs now, in words.
    phase           text    not null default '',
    -- Numbers of speeds: asked for by now, finished, and of these diverged and failed.
    speeds          integer not null check (speeds >= 0),
    finished        integer not null default 0 check (finished >= 0),
    diverged        integer not null default 0 check (diverged >= 0),
    failed          integer not null default 0 check (failed >= 0),
    -- Size of the results, bytes.
    stored_bytes    integer not null default 0 check (stored_bytes >= 0),
    -- Times the service died under this job since anything of it was last finished: a job that takes the service down with it (by
    -- exhausting the memory, say) must not do so for ever.
    crashes         integer not null default 0 check (crashes >= 0),
    -- Parts of the job's reduction that were stored when the service last died under it. More of them at the next death: something was
    -- finished in between, and `crashes` begins anew.
    parts           integer not null default 0 check (parts >= 0),
    -- Expected cost when the speeds were queued, as JSON.
    plan            text    check (plan is null or json_valid(plan)),
    -- Settings that were chosen for the job and why, as JSON.
    choice          text    check (choice is null or json_valid(choice)),
    error           text    check (error is null or json_valid(error)),
    name            text,
    tags            text    not null default '[]' check (json_valid(tags)),
    notes           text,
    -- Deleted jobs are not listed; their results go piece by piece.
    deleted         integer not null default 0 check (deleted in (0, 1)),
    created_at      text    not null,
    started_at      text,
    finished_at     text,
    updated_at      text    not null,

    check ((status = 'failed') = (error is not null)),
    check ((status in ('successful', 'failed', 'dismissed')) = (finished_at is not null)),
    check (facts is not null or speeds = 0)
) strict;

create index unfinished_jobs on jobs (model) where status in ('accepted', 'running', 'paused');
create index unfinished_comparisons on jobs (compared_model) where status in ('accepted', 'running', 'paused');
create index deleted_jobs on jobs (id) where deleted = 1;
create index finished_jobs on jobs (finished_at) where finished_at is not null;
create index jobs_by_owner on jobs (owner, id);
-- Covers lists of jobs, which read no request.
create index job_list on jobs (id, deleted, owner, kind, status, model, name, tags);

create table speed_results (
    job             text    not null references jobs (id) on delete cascade,
    -- Index of the speed in the request.
    speed           integer not null check (speed >= 0),
    status          text    not null check (status in ('completed', 'diverged', 'failed')),
    -- Credentials and summary, as JSON.
    point           text    not null check (json_valid(point)),
    -- Spectra, packed, with the bytes that they take unpacked: an order of magnitude more numbers than anything else here.
    spectra         blob,
    unpacked_bytes  integer check (unpacked_bytes >= 0),
    -- Wear and contact forces (postcard).
    wear            blob,
    contact         blob,
    created_at      text    not null,
    primary key (job, speed)
) strict;

create index spectra_sizes on speed_results (job, coalesce(unpacked_bytes, length(spectra)));

create table documents (
    job         text    not null references jobs (id) on delete cascade,
    -- Name of a document in the program's list of kinds.
    name        text    not null,
    -- Index of the sensor, speed or leg where there are several of that name; otherwise 0.
    part        integer not null check (part >= 0),
    body        text    not null check (json_valid(body)),
    created_at  text    not null,
    primary key (job, name, part)
) strict;

-- State from which the next speed of a sweep up or down starts.
create table end_states (
    job    text    not null primary key references jobs (id) on delete cascade,
    -- Index of the speed in the request.
    speed  integer not null check (speed >= 0),
    -- State (postcard).
    state  blob    not null
) strict;

create table trials (
    -- Digest of what was run, by which version of the program.
    key         text    not null primary key check (length(key) = 64),
    model       text    not null references models (id) on delete cascade,
    -- Version of the program; trials of others are dropped when a service starts.
    version     text    not null,
    -- Findings, as JSON.
    body        text    not null check (json_valid(body)),
    created_at  text    not null
) strict;

create index trials_by_model on trials (model);

create table calibrations (
    version     text    not null,
    -- Processor, number and kind of vectors, in words.
    machine     text    not null,
    -- Measured costs of steps, as JSON.
    body        text    not null check (json_valid(body)),
    created_at  text    not null,
    primary key (version, machine)
) strict;

create table idempotency_keys (
    owner        text    not null,
    key          text    not null,
    -- Digest of route and body: the same key with another body is a mistake of the client.
    fingerprint  text    not null,
    status       integer not null,
    location     text    not null,
    body         text    not null check (json_valid(body)),
    created_at   text    not null,
    primary key (owner, key)
) strict;

create index idempotency_keys_by_age on idempotency_keys (created_at);

create table readiness (
    id    integer not null primary key check (id = 1),
    -- Never the same twice.
    mark  text    not null
) strict;
