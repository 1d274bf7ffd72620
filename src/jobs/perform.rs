//! Work of a task, from its turn to its end.

use std::sync::Arc;

use super::engine::Engine;
use super::{prepare, speed};
use crate::store::jobs::JobId;
use crate::store::tasks::RunSpeed;

/// Prepares a job.
pub(super) async fn prepare_job(engine: Arc<Engine>, job: JobId, (): ()) {
    let place = engine.tasks.preparing(job);
    let wanted = engine.attend(job, || prepare::prepare(&engine, job)).await;
    drop(place);
    if !wanted {
        engine.take_up_again(job).await;
    }
}

/// Computes a speed of a job.
pub(super) async fn run_speed(engine: Arc<Engine>, job: JobId, speed: u32) {
    let task = RunSpeed { job, speed };
    let place = engine.tasks.running(task);
    let wanted = engine.attend(job, || speed::run(&engine, task)).await;
    drop(place);
    if !wanted {
        engine.take_up_again(job).await;
    }
}
