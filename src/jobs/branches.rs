//! Branches of periodic responses, followed leg by leg.

use super::engine::{Engine, Live};
use super::error::Interruption;
use super::legs;
use super::progress::PhaseMonitor;
use crate::analysis::resolved::ResolvedBranches;
use crate::analysis::run;
use crate::store::Followed;

/// Computes and stores branches, from where they were left.
pub(super) async fn run(engine: &Engine, job: &Live, asked: &ResolvedBranches) -> Result<(), Interruption> {
    let monitor = PhaseMonitor::whole(job.watch.clone());
    let sweep = asked.sweep();
    let uncounted = PhaseMonitor::uncounted(job.watch.clone());
    let reduced = engine.reductions.of_case(sweep, sweep.fields(), uncounted).await?;
    let (sector, request) = (reduced.clone(), asked.clone());
    let bytes = engine.computing.run(&job.watch, move || run::branches_memory(&sector, &request)).await?;
    let _memory = engine.memory.hold(bytes).await.map_err(Interruption::speed_memory)?;
    let request = asked.clone();
    let further = move |course| run::branch_leg(&reduced, &request, course, &monitor);
    legs::follow(engine, job, Followed::Branches, further).await
}
