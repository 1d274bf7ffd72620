//! Workers and helpers of a process that shares its tasks with others.

use std::sync::Arc;

use tokio::task::JoinHandle;
use tokio_util::sync::CancellationToken;

use super::tasks::SharedTasks;
use super::{queues, share};
use crate::jobs::engine::Engine;

/// Starts the workers and the helpers of a process; without `threads`, other processes do the work.
pub(in crate::jobs) fn start(
    _: &SharedTasks,
    engine: &Arc<Engine>,
    threads: usize,
    stop: &CancellationToken,
) -> (Vec<JoinHandle<()>>, Vec<JoinHandle<()>>) {
    let computes = threads > 0;
    let workers = if computes { queues::start(engine, threads, stop) } else { Vec::new() };
    (workers, share::start(engine, computes))
}
