-- no-transaction
--
-- A fourth kind of job: convergence studies. A job whose settings are chosen by pilot runs has no `modes_per_speed` until they are,
-- and a `choice` from then on; a study has many.
--
-- The tables are made anew as in 0004, and for the same reasons.
pragma foreign_keys = off;
begin immediate;

create table new_jobs (
    -- A version 7 UUID: sorting by id is sorting by age, which is what the listing pages through.
    id              text    not null primary key check (length(id) = 36),
    kind            text    not null check (kind in ('sweep', 'modal_analysis', 'model_generation', 'study')),
    status          text    not null default 'accepted'
                            check (status in ('accepted', 'running', 'successful', 'failed', 'dismissed')),
    -- The model computed from, or, once there is one, the model generated. No reference: finished jobs outlive it.
    model           text,
    modes_per_speed integer,
    -- The facts of the model computed from when the job was accepted, so that results can be read without the model.
    facts           text    check (facts is null or json_valid(facts)),
    -- The whole request as resolved, with the settings chosen for it once they are.
    request         text    not null check (json_valid(request)),
    -- Percent of the work done; never falls.
    progress        integer not null default 0 check (progress between 0 and 100),
    -- What runs now, in words.
    phase           text    not null default '',
    -- Speeds asked for. Those finished are counted from speed_results.
    speeds          integer not null check (speeds >= 0),
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
    -- Parts of the job's reduction that lay beside the database when the service last died under it. More of them at the next
    -- death: something was finished in between, and `crashes` begins anew.
    parts           integer not null default 0 check (parts >= 0),
    -- What the job was expected to cost when its speeds were queued, as JSON; sweeps only.
    plan            text    check (plan is null or json_valid(plan)),
    -- The settings that were chosen for it and why, as JSON.
    choice          text    check (choice is null or json_valid(choice)),

    check ((status = 'failed') = (error is not null)),
    check ((status in ('successful', 'failed', 'dismissed')) = (finished_at is not null)),
    check (case kind
        when 'model_generation' then
            modes_per_speed is null and facts is null and speeds = 0 and (model is not null) = (status = 'successful')
        else facts is not null and speeds >= 1 and model is not null
    end)
) strict;

insert into new_jobs (id, kind, status, model, modes_per_speed, facts, request, progress, phase, speeds, crashes,
    in_hand, error, created_at, started_at, finished_at, updated_at, parts, plan)
select id, kind, status, model, modes_per_speed, facts, request, progress, phase, speeds, crashes,
    in_hand, error, created_at, started_at, finished_at, updated_at, parts, plan
from jobs;

drop table jobs;
alter table new_jobs rename to jobs;

create index unfinished_jobs on jobs (model) where status in ('accepted', 'running');

create table new_documents (
    job         text    not null references jobs (id) on delete cascade,
    name        text    not null
                        check (name in ('campbell', 'critical_speeds', 'errors', 'work_precision', 'histories')),
    -- Index of the sensor for critical_speeds and of the speed for histories, which have one document for each; otherwise 0.
    part        integer not null check (part >= 0),
    body        text    not null check (json_valid(body)),
    created_at  text    not null,
    primary key (job, name, part)
) strict;

insert into new_documents (job, name, part, body, created_at) select job, name, part, body, created_at from documents;

drop table documents;
alter table new_documents rename to documents;

-- Runs that are compared with others: of studies, of pilots, of controls. Kept for every later job that asks for the same, gone with
-- their model.
create table if not exists trials (
    -- Digest of what was run, by which version of the program.
    key         text    not null primary key check (length(key) = 64),
    model       text    not null references models (id) on delete cascade,
    -- Of the program; those of others are dropped when a service starts.
    version     text    not null,
    -- What was found, as JSON.
    body        text    not null check (json_valid(body)),
    created_at  text    not null
) strict;

create index if not exists trials_by_model on trials (model);

commit;
pragma foreign_keys = on;
