-- An eighth kind of job, run-ups; their legs, and how far they have got.
alter table jobs drop constraint jobs_kind_check;
alter table jobs add constraint jobs_kind_check check (kind in
    ('sweep', 'modal_analysis', 'model_generation', 'study', 'case_study', 'branches', 'campaign', 'run_up'));
alter table documents drop constraint documents_name_check;
alter table documents add constraint documents_name_check check (name in
    ('campbell', 'critical_speeds', 'errors', 'work_precision', 'histories', 'wheel_critical_speeds', 'states', 'branches', 'branch_course',
     'run_ups', 'run_up_course', 'run_up_spectra'));
