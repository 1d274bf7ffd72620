-- Kind of vectors of the processor that a job was computed on: who repeats it on another one must not take last digits for a
-- defect. 'several' where it went on on another kind; null of jobs before.
alter table jobs add column vectors text;
