//! Jobs: their requests, their progress and their end.

mod advance;
mod delete;
mod find;
mod insert;
pub(super) mod job;
mod job_kind;
mod job_request;
mod label;
mod record;
mod revise;
mod row;
mod take_up;

pub use advance::Begun;
pub use delete::JobDeletion;
pub use find::JobFilter;
pub use insert::Insertion;
pub use job::{Chosen, Failure, FailureCause, Job, JobHead, JobId, SpeedCounts};
pub use job_kind::JobKind;
pub use job_request::JobRequest;
pub(super) use row::read;
pub use take_up::Unfinished;
