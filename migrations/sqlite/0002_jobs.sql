-- What a user asked for and how far it is. This table, not the queue, is the truth about work: the queue is filled
-- from it again whenever the service starts.
create table jobs (
    -- A version 7 UUID: sorting by id is sorting by age, which is what the listing pages through.
    id              text    not null primary key check (length(id) = 36),
    kind            text    not null check (kind in ('sweep', 'modal_analysis')),
    status          text    not null default 'accepted'
                            check (status in ('accepted', 'running', 'successful', 'failed', 'dismissed')),
    -- No reference: finished jobs outlive the model they were computed from.
    model           text    not null,
    modes_per_speed integer not null,
    -- The model's facts when the job was accepted, so that results can be read without the model.
    facts           text    not null check (json_valid(facts)),
    -- The whole request as resolved.
    request         text    not null check (json_valid(request)),
    -- Percent of the work done; never falls.
    progress        integer not null default 0 check (progress between 0 and 100),
    -- What runs now, in words.
    phase           text    not null default '',
    -- Speeds asked for. Those finished are counted from speed_results.
    speeds          integer not null check (speeds >= 1),
    -- Times the service died under this job since anything of it was last finished: a job that takes the service down
    -- with it (by exhausting the memory, say) must not do so for ever.
    crashes         integer not null default 0 check (crashes >= 0),
    -- Whether a service has it in hand; one that ends in order lays it down.
    in_hand         integer not null default 0 check (in_hand in (0, 1)),
    -- Why the job failed, as JSON {cause, message, violations}.
    error           text    check (error is null or json_valid(error)),
    created_at      text    not null,
    started_at      text,
    finished_at     text,
    updated_at      text    not null,

    check ((status = 'failed') = (error is not null)),
    check ((status in ('successful', 'failed', 'dismissed')) = (finished_at is not null))
) strict;

create index unfinished_jobs on jobs (model) where status in ('accepted', 'running');

-- One finished speed of a sweep. A row is written once, in its own transaction, and never changes: what is here
-- survives a crash and is not computed again.
create table speed_results (
    job         text    not null references jobs (id) on delete cascade,
    -- Index of the speed in the request.
    speed       integer not null check (speed >= 0),
    status      text    not null check (status in ('completed', 'diverged', 'failed')),
    -- Credentials and summary, as JSON.
    point       text    not null check (json_valid(point)),
    -- Spectra (postcard): an order of magnitude more numbers than anything else here.
    spectra     blob,
    created_at  text    not null,
    primary key (job, speed)
) strict;

-- Progress counts finished speeds by how they ended, without touching the spectra.
create index speeds_by_status on speed_results (job, status);

-- A result computed once at the end of a job, stored as the JSON that is downloaded.
create table documents (
    job         text    not null references jobs (id) on delete cascade,
    name        text    not null check (name in ('campbell', 'critical_speeds')),
    -- Index of the sensor for critical_speeds, which has one document for each; otherwise 0.
    part        integer not null check (part >= 0),
    body        text    not null check (json_valid(body)),
    created_at  text    not null,
    primary key (job, name, part)
) strict;
