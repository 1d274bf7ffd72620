//! Life of a job: how it is prepared, computed speed by speed, finished, cancelled and resumed.
//!
//! ```text
//! POST ─ Jobs::submit ─→ jobs table ─→ line `prepare`  ─→ prepare: reduction, check
//!                                                             │ one task per speed
//!                                      line `speeds`   ←──────┘
//!                                      ↑      └─→ speed: run, commit its row ─→ the last one: finish
//!                                      └─────────── more speeds, with `refine` ←──────────────┘
//! ```
//!
//! A sweep up or down has one task out at a time: each speed queues the next once it is committed, with the state that the next
//! one starts from.
//!
//! Kinds of jobs differ in their units (`kinds::kind::Work`): speeds that are tasks of their own, legs one after the other (`legs`), or the whole at once
//! (`once`, `study`, `recorded`, `generation`). On one machine tasks wait in memory, where owners take turns (`turns`);
//! machines that share a database share queues there, carried by `apalis`. The tables of [`crate::store`] are what is
//! true. A handler looks there first, so a task that runs twice, or somewhere else, does no harm.
//!
//! Handlers are async and wait; what computes runs on the threads of a `pool::CpuPool`. Both lines give their
//! work to the same threads in order of arrival, and the line of speeds has no more tasks out than there are threads:
//! a small job is never more than a few speeds away from its turn. A reduction may take minutes of one thread: of the
//! large ones only one runs at a time (`memory`), so that with two threads or more the other jobs go on.

mod bending;
mod calibration;
mod choice;
#[cfg_attr(feature = "cluster", path = "cluster/shared/mod.rs")]
#[cfg_attr(not(feature = "cluster"), path = "cluster/alone/mod.rs")]
mod cluster;
mod computing;
mod control;
mod counters;
mod engine;
mod error;
mod euler_load;
mod fields;
mod finish;
mod generation;
mod handle;
mod histories;
mod legs;
mod machine;
mod mesh;
mod once;
mod patience;
mod perform;
mod planner;
mod plans;
mod prepare;
mod progress;
mod recorded;
mod reductions;
mod speed;
mod static_wheel;
mod stress;
mod study;
mod tasks;
mod time_left;
mod trials;
mod turns;
mod validity;
mod work;
mod workers;

pub use crate::memory::Allowance;
pub use crate::pool::Panicked;
pub use fields::{FieldSource, field_sector, sector_memory};
pub use handle::{Cancellation, Checked, Jobs, SubmitError};
pub use static_wheel::StaticWheelError;
pub use work::Work;
pub use workers::{Runner, Settings};
