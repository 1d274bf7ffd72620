-- Where the wheel was at the end of the last finished speed of a sweep up or down: what the next speed starts from.
-- Written with that speed's result, replaced by the next one's, gone when the job is final.
create table end_states (
    job    text    not null primary key references jobs (id) on delete cascade,
    -- Index of the speed in the request.
    speed  integer not null check (speed >= 0),
    -- The state (postcard).
    state  blob    not null
) strict;
