//! Jobs that are one computation on one reduction.

use std::sync::Arc;

use super::engine::{Engine, Live};
use super::error::Interruption;
use super::finish;
use super::progress::PhaseMonitor;
use crate::analysis::kinds::kind::Once;

/// Computes and stores the job.
pub(super) async fn run(engine: &Engine, job: &Live, once: Arc<dyn Once>) -> Result<(), Interruption> {
    let monitor = PhaseMonitor::reduction_of_once(job.watch.clone());
    let reduced = engine.reductions.of_once(once.reduction(), monitor).await?;
    let monitor = PhaseMonitor::after_reduction(job.watch.clone());
    let compute = {
        let once = Arc::clone(&once);
        move || once.compute(&reduced, &monitor)
    };
    let documents = engine.computing.run(&job.watch, compute).await???;
    finish::complete(engine, job, &documents, None).await
}
