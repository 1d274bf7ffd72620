-- A seventh kind of job, campaigns, whose results are speeds as those of sweeps are.
alter table jobs drop constraint jobs_kind_check;
alter table jobs add constraint jobs_kind_check check (kind in
    ('sweep', 'modal_analysis', 'model_generation', 'study', 'case_study', 'branches', 'campaign'));
