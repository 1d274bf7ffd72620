-- Whose models are. A model is its content: several owners may have uploaded the same, and each has it until he deletes it; with the last
-- owner it goes. Empty: where the service knows no owners.
create table model_owners (
    model       text    not null references models (id) on delete cascade,
    owner       text    not null,
    created_at  text    not null,
    primary key (model, owner)
) strict;

insert into model_owners (model, owner, created_at) select id, '', created_at from models;

create index models_by_owner on model_owners (owner);
create index jobs_by_owner on jobs (owner, id);

-- Keys belong to their owner as well.
create table owned_keys (
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

insert into owned_keys select '', key, fingerprint, status, location, body, created_at from idempotency_keys;

drop table idempotency_keys;
alter table owned_keys rename to idempotency_keys;

create index idempotency_keys_by_age on idempotency_keys (created_at);
