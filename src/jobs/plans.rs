//! Plans of jobs: what they will do and cost on this machine.

use std::sync::Arc;
use std::sync::atomic::Ordering;

use tokio::sync::OnceCell;

use super::engine::{Engine, Live};
use super::error::Halt;
use super::patience::patiently;
use super::pool::{CpuPool, Panicked};
use crate::analysis::request::{ModalAnalysisRequest, SweepRequest};
use crate::analysis::run::{self, Calibration, ModalAnalysisPlan, ModelFacts, ReducedSector, SweepPlan};
use crate::store::{Store, StoreError};

/// What steps cost on this machine: from the store, or measured at first use.
#[derive(Debug)]
pub(super) struct Calibrated {
    store: Store,
    known: OnceCell<Arc<Calibration>>,
}

impl Calibrated {
    pub(super) fn new(store: Store) -> Self {
        Self { store, known: OnceCell::new() }
    }

    /// Measures on a thread of `pool`, if need be.
    async fn get<E: From<StoreError> + From<Panicked>>(&self, pool: &CpuPool) -> Result<Arc<Calibration>, E> {
        let known = self
            .known
            .get_or_try_init(|| async {
                let processors = std::thread::available_parallelism().map_or(1, |n| n.get() as u32);
                if let Some(kept) = self.store.calibration(processors).await? {
                    return Ok::<_, E>(Arc::new(kept));
                }
                let measured = pool.run(Calibration::measure).await?;
                tracing::info!(processors, ?measured, "measured what a step costs");
                if let Err(error) = self.store.insert_calibration(processors, &measured).await {
                    tracing::warn!(%error, "could not keep what a step costs; the next start measures again");
                }
                Ok(Arc::new(measured))
            })
            .await?;
        Ok(Arc::clone(known))
    }
}

/// Plans a resolved sweep.
pub(super) async fn sweep<E: From<StoreError> + From<Panicked>>(
    engine: &Engine,
    request: SweepRequest,
    facts: ModelFacts,
    reduced: Option<Arc<ReducedSector>>,
) -> Result<SweepPlan, E> {
    let calibration = engine.calibrated.get::<E>(&engine.planner).await?;
    let workers = engine.computing.threads();
    let plan = move || run::plan_sweep(&request, &facts, reduced.as_deref(), &calibration, workers);
    Ok(engine.planner.run(plan).await?)
}

/// Plans a resolved modal analysis.
pub(super) async fn modal_analysis(
    engine: &Engine,
    request: ModalAnalysisRequest,
    facts: ModelFacts,
    reduced: Option<Arc<ReducedSector>>,
) -> Result<ModalAnalysisPlan, Panicked> {
    engine.planner.run(move || run::plan_modal_analysis(&request, &facts, reduced.as_deref())).await
}

/// Keeps the estimate of a sweep whose reduction is there, unless one was kept before. Refuses a sweep whose speeds take more
/// memory than there is.
pub(super) async fn keep(
    engine: &Engine,
    job: &Live,
    request: &SweepRequest,
    reduced: Arc<ReducedSector>,
) -> Result<(), Halt> {
    let Some(stored) = engine.store.job(job.id).await? else { return Ok(()) };
    let estimate = match (stored.facts, stored.plan) {
        (_, Some(kept)) => kept,
        (None, None) => return Ok(()),
        (Some(facts), None) => {
            let plan = sweep::<Halt>(engine, request.clone(), facts, Some(reduced)).await?;
            let Some(estimate) = plan.estimate else { return Ok(()) };
            patiently(&job.watch, || engine.store.record_plan(job.id, &estimate)).await?;
            estimate
        }
    };
    job.speed_bytes.store(estimate.speed_memory_bytes, Ordering::Relaxed);
    // Before the first speed, not with it.
    engine.memory.hold(estimate.speed_memory_bytes).await.map(drop).map_err(Halt::speed_memory)
}
