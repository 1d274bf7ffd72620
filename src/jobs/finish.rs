//! End of a job of speeds: results that need all of them.

use std::sync::Arc;

use super::engine::{Engine, Live};
use super::error::Interruption;
use super::patience::patiently;
use super::progress::PhaseMonitor;
use super::{control, histories, validity};
use crate::analysis::kinds::document::Document;
use crate::analysis::kinds::kind::{ResolvedJob, Work};
use crate::analysis::kinds::sweep::{CRITICAL_SPEEDS, ERRORS, WHEEL_CRITICAL_SPEEDS};
use crate::analysis::resolved::ResolvedSweep;
use crate::analysis::result::Point;
use crate::analysis::run::{self, Evidence, ReducedSector};
use crate::response::campbell::DrivenCrossing;
use crate::store::jobs::{Failure, FailureCause};

/// Goes on with a job whose speeds are all finished: queues more speeds where it lacks them, or ends it.
pub(super) async fn speeds(engine: &Engine, job: &Live) -> Result<(), Interruption> {
    let points = engine.store.points(job.id).await?;
    if points.len() != job.speeds as usize {
        // Somebody else saw the last of them finished too, and has gone on with more.
        return Ok(());
    }
    let Work::Speeds(speeds) = Arc::clone(&job.request).work() else { return Ok(()) };
    if speeds.may_grow() {
        let driven = match speeds.concluded() {
            Some(sweep) if sweep.is_limited() => driven_crossings(engine, job, sweep).await?,
            _ => Vec::new(),
        };
        let (grown, finished) = (Arc::clone(&speeds), points.clone());
        let more = move || grown.more(&finished, &driven);
        if let Some(longer) = engine.computing.run(&job.watch, more).await? {
            return more_speeds(engine, job, longer).await;
        }
    }
    expect_completed(&points)?;
    match speeds.concluded() {
        Some(sweep) => conclude(engine, job, sweep, points).await,
        None => complete(engine, job, &[], None).await,
    }
}

/// Reduction that a sweep ran on.
async fn reduced(
    engine: &Engine,
    job: &Live,
    request: &ResolvedSweep,
) -> Result<Arc<ReducedSector>, Interruption> {
    let monitor = PhaseMonitor::uncounted(job.watch.clone());
    engine.reductions.get((request.model(), request.modes_per_speed()), request.fields(), monitor).await
}

/// Linear critical speeds in the range of a sweep that its scene can drive.
async fn driven_crossings(
    engine: &Engine,
    job: &Live,
    request: &ResolvedSweep,
) -> Result<Vec<DrivenCrossing>, Interruption> {
    let reduced = reduced(engine, job, request).await?;
    let (monitor, request) = (PhaseMonitor::uncounted(job.watch.clone()), request.clone());
    let compute = move || run::driven_crossings(&reduced, &request, &monitor);
    Ok(engine.computing.run(&job.watch, compute).await??)
}

/// Goes on with a request that has more speeds than before. Asking for the same speeds a second time changes nothing.
async fn more_speeds(engine: &Engine, job: &Live, request: Arc<dyn ResolvedJob>) -> Result<(), Interruption> {
    let speeds = request.speeds();
    let revised = engine.revise(job, request, speeds).await?;
    tracing::info!(job.id = %job.id, speeds, added = speeds - job.speeds, "goes on with more speeds");
    let added = job.speeds..revised.speeds;
    engine.tasks.run(revised.whose(), added);
    Ok(())
}

/// Computes the critical speeds of a sweep and marks its job successful.
async fn conclude(
    engine: &Engine,
    job: &Live,
    request: &ResolvedSweep,
    points: Vec<Point>,
) -> Result<(), Interruption> {
    let reduced = reduced(engine, job, request).await?;
    let points = validity::measured(engine, job, request, &reduced, points).await?;
    let errors = control::errors(engine, job, request, &points).await?;
    if let Some(case) = run::histories_wanted(request, &points) {
        histories::record(engine, job, &case, false, PhaseMonitor::uncounted(job.watch.clone())).await?;
    }
    let (settings, estimate) = (request.clone(), errors.clone());
    let monitor = PhaseMonitor::uncounted(job.watch.clone());
    let all = points.clone();
    let compute = move || run::critical_speeds(&reduced, &settings, &points, estimate.as_ref(), &monitor);
    let mut tables = engine.computing.run(&job.watch, compute).await??;
    let stored = engine.store.job(job.id).await?;
    if let Some(facts) = stored.as_ref().and_then(|job| job.facts.as_ref()) {
        let driven = tables.first().map(|table| &table.driven_crossings[..]);
        let evidence = Evidence { points: &all, errors: errors.as_ref(), driven, unfinished: false };
        let verdict = run::judge(request, &facts.units, evidence).verdict;
        patiently(&job.watch, || engine.store.record_verdict(job.id, verdict)).await?;
    }
    let plan = stored.and_then(|job| job.plan);
    tables.iter_mut().for_each(|table| table.plan.clone_from(&plan));
    let mut documents = (0..)
        .zip(&tables)
        .map(|(sensor, table)| Ok((Document::part(CRITICAL_SPEEDS, sensor), serde_json::to_string(table)?)))
        .collect::<Result<Vec<_>, serde_json::Error>>()?;
    if let Some(wheel) = run::wheel_critical_speeds(request, &all, errors.as_ref(), &tables) {
        documents.push((WHEEL_CRITICAL_SPEEDS, serde_json::to_string(&wheel)?));
    }
    if let Some(errors) = &errors {
        documents.push((ERRORS, serde_json::to_string(errors)?));
    }
    complete(engine, job, &documents, None).await
}

/// Fails a job of which no speed was completed.
fn expect_completed(points: &[Point]) -> Result<(), Interruption> {
    match run::nothing_completed(points) {
        None => Ok(()),
        Some(message) => {
            let failure = Failure { cause: FailureCause::NothingCompleted, message, violations: Vec::new() };
            Err(Interruption::Failed(failure))
        }
    }
}

/// Marks a job successful with the documents that conclude it, or the model it made.
pub(super) async fn complete(
    engine: &Engine,
    job: &Live,
    documents: &[(Document<'_>, String)],
    made: Option<&str>,
) -> Result<(), Interruption> {
    let write = || engine.store.complete_job(job.id, documents, made);
    let completed = patiently(&job.watch, write).await?;
    engine.forget(job.id);
    if !completed {
        // The job may just have been paused: the caller looks at it again.
        return Err(Interruption::NotWanted);
    }
    tracing::info!(job.id = %job.id, "successful");
    Ok(())
}
