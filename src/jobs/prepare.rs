//! Preparation, the first task of a job: reduction, checks, and one task per missing speed.

use std::sync::Arc;

use super::engine::{Engine, Live};
use super::error::Interruption;
use super::progress::PhaseMonitor;
use super::{branches, case_study, choice, finish, generation, modal_analysis, plans, run_ups, study};
use crate::analysis::resolved::ResolvedSweep;
use crate::analysis::run::{self, ReducedSector};
use crate::store::jobs::{Begun, JobId, JobRequest};

/// Prepares job `id`. Harmless to repeat: what is stored is not computed again.
pub(super) async fn prepare(engine: &Engine, id: JobId) -> Result<(), Interruption> {
    let Some(job) = engine.live(id).await? else { return Err(Interruption::NotWanted) };
    match engine.store.begin_job(id, &run::vectors()).await? {
        Begun::Yes => {}
        Begun::Unwanted => return Ok(()),
        Begun::Elsewhere(vectors) => {
            engine.tasks.prepare_elsewhere(id, &vectors);
            return Ok(());
        }
    }
    match &job.request {
        JobRequest::Sweep(request) => {
            let job = choice::sweep(engine, Arc::clone(&job), request).await?;
            prepare_speeds(engine, &job).await
        }
        JobRequest::ModalAnalysis(request) => {
            let job = choice::modal_analysis(engine, Arc::clone(&job), request).await?;
            modal_analysis::run(engine, &job).await
        }
        JobRequest::ModelGeneration(parameters) => generation::run(engine, &job, parameters).await,
        JobRequest::Study(request) => study::run(engine, &job, request).await,
        JobRequest::CaseStudy(case) => case_study::run(engine, &job, case).await,
        JobRequest::Branches(asked) => branches::run(engine, &job, asked).await,
        JobRequest::RunUps(asked) => run_ups::run(engine, &job, asked).await,
        JobRequest::Campaign(_) => prepare_speeds(engine, &job).await,
    }
}

/// Reduction that a sweep rests on, against which the sweep is checked.
async fn reduced(
    engine: &Engine,
    job: &Live,
    request: &ResolvedSweep,
) -> Result<Arc<ReducedSector>, Interruption> {
    let monitor = PhaseMonitor::reduction_of_sweep(job.watch.clone());
    let reduced = engine.reductions.of_sweep(request, monitor).await?;
    let (checked, monitor) = (request.clone(), PhaseMonitor::uncounted(job.watch.clone()));
    let sector = Arc::clone(&reduced);
    engine.computing.run(&job.watch, move || run::check(&sector, &checked, &monitor)).await??;
    Ok(reduced)
}

/// Prepares a job whose speeds are tasks of their own.
async fn prepare_speeds(engine: &Engine, job: &Live) -> Result<(), Interruption> {
    let reductions = match &job.request {
        JobRequest::Sweep(request) => (reduced(engine, job, request).await?, None),
        // All designs of a model rest on the same one.
        JobRequest::Campaign(campaign) => {
            let own = reduced(engine, job, campaign.sweep()).await?;
            match campaign.compared() {
                Some(sweep) => (own, Some(reduced(engine, job, sweep).await?)),
                None => (own, None),
            }
        }
        _ => return Ok(()),
    };
    plans::keep(engine, job, reductions).await?;

    let finished = engine.store.finished_speeds(job.id).await?;
    let mut missing = job.chain.clone().unwrap_or_else(|| (0..job.speeds).collect());
    missing.retain(|speed| !finished.contains(speed));
    if job.chain.is_some() {
        // The end of each speed of a chain queues the next one.
        missing.truncate(1);
    }
    job.watch.speeds_finished(finished.len() as u32, None);
    tracing::info!(job.id = %job.id, speeds = job.speeds, finished = finished.len(), "prepared");
    if missing.is_empty() {
        return finish::speeds(engine, job).await;
    }
    engine.tasks.run(job.whose(), missing);
    Ok(())
}
