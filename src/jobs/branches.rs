//! Branches: followed leg by leg, each kept with all that the next one needs.

use super::engine::{Engine, Live};
use super::error::Interruption;
use super::finish;
use super::patience::patiently;
use super::progress::PhaseMonitor;
use crate::analysis::resolved::ResolvedBranches;
use crate::analysis::run;
use crate::store::results::Document;

/// Computes and stores branches, from where they were left.
pub(super) async fn run(engine: &Engine, job: &Live, asked: &ResolvedBranches) -> Result<(), Interruption> {
    let monitor = PhaseMonitor::whole(job.watch.clone());
    let sweep = asked.sweep();
    let uncounted = PhaseMonitor::uncounted(job.watch.clone());
    let reduced = engine.reductions.of_case(sweep, sweep.fields(), uncounted).await?;
    let (sector, request) = (reduced.clone(), asked.clone());
    let bytes = engine.computing.run(&job.watch, move || run::branches_memory(&sector, &request)).await?;
    let _memory = engine.memory.hold(bytes).await.map_err(Interruption::speed_memory)?;
    let mut legs = engine.store.legs(job.id).await?;
    let mut course = match engine.store.document(job.id, Document::BranchCourse).await? {
        Some(text) => Some(serde_json::from_str(&text)?),
        None => None,
    };
    while legs == 0 || course.is_some() {
        let (sector, request, monitor) = (reduced.clone(), asked.clone(), monitor.clone());
        let from = course.take();
        let follow = move || run::branch_leg(&sector, &request, from, &monitor);
        let (leg, next) = engine.computing.run(&job.watch, follow).await??;
        let (text, rest) =
            (serde_json::to_string(&leg)?, next.as_ref().map(serde_json::to_string).transpose()?);
        patiently(&job.watch, || engine.store.keep_leg(job.id, legs, &text, rest.as_deref())).await?;
        engine.computing.acquit(job.id);
        legs += 1;
        course = next;
    }
    finish::complete(engine, job, &[], None).await
}
