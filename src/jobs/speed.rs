//! Run of one speed of one job: the unit of work.

use std::sync::Arc;
use std::sync::atomic::Ordering;

use super::engine::{Engine, Live};
use super::error::Interruption;
use super::finish;
use super::patience::patiently;
use super::progress::{PhaseMonitor, SpeedMonitor};
use crate::analysis::error::AnalysisError;
use crate::analysis::kinds::kind::Work;
use crate::analysis::result::{Point, Validity, ValidityVerdict};
use crate::analysis::run;
use crate::store::results::PackedSpeed;
use crate::store::tasks::RunSpeed;

/// Computes a speed and stores it; the run that finds itself last finishes the job.
pub(super) async fn run(engine: &Engine, RunSpeed { job: id, speed }: RunSpeed) -> Result<(), Interruption> {
    let Some(job) = engine.live(id).await? else { return Err(Interruption::NotWanted) };
    if engine.store.is_speed_finished(id, speed).await? {
        // The store may have failed, the first time, at what follows the speed.
        let finished = engine.store.finished_speeds(id).await?.len();
        return go_on(engine, &job, speed, finished as u32).await;
    }
    let Work::Speeds(speeds) = Arc::clone(&job.request).work() else { return Ok(()) };
    let (request, place) = speeds.speed(speed).map_err(AnalysisError::Refused)?;
    let request = request.into_owned();
    let monitor = PhaseMonitor::uncounted(job.watch.clone());
    let reduced = engine.reductions.of_sweep(&request, monitor).await?;

    let (before, _) = job.neighbours(speed);
    let start = match before {
        Some(before) => engine.store.end_state(id, before).await?,
        None => None,
    };
    let bytes = job.speed_bytes.load(Ordering::Relaxed);
    let memory = engine.memory.hold(bytes).await.map_err(Interruption::speed_memory)?;
    let monitor = SpeedMonitor::new(job.watch.clone(), speed);
    let whole = Arc::clone(&speeds);
    let compute = move || {
        let found = run::run_speed(&reduced, &request, place as usize, start.as_ref(), &monitor)?;
        let result = whole.kept(found, speed);
        let packed = PackedSpeed::of(&result)?;
        Ok::<_, Interruption>((result.point, packed, memory))
    };
    // Memory is held until the result is in the store.
    let computed = {
        let _running = engine.counters.speed_begins();
        engine.computing.run(&job.watch, compute).await?
    };
    let (point, packed, memory) = computed?;

    let kept = patiently(&job.watch, || engine.store.insert_speed(id, &packed)).await?;
    // What follows may want more memory than is left beside this.
    drop((packed, memory));
    let Some(finished) = kept else { return Ok(()) };
    engine.computing.acquit(id);
    job.watch.speeds_finished(finished, Some(speed));
    engine.counters.speed_finished(point.steps);
    warn_of_theory(&job, &point);
    tracing::info!(
        job.id = %id, speed, speed_rad_s = point.speed_rad_s, status = ?point.status,
        steps = point.steps, wall_time_s = point.wall_time_s,
        validity = ?point.validity_verdict(), validity_lacking = ?point.validity_lacking(),
        "finished speed {finished}/{}", job.speeds
    );
    go_on(engine, &job, speed, finished).await
}

/// Warns once per job that linear theory is in doubt or left, with the worst number of the first such speed; doubts of geometry are measured when
/// the sweep ends.
fn warn_of_theory(job: &Live, point: &Point) {
    let Some(Validity { verdict, checks, .. }) = &point.validity else { return };
    let Some(worst) = checks.first().filter(|_| *verdict >= ValidityVerdict::Doubtful) else { return };
    if job.watch.first_to_warn() {
        tracing::warn!(
            job.id = %job.id, speed_rad_s = point.speed_rad_s, verdict = ?verdict, what = ?worst.what, value = worst.value,
            doubtful_above = worst.doubtful_above, "the response leaves linear theory, or may leave it; other speeds of this job are not reported"
        );
    }
}

/// Goes on after a finished speed: ends the job, if all are `finished` with it, or queues the next one of a chain. Harmless to repeat.
async fn go_on(engine: &Engine, job: &Live, speed: u32, finished: u32) -> Result<(), Interruption> {
    if finished == job.speeds {
        finish::speeds(engine, job).await?;
    } else if let (_, Some(next)) = job.neighbours(speed) {
        engine.tasks.run(job.whose(), [next]);
    }
    Ok(())
}
