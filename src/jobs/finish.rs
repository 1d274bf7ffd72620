//! End of a job of speeds: results that need all of them.

use super::engine::{Engine, Live};
use super::error::Interruption;
use super::patience::patiently;
use super::progress::PhaseMonitor;
use super::{control, histories};
use crate::analysis::resolved::{ResolvedCampaign, ResolvedSweep};
use crate::analysis::result::Point;
use crate::analysis::run;
use crate::store::jobs::{Failure, FailureCause, JobRequest};
use crate::store::results::Document;

/// Goes on with a job whose speeds are all finished: queues more speeds where it lacks them, or ends it.
pub(super) async fn speeds(engine: &Engine, job: &Live) -> Result<(), Interruption> {
    let points = engine.store.points(job.id).await?;
    if points.len() != job.speeds as usize {
        // Somebody else saw the last of them finished too, and has gone on with more.
        return Ok(());
    }
    match &job.request {
        JobRequest::Sweep(request) => sweep(engine, job, request, points).await,
        JobRequest::Campaign(request) => campaign(engine, job, request, points).await,
        _ => Ok(()),
    }
}

/// Queues more speeds of a sweep where it asks for them around its peaks, or computes its critical speeds, with which it is successful.
async fn sweep(
    engine: &Engine,
    job: &Live,
    request: &ResolvedSweep,
    points: Vec<Point>,
) -> Result<(), Interruption> {
    if request.is_refined() {
        let (settings, finished) = (request.clone(), points.clone());
        if let Some(refined) =
            engine.computing.run(&job.watch, move || run::refine(&settings, &finished)).await?
        {
            let speeds = refined.speeds().count();
            return more_speeds(engine, job, JobRequest::Sweep(Box::new(refined)), speeds).await;
        }
    }
    conclude(engine, job, request, points).await
}

/// Queues more designs of a campaign where its answer is undecided, or ends it.
async fn campaign(
    engine: &Engine,
    job: &Live,
    request: &ResolvedCampaign,
    points: Vec<Point>,
) -> Result<(), Interruption> {
    let (asked, finished) = (request.clone(), points.clone());
    if let Some(longer) =
        engine.computing.run(&job.watch, move || run::more_designs(&asked, &finished)).await?
    {
        let simulations = longer.simulations();
        return more_speeds(engine, job, JobRequest::Campaign(Box::new(longer)), simulations).await;
    }
    expect_completed(&points)?;
    complete(engine, job, &[], None).await
}

/// Goes on with a request that has so many `speeds`, more than before. Asking for the same speeds a second time changes nothing.
async fn more_speeds(
    engine: &Engine,
    job: &Live,
    request: JobRequest,
    speeds: u32,
) -> Result<(), Interruption> {
    let revised = engine.revise(job, request, speeds).await?;
    tracing::info!(job.id = %job.id, speeds, added = speeds - job.speeds, "goes on with more speeds");
    let added = job.speeds..revised.speeds;
    engine.tasks.run(revised.whose(), added);
    Ok(())
}

/// Computes the critical speeds of a sweep and marks it successful; a sweep that completed no speed has failed.
async fn conclude(
    engine: &Engine,
    job: &Live,
    request: &ResolvedSweep,
    points: Vec<Point>,
) -> Result<(), Interruption> {
    expect_completed(&points)?;
    let monitor = PhaseMonitor::uncounted(job.watch.clone());
    let reduced = engine
        .reductions
        .get((request.model(), request.modes_per_speed()), request.fields(), monitor)
        .await?;
    let errors = control::errors(engine, job, request, &points).await?;
    if let Some(case) = run::histories_wanted(request, &points) {
        histories::record(engine, job, &case, PhaseMonitor::uncounted(job.watch.clone())).await?;
    }
    let (settings, estimate) = (request.clone(), errors.clone());
    let monitor = PhaseMonitor::uncounted(job.watch.clone());
    let all = points.clone();
    let compute = move || run::critical_speeds(&reduced, &settings, &points, estimate.as_ref(), &monitor);
    let mut tables = engine.computing.run(&job.watch, compute).await??;
    let plan = engine.store.job(job.id).await?.and_then(|job| job.plan);
    tables.iter_mut().for_each(|table| table.plan.clone_from(&plan));
    let mut documents = (0..)
        .zip(&tables)
        .map(|(sensor, table)| Ok((Document::CriticalSpeeds(sensor), serde_json::to_string(table)?)))
        .collect::<Result<Vec<_>, serde_json::Error>>()?;
    if let Some(wheel) = run::wheel_critical_speeds(request, &all, errors.as_ref(), &tables) {
        documents.push((Document::WheelCriticalSpeeds, serde_json::to_string(&wheel)?));
    }
    if let Some(errors) = &errors {
        documents.push((Document::Errors, serde_json::to_string(errors)?));
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
    documents: &[(Document, String)],
    made: Option<&str>,
) -> Result<(), Interruption> {
    let write = || engine.store.complete_job(job.id, documents, made);
    if patiently(&job.watch, write).await? {
        tracing::info!(job.id = %job.id, "successful");
    }
    engine.forget(job.id);
    Ok(())
}
