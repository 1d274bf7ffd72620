-- A seventh kind of job, campaigns, whose results are speeds as those of sweeps are; and jobs that are set aside.
alter table jobs drop constraint jobs_kind_check;
alter table jobs add constraint jobs_kind_check check (kind in
    ('sweep', 'modal_analysis', 'model_generation', 'study', 'case_study', 'branches', 'campaign'));
alter table jobs drop constraint jobs_status_check;
alter table jobs add constraint jobs_status_check check (status in
    ('accepted', 'running', 'paused', 'successful', 'failed', 'dismissed'));
drop index unfinished_jobs;
create index unfinished_jobs on jobs (model) where status in ('accepted', 'running', 'paused');

-- A campaign may compare two models, neither of which goes while it is not finished.
alter table jobs add column compared_model text;
create index unfinished_comparisons on jobs (compared_model) where status in ('accepted', 'running', 'paused');
