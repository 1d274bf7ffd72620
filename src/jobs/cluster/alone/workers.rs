//! Workers on tasks that machines share, which cannot exist in this build.

use std::sync::Arc;

use tokio::task::JoinHandle;
use tokio_util::sync::CancellationToken;

use super::tasks::SharedTasks;
use crate::jobs::engine::Engine;

/// Starts the workers and the helpers of a process that shares its tasks.
pub(in crate::jobs) fn start(
    tasks: &SharedTasks,
    _: &Arc<Engine>,
    _: usize,
    _: &CancellationToken,
) -> (Vec<JoinHandle<()>>, Vec<JoinHandle<()>>) {
    match *tasks {}
}
