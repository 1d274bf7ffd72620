//! Jobs that are computed leg by leg, each leg stored with all that the next one needs.

use std::sync::Arc;

use super::engine::{Engine, Live};
use super::error::Interruption;
use super::finish;
use super::patience::patiently;
use super::progress::PhaseMonitor;
use crate::analysis::kinds::document::Document;
use crate::analysis::kinds::kind::Legs;

/// Computes and stores the legs of a job to its end, from where it was left.
pub(super) async fn run(engine: &Engine, job: &Live, legs: Arc<dyn Legs>) -> Result<(), Interruption> {
    let monitor = PhaseMonitor::whole(job.watch.clone());
    let uncounted = PhaseMonitor::uncounted(job.watch.clone());
    let reduced = engine.reductions.of_legs(legs.scene(), legs.has_euler_force(), uncounted).await?;
    let (sector, of) = (Arc::clone(&reduced), Arc::clone(&legs));
    let bytes = engine.computing.run(&job.watch, move || of.memory(&sector)).await?;
    let _memory = engine.memory.hold(bytes).await.map_err(Interruption::speed_memory)?;

    let names = legs.names();
    let (mut count, _) = engine.store.parts(job.id, names.leg).await?;
    let mut course = engine.store.document(job.id, Document::only(names.course)).await?;
    while count == 0 || course.is_some() {
        let (sector, legs) = (Arc::clone(&reduced), Arc::clone(&legs));
        let (from, monitor) = (course.take(), monitor.clone());
        let further = move || legs.leg(&sector, from.as_deref(), &monitor);
        let leg = engine.computing.run(&job.watch, further).await???;
        patiently(&job.watch, || engine.store.keep_leg(job.id, names, count, &leg)).await?;
        engine.computing.acquit(job.id);
        count += 1;
        course = leg.course;
    }
    finish::complete(engine, job, &[], None).await
}
