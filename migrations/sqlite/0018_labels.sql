-- What users call their jobs and models, to find them again; nothing is computed from it. Of a model it is the owner's: others may have
-- uploaded the same content and call it otherwise.
alter table jobs add column name  text;
alter table jobs add column tags  text not null default '[]' check (json_valid(tags));
alter table jobs add column notes text;
alter table model_owners add column name  text;
alter table model_owners add column tags  text not null default '[]' check (json_valid(tags));
alter table model_owners add column notes text;

-- A page of a listing is found here, whatever its filters: the rows of jobs hold requests of any size before their labels.
create index job_list on jobs (id, deleted, owner, kind, status, model, name, tags);
