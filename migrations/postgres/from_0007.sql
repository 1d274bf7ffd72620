-- Tables of version 7 as those of version 8: kinds and documents are text that the program knows, and the posted request is kept.
do $$
declare name text;
begin
    for name in
        select conname from pg_constraint
        where conrelid = 'jobs'::regclass and contype = 'c' and pg_get_constraintdef(oid) ~ '\mkind\M'
    loop
        execute format('alter table jobs drop constraint %I', name);
    end loop;
end
$$;
alter table documents drop constraint documents_name_check;
alter table jobs add column posted_to text collate "C";
alter table jobs add column posted text collate "C" check (posted is null or json_valid(posted));
alter table jobs add check (facts is not null or speeds = 0);
alter table jobs alter column compared_model type text collate "C";
