-- no-transaction
--
-- A third kind of job: generating a model. It needs no model and has no speeds; its `model` is what it made.
--
-- SQLite changes no column's constraints, so the table is made anew. With foreign keys on, dropping the old one would
-- take all results with it, and within a transaction they cannot be switched off: hence the first line. The
-- script may run again after a crash; its own transaction is all or nothing, and what it leaves it also accepts.
pragma foreign_keys = off;
begin immediate;

create table new_jobs (
    -- A version 7 UUID: sorting by id is sorting by age, which is what the listing pages through.
    id              text    not null primary key check (length(id) = 36),
    kind            text    not null check (kind in ('sweep', 'modal_analysis', 'model_generation')),
    status          text    not null default 'accepted'
                            check (status in ('accepted', 'running', 'successful', 'failed', 'dismissed')),
    -- The model computed from, or, once there is one, the model generated. No reference: finished jobs outlive it.
    model           text,
    modes_per_speed integer,
    -- The facts of the model computed from when the job was accepted, so that results can be read without the model.
    facts           text    check (facts is null or json_valid(facts)),
    -- The whole request as resolved.
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

    check ((status = 'failed') = (error is not null)),
    check ((status in ('successful', 'failed', 'dismissed')) = (finished_at is not null)),
    check (case kind
        when 'model_generation' then
            modes_per_speed is null and facts is null and speeds = 0 and (model is not null) = (status = 'successful')
        else modes_per_speed is not null and facts is not null and speeds >= 1 and model is not null
    end)
) strict;

insert into new_jobs (id, kind, status, model, modes_per_speed, facts, request, progress, phase, speeds, crashes,
    in_hand, error, created_at, started_at, finished_at, updated_at)
select id, kind, status, model, modes_per_speed, facts, request, progress, phase, speeds, crashes,
    in_hand, error, created_at, started_at, finished_at, updated_at
from jobs;

drop table jobs;
alter table new_jobs rename to jobs;

create index unfinished_jobs on jobs (model) where status in ('accepted', 'running');

commit;
pragma foreign_keys = on;
