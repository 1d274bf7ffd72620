//! Histories at chosen speeds, for case studies and for sweeps.

use std::sync::Arc;

use futures::{StreamExt, TryStreamExt, stream};

use super::engine::{Engine, Live};
use super::error::Interruption;
use super::patience::patiently;
use super::progress::PhaseMonitor;
use crate::analysis::kinds::document::Document;
use crate::analysis::kinds::sweep::{HISTORIES, STATES};
use crate::analysis::monitor::Monitor;
use crate::analysis::resolved::ResolvedCaseStudy;
use crate::analysis::run;
use crate::store::states;

/// Simulates the speeds of `case` side by side and stores the histories of each as soon as they are there; speeds whose histories are
/// stored already are not computed again. Runs of a job that is the case are counted by how they end (`is_counted`); those of a sweep are known.
pub(super) async fn record(
    engine: &Engine,
    job: &Live,
    case: &ResolvedCaseStudy,
    is_counted: bool,
    monitor: PhaseMonitor,
) -> Result<(), Interruption> {
    let total = case.speeds().len();
    let mut running = stream::iter(0..total)
        .map(|place| record_one(engine, job, case, (place, is_counted)))
        .buffer_unordered(engine.computing.threads());
    let mut done = 0;
    while running.try_next().await?.is_some() {
        done += 1;
        let words = format!("histories of {done} of {total} speeds recorded");
        monitor.progress(done as f64 / total as f64, &words);
    }
    Ok(())
}

async fn record_one(
    engine: &Engine,
    job: &Live,
    case: &ResolvedCaseStudy,
    (place, is_counted): (usize, bool),
) -> Result<(), Interruption> {
    let case_speed = case.speeds()[place];
    let document = Document::part(HISTORIES, case_speed);
    if engine.store.document_bytes(job.id, document).await?.is_some() {
        return Ok(());
    }
    let sweep = case.sweep();
    let monitor = PhaseMonitor::uncounted(job.watch.clone());
    let reduced = engine.reductions.of_case(sweep, case.fields(), monitor.clone()).await?;
    let asked = (Arc::clone(&reduced), case.clone());
    let bytes =
        engine.computing.run(&job.watch, move || run::histories_memory(&asked.0, &asked.1, place)).await?;
    // Memory is held until the histories are in the store.
    let _memory = engine.memory.hold(bytes).await.map_err(Interruption::speed_memory)?;
    let case = case.clone();
    let compute = move || {
        let mut histories = run::speed_histories(&reduced, &case, place, &monitor)?;
        let states =
            histories.states.take().map(|states| states::pack(&states, &reduced.wheel)).transpose()?;
        Ok::<_, Interruption>((serde_json::to_string(&histories)?, states, histories.point.status))
    };
    let (text, states, status) = engine.computing.run(&job.watch, compute).await??;
    // States go first, because stored histories tell that the speed is done.
    if let Some(states) = states {
        let document = Document::part(STATES, case_speed);
        patiently(&job.watch, || engine.store.keep_document(job.id, document, &states, None)).await?;
    }
    let ended = is_counted.then_some(status);
    patiently(&job.watch, || engine.store.keep_document(job.id, document, &text, ended)).await?;
    engine.computing.acquit(job.id);
    Ok(())
}
