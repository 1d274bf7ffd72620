-- Answers already given to POSTs that carried an Idempotency-Key, to be given again when the POST is repeated.
create table idempotency_keys (
    key          text    not null primary key,
    -- Digest of route and body: the same key with another body is a mistake of the client.
    fingerprint  text    not null,
    status       integer not null,
    location     text    not null,
    body         text    not null check (json_valid(body)),
    created_at   text    not null
) strict;

create index idempotency_keys_by_age on idempotency_keys (created_at);
