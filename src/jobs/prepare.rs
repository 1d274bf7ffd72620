//! Preparation, the first task of a job: reduction, checks, and one task per missing speed.

use std::sync::Arc;

use super::engine::{Engine, Live};
use super::error::Interruption;
use super::progress::PhaseMonitor;
use super::{choice, finish, generation, legs, once, plans, recorded, study};
use crate::analysis::kinds::kind::Work;
use crate::analysis::resolved::ResolvedSweep;
use crate::analysis::run::{self, ReducedSector};
use crate::store::jobs::{Begun, JobId};

/// Prepares job `id`. Harmless to repeat: what is stored is not computed again.
pub(super) async fn prepare(engine: &Engine, id: JobId) -> Result<(), Interruption> {
    let Some(job) = engine.live(id).await? else { return Err(Interruption::NotWanted) };
    match engine.store.begin_job(id, &run::vectors()).await? {
        Begun::Yes => {}
        // The job may be paused, and continued before this preparation has ended: the caller looks at it again.
        Begun::Unwanted => return Err(Interruption::NotWanted),
        Begun::Elsewhere(vectors) => {
            engine.tasks.prepare_elsewhere(id, &vectors);
            return Ok(());
        }
    }
    let job = choice::made(engine, job).await?;
    match Arc::clone(&job.request).work() {
        Work::Once(once) => once::run(engine, &job, once).await,
        Work::Trials(study) => study::run(engine, &job, &study).await,
        Work::Recorded(case) => recorded::run(engine, &job, &case).await,
        Work::Speeds(_) => prepare_speeds(engine, &job).await,
        Work::Legs(legs) => legs::run(engine, &job, legs).await,
        Work::Model => generation::run(engine, &job).await,
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
    let mut reductions = Vec::new();
    for scene in job.request.scenes() {
        reductions.push(reduced(engine, job, scene).await?);
    }
    plans::keep(engine, job, reductions).await?;
    if let Work::Speeds(speeds) = Arc::clone(&job.request).work()
        && let Some(sweep) = speeds.concluded()
    {
        let (asked, has_controls) = (sweep.speeds().asked() as u32, sweep.control_speeds() > 0);
        job.watch.expect_phases(asked, speeds.may_grow(), has_controls);
    }

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
