//! The unit of work: one speed of one job.

use super::engine::Engine;
use super::error::Halt;
use super::finish;
use super::progress::{PhaseMonitor, SpeedMonitor};
use super::room::once_there_is_room;
use crate::analysis::run;
use crate::store::jobs::JobRequest;
use crate::store::queue::RunSpeed;

/// Computes a speed and commits it; the one that finds itself last finishes the job.
pub(super) async fn run(engine: &Engine, RunSpeed { job: id, speed }: RunSpeed) -> Result<(), Halt> {
    let Some(job) = engine.live(id).await? else { return Ok(()) };
    let JobRequest::Sweep(request) = &job.request else { return Ok(()) };
    if engine.store.is_speed_finished(id, speed).await? {
        return Ok(());
    }
    let monitor = PhaseMonitor::uncounted(job.watch.clone());
    let reduced = engine.reductions.get(&request.model, request.modes(), monitor).await?;

    let (before, after) = job.neighbours(speed);
    let start = match before {
        Some(before) => engine.store.end_state(id, before).await?,
        None => None,
    };
    let (settings, monitor) = (request.clone(), SpeedMonitor::new(job.watch.clone(), speed));
    let compute = move || run::run_speed(&reduced, &settings, speed as usize, start.as_ref(), &monitor);
    let result = {
        let _running = engine.counters.speed_begins();
        engine.pool.run(compute).await??
    };

    let finished = once_there_is_room(&job.watch, || engine.store.insert_speed(id, &result)).await?;
    job.watch.speeds_finished(finished, Some(speed));
    let point = &result.point;
    engine.counters.speed_finished(point.steps);
    tracing::info!(
        job.id = %id, speed, speed_rad_s = point.speed_rad_s, status = ?point.status,
        steps = point.steps, wall_time_s = point.wall_time_s,
        "finished speed {finished}/{}", job.speeds
    );
    if finished == job.speeds {
        finish::sweep(engine, &job, request).await?;
    } else if let Some(next) = after {
        engine.queue.push_speeds(id, &[next]).await?;
        engine.new_speeds.notify_one();
    }
    Ok(())
}
