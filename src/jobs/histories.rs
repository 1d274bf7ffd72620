//! What happened at chosen speeds: histories of case studies and of sweeps.

use std::sync::Arc;

use futures::{StreamExt, TryStreamExt, stream};

use super::engine::{Engine, Live};
use super::error::Interruption;
use super::progress::PhaseMonitor;
use crate::analysis::monitor::Monitor;
use crate::analysis::resolved::ResolvedCaseStudy;
use crate::analysis::run;
use crate::store::results::Document;

/// Simulates the speeds of `case` side by side; their histories, one document each.
pub(super) async fn record(
    engine: &Engine,
    job: &Live,
    case: &ResolvedCaseStudy,
    monitor: PhaseMonitor,
) -> Result<Vec<(Document, String)>, Interruption> {
    let total = case.speeds().len();
    let mut running = stream::iter(0..total)
        .map(|place| record_one(engine, job, case, place))
        .buffer_unordered(engine.computing.threads());
    let mut documents = Vec::with_capacity(total);
    while let Some(document) = running.try_next().await? {
        documents.push(document);
        let done = documents.len();
        monitor
            .progress(done as f64 / total as f64, &format!("histories of {done} of {total} speeds recorded"));
    }
    Ok(documents)
}

async fn record_one(
    engine: &Engine,
    job: &Live,
    case: &ResolvedCaseStudy,
    place: usize,
) -> Result<(Document, String), Interruption> {
    let sweep = case.sweep();
    let monitor = PhaseMonitor::uncounted(job.watch.clone());
    let reduced = engine.reductions.of_sweep(sweep, monitor.clone()).await?;
    let asked = (Arc::clone(&reduced), case.clone());
    let bytes =
        engine.computing.run(&job.watch, move || run::histories_memory(&asked.0, &asked.1, place)).await?;
    let memory = engine.memory.hold(bytes).await.map_err(Interruption::speed_memory)?;
    let case = case.clone();
    let compute = move || {
        let _memory = memory;
        let histories = run::speed_histories(&reduced, &case, place, &monitor)?;
        Ok::<_, Interruption>((Document::Histories(histories.index), serde_json::to_string(&histories)?))
    };
    engine.computing.run(&job.watch, compute).await?
}
