//! Run-ups: one run after the other, leg by leg.

use super::engine::{Engine, Live};
use super::error::Interruption;
use super::legs;
use super::progress::PhaseMonitor;
use crate::analysis::resolved::ResolvedRunUps;
use crate::analysis::run;
use crate::store::Followed;

/// Computes and stores run-ups, from where they were left.
pub(super) async fn run(engine: &Engine, job: &Live, asked: &ResolvedRunUps) -> Result<(), Interruption> {
    let monitor = PhaseMonitor::whole(job.watch.clone());
    let uncounted = PhaseMonitor::uncounted(job.watch.clone());
    let reduced = engine.reductions.of_run_ups(asked, uncounted).await?;
    let (sector, request) = (reduced.clone(), asked.clone());
    let bytes = engine.computing.run(&job.watch, move || run::run_ups_memory(&sector, &request)).await?;
    let _memory = engine.memory.hold(bytes).await.map_err(Interruption::speed_memory)?;
    let request = asked.clone();
    let further = move |course| run::run_up_leg(&reduced, &request, course, &monitor);
    legs::follow(engine, job, Followed::RunUps, further).await
}
