//! Store of the service: models, reductions, jobs and results in one `SQLite` file or on a PostgreSQL server; packages, checkpoints and
//! bases as files. The only SQL in the program.
//!
//! One function per question, asked of both databases in the same words except where `dialect` differs; rows become domain types here. All
//! writes to the file go through one connection, so transactions never meet a busy database, and readers never wait for writers (WAL). On a
//! server they meet transactions of other processes, so a transaction guards what it reads and then writes accordingly.

mod backup;
pub mod bases;
mod calibrations;
mod changes;
pub mod checkpoints;
#[cfg_attr(feature = "cluster", path = "cluster/shared/mod.rs")]
#[cfg_attr(not(feature = "cluster"), path = "cluster/alone/mod.rs")]
pub mod cluster;
mod computing;
#[cfg(test)]
mod contract;
mod dialect;
mod end_states;
mod error;
mod folders;
mod handle;
pub mod idempotency;
pub mod jobs;
pub mod labels;
mod leftovers;
mod legs;
pub mod limits;
pub mod marks;
mod migrations;
pub mod models;
mod objects;
mod packages;
mod packed;
mod postgres;
mod readiness;
pub mod reductions;
mod refusal;
mod reserve;
pub mod results;
mod session;
mod sql;
mod sqlite;
pub mod states;
pub mod status;
mod stored_sensor;
mod stress;
pub mod tasks;
#[cfg(test)]
mod testing;
mod time;
pub mod trials;
mod unfinished;
mod upgrade;
mod write;

pub use backup::{Backup, Findings, backup, check};
pub use changes::Changes;
pub use error::StoreError;
pub use handle::{LOCK, Store};
pub use postgres::migrate;
pub use readiness::Backlog;
pub use upgrade::{ACCOUNTS, Upgrade};
