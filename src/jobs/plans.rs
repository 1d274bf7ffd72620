//! Plans of jobs: what they will do and cost on this machine.

use std::sync::Arc;
use std::sync::atomic::Ordering;

use super::engine::{Engine, Live};
use super::error::Interruption;
use super::machine;
use super::patience::patiently;
use super::pool::Panicked;
use crate::analysis::resolved::{
    ResolvedBranches, ResolvedCampaign, ResolvedModalAnalysis, ResolvedRunUps, ResolvedSweep,
};
use crate::analysis::result::{BranchesPlan, CampaignPlan, Machine, RunUpPlan};
use crate::analysis::run::{self, Calibration, ModalAnalysisPlan, ModelFacts, ReducedSector, SweepPlan};
use crate::store::StoreError;
use crate::store::jobs::JobRequest;
#[cfg(feature = "cluster")]
use crate::store::machines::WorkerProcess;

/// Plans a resolved sweep.
pub(super) async fn sweep<E: From<StoreError> + From<Panicked>>(
    engine: &Engine,
    owner: &str,
    request: ResolvedSweep,
    facts: ModelFacts,
    reduced: Option<Arc<ReducedSector>>,
) -> Result<SweepPlan, E> {
    let Capacity { machine, costs, threads } = capacity::<E>(engine).await?;
    let plan = move || run::plan_sweep(&request, &facts, reduced.as_deref(), &costs, threads);
    Ok(SweepPlan { machine: Some(machine), ..engine.planner.run(owner, plan).await? })
}

/// Plans resolved branches.
pub(super) async fn branches<E: From<StoreError> + From<Panicked>>(
    engine: &Engine,
    owner: &str,
    request: ResolvedBranches,
    facts: ModelFacts,
    reduced: Option<Arc<ReducedSector>>,
) -> Result<BranchesPlan, E> {
    let Capacity { machine, costs, .. } = capacity::<E>(engine).await?;
    let plan = move || run::plan_branches(&request, &facts, reduced.as_deref(), &costs);
    Ok(BranchesPlan { machine: Some(machine), ..engine.planner.run(owner, plan).await? })
}

/// Plans resolved run-ups.
pub(super) async fn run_ups<E: From<StoreError> + From<Panicked>>(
    engine: &Engine,
    owner: &str,
    request: ResolvedRunUps,
    facts: ModelFacts,
    reduced: Option<Arc<ReducedSector>>,
) -> Result<RunUpPlan, E> {
    let Capacity { machine, costs, .. } = capacity::<E>(engine).await?;
    let plan = move || run::plan_run_ups(&request, &facts, reduced.as_deref(), &costs);
    Ok(RunUpPlan { machine: Some(machine), ..engine.planner.run(owner, plan).await? })
}

/// Facts of a model, and its reduction if that is there.
type Model = (ModelFacts, Option<Arc<ReducedSector>>);

/// Plans a resolved campaign of a model and the one that is compared with it.
pub(super) async fn campaign<E: From<StoreError> + From<Panicked>>(
    engine: &Engine,
    owner: &str,
    request: ResolvedCampaign,
    own: Model,
    compared: Option<Model>,
) -> Result<CampaignPlan, E> {
    fn borrowed((facts, reduced): &Model) -> (&ModelFacts, Option<&ReducedSector>) {
        (facts, reduced.as_deref())
    }

    let Capacity { machine, costs, threads } = capacity::<E>(engine).await?;
    let plan = move || {
        let compared = compared.as_ref().map(borrowed);
        run::plan_campaign(&request, borrowed(&own), compared, &costs, threads)
    };
    let mut plan = engine.planner.run(owner, plan).await?;
    plan.scene.machine = Some(machine);
    Ok(plan)
}

/// Machines that compute a job.
struct Capacity {
    /// Representative machine: the one with most threads.
    machine: Machine,
    /// Costs of steps on that machine.
    costs: Arc<Calibration>,
    /// Number of threads of all machines.
    threads: usize,
}

/// Capacity of all machines that share the work, each taken as fast as the one with most threads; of this machine where there is no other.
async fn capacity<E: From<StoreError> + From<Panicked>>(engine: &Engine) -> Result<Capacity, E> {
    #[cfg(feature = "cluster")]
    if let Some(queue) = engine.store.shared_queue() {
        let processes = queue.worker_processes().await?;
        let threads = processes.iter().map(|process| process.threads as usize).sum();
        if let Some(WorkerProcess { machine, costs, .. }) = processes.into_iter().next() {
            return Ok(Capacity { machine, costs: Arc::new(costs), threads });
        }
    }
    let costs = engine.calibrated.get::<E>(engine.planner.pool()).await?;
    Ok(Capacity { machine: machine::here(), costs, threads: engine.computing.threads() })
}

/// Plans a resolved modal analysis.
pub(super) async fn modal_analysis(
    engine: &Engine,
    owner: &str,
    request: ResolvedModalAnalysis,
    facts: ModelFacts,
    reduced: Option<Arc<ReducedSector>>,
) -> Result<ModalAnalysisPlan, Panicked> {
    engine.planner.run(owner, move || run::plan_modal_analysis(&request, &facts, reduced.as_deref())).await
}

/// Stores the estimate of a job of speeds whose reductions are there, that of a model which is compared last, unless one was stored
/// before. Refuses one whose speeds take more memory than there is.
pub(super) async fn keep(
    engine: &Engine,
    job: &Live,
    (reduced, compared): (Arc<ReducedSector>, Option<Arc<ReducedSector>>),
) -> Result<(), Interruption> {
    let Some(stored) = engine.store.job(job.id).await? else { return Ok(()) };
    let estimate = match (stored.facts, stored.plan) {
        (_, Some(kept)) => kept,
        (None, None) => return Ok(()),
        (Some(facts), None) => {
            let estimate = match &job.request {
                JobRequest::Sweep(request) => {
                    sweep::<Interruption>(engine, &job.owner, *request.clone(), facts, Some(reduced))
                        .await?
                        .estimate
                }
                JobRequest::Campaign(request) => {
                    let compared = match request.compared_model() {
                        Some(model) => {
                            engine.store.model(model, None).await?.map(|model| (model.facts, compared))
                        }
                        None => None,
                    };
                    let own = (facts, Some(reduced));
                    campaign::<Interruption>(engine, &job.owner, *request.clone(), own, compared)
                        .await?
                        .estimate
                }
                _ => None,
            };
            let Some(estimate) = estimate else { return Ok(()) };
            patiently(&job.watch, || engine.store.record_plan(job.id, &estimate)).await?;
            estimate
        }
    };
    job.speed_bytes.store(estimate.speed_memory_bytes, Ordering::Relaxed);
    // Refused before the first speed begins, not when it claims its memory.
    engine.memory.hold(estimate.speed_memory_bytes).await.map(drop).map_err(Interruption::speed_memory)
}
