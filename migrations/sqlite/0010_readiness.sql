-- One row that is written anew whenever somebody asks whether the service is ready, and read back by another connection.
create table if not exists readiness (
    id      integer not null primary key check (id = 1),
    -- Never the same twice.
    mark    text    not null
) strict;
