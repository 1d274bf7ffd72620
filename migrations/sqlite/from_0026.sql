-- Tables of version 26 as those of version 27: kinds and documents are text that the program knows, and the posted request is kept.
-- References are not checked meanwhile.
create table new_jobs (
    id              text    not null primary key check (length(id) = 36),
    kind            text    not null,
    status          text    not null default 'accepted'
                            check (status in ('accepted', 'running', 'paused', 'successful', 'failed', 'dismissed')),
    owner           text    not null default '',
    model           text,
    compared_model  text,
    modes_per_speed integer,
    facts           text    check (facts is null or json_valid(facts)),
    request         text    not null check (json_valid(request)),
    posted_to       text,
    posted          text    check (posted is null or json_valid(posted)),
    one_kind        integer not null default 0,
    vectors         text,
    revision        integer not null default 1,
    progress        integer not null default 0 check (progress between 0 and 100),
    phase           text    not null default '',
    speeds          integer not null check (speeds >= 0),
    finished        integer not null default 0 check (finished >= 0),
    diverged        integer not null default 0 check (diverged >= 0),
    failed          integer not null default 0 check (failed >= 0),
    stored_bytes    integer not null default 0 check (stored_bytes >= 0),
    crashes         integer not null default 0 check (crashes >= 0),
    parts           integer not null default 0 check (parts >= 0),
    plan            text    check (plan is null or json_valid(plan)),
    choice          text    check (choice is null or json_valid(choice)),
    error           text    check (error is null or json_valid(error)),
    name            text,
    tags            text    not null default '[]' check (json_valid(tags)),
    notes           text,
    deleted         integer not null default 0 check (deleted in (0, 1)),
    created_at      text    not null,
    started_at      text,
    finished_at     text,
    updated_at      text    not null,

    check ((status = 'failed') = (error is not null)),
    check ((status in ('successful', 'failed', 'dismissed')) = (finished_at is not null)),
    check (facts is not null or speeds = 0)
) strict;
insert into new_jobs (
    id, kind, status, owner, model, compared_model, modes_per_speed, facts, request, one_kind, vectors,
    revision, progress, phase, speeds, finished, diverged, failed, stored_bytes, crashes, parts, plan, choice,
    error, name, tags, notes, deleted, created_at, started_at, finished_at, updated_at
) select
    id, kind, status, owner, model, compared_model, modes_per_speed, facts, request, one_kind, vectors,
    revision, progress, phase, speeds, finished, diverged, failed, stored_bytes, crashes, parts, plan, choice,
    error, name, tags, notes, deleted, created_at, started_at, finished_at, updated_at
from jobs;
drop table jobs;
alter table new_jobs rename to jobs;
create index unfinished_jobs on jobs (model) where status in ('accepted', 'running', 'paused');
create index unfinished_comparisons on jobs (compared_model) where status in ('accepted', 'running', 'paused');
create index deleted_jobs on jobs (id) where deleted = 1;
create index finished_jobs on jobs (finished_at) where finished_at is not null;
create index jobs_by_owner on jobs (owner, id);
create index job_list on jobs (id, deleted, owner, kind, status, model, name, tags);

create table new_documents (
    job         text    not null references jobs (id) on delete cascade,
    name        text    not null,
    part        integer not null check (part >= 0),
    body        text    not null check (json_valid(body)),
    created_at  text    not null,
    primary key (job, name, part)
) strict;
insert into new_documents (job, name, part, body, created_at) select job, name, part, body, created_at from documents;
drop table documents;
alter table new_documents rename to documents;
