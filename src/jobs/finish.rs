//! The end of a sweep: what can only be said of all its speeds together.

use super::control;
use super::engine::{Engine, Live};
use super::error::Halt;
use super::progress::PhaseMonitor;
use super::room::once_there_is_room;
use crate::analysis::request::SweepRequest;
use crate::analysis::run;
use crate::store::results::Document;

/// Computes the critical speeds of a sweep whose speeds are all finished and marks it successful.
pub(super) async fn sweep(engine: &Engine, job: &Live, request: &SweepRequest) -> Result<(), Halt> {
    let monitor = PhaseMonitor::uncounted(job.watch.clone());
    let reduced = engine.reductions.get(&request.model, request.modes(), monitor).await?;
    let points = engine.store.points(job.id).await?;
    let errors = control::errors(engine, job, request, &points).await?;
    let (settings, estimate) = (request.clone(), errors.clone());
    let monitor = PhaseMonitor::uncounted(job.watch.clone());
    let compute = move || run::critical_speeds(&reduced, &settings, &points, estimate.as_ref(), &monitor);
    let mut tables = engine.pool.run(compute).await??;
    let plan = engine.store.job(job.id).await?.and_then(|job| job.plan);
    tables.iter_mut().for_each(|table| table.plan.clone_from(&plan));
    let mut documents = (0..)
        .zip(&tables)
        .map(|(sensor, table)| Ok((Document::CriticalSpeeds(sensor), serde_json::to_string(table)?)))
        .collect::<Result<Vec<_>, serde_json::Error>>()?;
    if let Some(errors) = &errors {
        documents.push((Document::Errors, serde_json::to_string(errors)?));
    }
    complete(engine, job, &documents, None).await
}

/// Marks a job successful with the documents that conclude it, or the model it made.
pub(super) async fn complete(
    engine: &Engine,
    job: &Live,
    documents: &[(Document, String)],
    made: Option<&str>,
) -> Result<(), Halt> {
    let write = || engine.store.complete_job(job.id, documents, made);
    if once_there_is_room(&job.watch, write).await? {
        tracing::info!(job.id = %job.id, "successful");
    }
    engine.forget(job.id);
    Ok(())
}
