-- Processes hear of each other's jobs: whoever follows one, or computes for it, looks it up when it has changed.
create function tell_of_job() returns trigger language plpgsql as $$
begin
    perform pg_notify('rubmap_jobs', coalesce(new.id, old.id));
    return null;
end
$$;

create trigger told after update or delete on jobs for each row execute function tell_of_job();

-- What one process does for all, such as a reduction, while it gives signs of life.
create table claims (
    name    text         collate "C" not null primary key,
    holder  text         collate "C" not null,
    until   timestamptz  not null
);
