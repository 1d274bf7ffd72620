-- What is being computed is marked by files beside the database (store/computing.rs), which need no flush of the disk: a
-- job that merely waits is not blamed for the end of the service.
alter table jobs drop column in_hand;

-- Whose the job is; empty where the service knows no owners.
alter table jobs add column owner text not null default '';
