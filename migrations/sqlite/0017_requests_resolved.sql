-- Requests are kept with the version of their form, and with how many of the last lists of speeds `refine` has added, which the
-- lists themselves said before.
update jobs set request = json_object(
    'schema', 1,
    'rounds', (
        select count(*) from json_each(jobs.request, '$.speeds') as list
        where case when list.type = 'object' then json_extract(list.value, '$.added') end
    ),
    'request', json(replace(request, ',"added":true', ''))
);
-- Settings in results of refined sweeps said it too; whoever asks with them again must not be refused.
update documents set body = replace(body, ',"added":true', '')
where name in ('critical_speeds', 'work_precision', 'campbell') and instr(body, ',"added":true') > 0;
