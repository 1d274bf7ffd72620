//! Jobs: their requests, their progress and their end.

mod advance;
mod delete;
mod find;
mod insert;
pub(super) mod job;
pub(super) mod kept;
mod label;
mod record;
mod revise;
mod row;
mod take_up;

pub use advance::Begun;
pub use delete::JobDeletion;
pub use find::JobFilter;
pub use insert::{Insertion, NewJob};
pub use job::{Failure, FailureCause, Job, JobHead, JobId, Posted, SpeedCounts};
pub(super) use row::read;
pub use take_up::Unfinished;
