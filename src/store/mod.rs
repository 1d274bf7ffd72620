//! What is remembered: models, reductions, jobs and results in one `SQLite` file, packages, checkpoints and bases as files
//! beside it. The only SQL in the program.
//!
//! One function per question; rows become domain types here. All writes go through one connection, so transactions
//! never meet a busy database, and readers never wait for writers (WAL).

mod backup;
pub mod bases;
mod calibrations;
mod changes;
pub mod checkpoints;
mod computing;
mod end_states;
mod error;
mod folders;
mod handle;
pub mod idempotency;
pub mod jobs;
pub mod labels;
mod leftovers;
pub mod limits;
pub mod marks;
pub mod models;
mod packages;
mod packed;
pub mod queue;
mod readiness;
pub mod reductions;
mod reserve;
pub mod results;
mod sql;
mod sqlite;
pub mod states;
pub mod status;
mod stored_sensor;
mod stress;
mod time;
pub mod trials;
mod unfinished;
mod write;

pub use backup::{Backup, Findings, backup, check};
pub use changes::Changes;
pub use error::StoreError;
pub use handle::Store;
pub use readiness::Backlog;
