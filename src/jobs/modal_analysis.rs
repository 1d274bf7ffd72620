//! A modal analysis: one task from beginning to end.

use super::engine::{Engine, Live};
use super::error::Interruption;
use super::finish;
use super::progress::PhaseMonitor;
use crate::analysis::run;
use crate::store::jobs::JobRequest;
use crate::store::results::Document;

/// Computes and stores the Campbell diagram.
pub(super) async fn run(engine: &Engine, job: &Live) -> Result<(), Interruption> {
    let JobRequest::ModalAnalysis(request) = &job.request else { return Ok(()) };
    let monitor = PhaseMonitor::reduction_of_modal_analysis(job.watch.clone());
    let reduced = engine
        .reductions
        .get((request.model(), request.modes_per_speed()), request.fields(), monitor)
        .await?;
    let (settings, monitor) = (request.clone(), PhaseMonitor::modal_analysis(job.watch.clone()));
    let campbell = engine
        .computing
        .run(&job.watch, move || run::modal_analysis(&reduced, &settings, &monitor))
        .await??;
    finish::complete(engine, job, &[(Document::Campbell, serde_json::to_string(&campbell)?)], None).await
}
