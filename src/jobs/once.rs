//! Jobs that are one computation on one reduction.

use std::sync::Arc;

use super::engine::{Engine, Live};
use super::error::Interruption;
use super::finish;
use super::progress::PhaseMonitor;
use crate::analysis::kinds::kind::{Once, Reduction, Work};

/// Computes and stores the job.
pub(super) async fn run(engine: &Engine, job: &Live, once: &dyn Once) -> Result<(), Interruption> {
    let Reduction { model, modes_per_speed, fields } = once.reduction();
    let monitor = PhaseMonitor::reduction_of_once(job.watch.clone());
    let reduced = engine.reductions.get((model, modes_per_speed), fields, monitor).await?;
    let (request, monitor) = (Arc::clone(&job.request), PhaseMonitor::after_reduction(job.watch.clone()));
    let compute = move || match request.work() {
        Work::Once(once) => Some(once.compute(&reduced, &monitor)),
        _ => None,
    };
    let Some(computed) = engine.computing.run(&job.watch, compute).await? else { return Ok(()) };
    finish::complete(engine, job, &computed??, None).await
}
