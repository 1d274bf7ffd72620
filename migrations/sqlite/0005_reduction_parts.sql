-- Parts of the job's reduction that lay beside the database when the service last died under it. More of them at the next
-- death: something was finished in between, and `crashes` begins anew.
alter table jobs add column parts integer not null default 0 check (parts >= 0);
