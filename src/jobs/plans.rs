//! Plans of jobs: what they will do and cost on this machine.

use std::sync::Arc;
use std::sync::atomic::Ordering;

use super::engine::{Engine, Live};
use super::error::Interruption;
use super::machine;
use super::patience::patiently;
use crate::analysis::kinds::kind::ResolvedJob;
use crate::analysis::kinds::plan::{Capacity, Grounds, Plan, PlannedModel};
use crate::analysis::result::{Chosen, PlacedSensor};
use crate::analysis::run::ReducedSector;
use crate::pool::Panicked;
use crate::store::StoreError;

/// Plan of a job, which rests on its `models`, the positions of its sensors and a choice of its settings.
pub(super) async fn of<E: From<StoreError> + From<Panicked>>(
    engine: &Engine,
    owner: &str,
    job: Arc<dyn ResolvedJob>,
    models: Vec<PlannedModel>,
    placed_sensors: Vec<PlacedSensor>,
    choice: Option<Chosen>,
) -> Result<Plan, E> {
    // Costs of steps are measured when they are first wanted, which takes a while.
    let capacity = if job.scenes().is_empty() { None } else { Some(capacity::<E>(engine).await?) };
    let grounds = Grounds { models, capacity, placed_sensors, choice };
    let plan = engine.planner.run(owner, move || job.plan(&grounds)).await?;
    Ok(plan.map_err(StoreError::from)?)
}

/// Capacity of all machines that share the work, each taken as fast as the one with most threads; of this machine where there is no other.
async fn capacity<E: From<StoreError> + From<Panicked>>(engine: &Engine) -> Result<Capacity, E> {
    if let Some(queue) = engine.store.shared_queue()
        && let Some(capacity) = queue.capacity().await?
    {
        return Ok(capacity);
    }
    let costs = engine.calibrated.get::<E>(engine.planner.pool()).await?;
    Ok(Capacity { machine: machine::here(), costs, threads: engine.computing.threads() })
}

/// Stores the estimate of a job of speeds whose `reductions` are there, one for each model, unless one was stored before. Refuses one whose
/// speeds take more memory than there is.
pub(super) async fn keep(
    engine: &Engine,
    job: &Live,
    reductions: Vec<Arc<ReducedSector>>,
) -> Result<(), Interruption> {
    let Some(stored) = engine.store.job(job.id).await? else { return Ok(()) };
    let estimate = match (stored.facts, stored.plan) {
        (_, Some(kept)) => kept,
        (None, None) => return Ok(()),
        (Some(facts), None) => {
            let mut facts = vec![facts];
            for model in job.request.models().iter().skip(1) {
                facts.extend(engine.store.model(model, None).await?.map(|model| model.facts));
            }
            let models = facts.into_iter().zip(reductions);
            let models =
                models.map(|(facts, reduced)| PlannedModel { facts, reduced: Some(reduced) }).collect();
            let request = Arc::clone(&job.request);
            let plan = of::<Interruption>(engine, &job.owner, request, models, Vec::new(), None).await?;
            let Some(estimate) = plan.estimate else { return Ok(()) };
            patiently(&job.watch, || engine.store.record_plan(job.id, &estimate)).await?;
            estimate
        }
    };
    // The estimate is for the speeds that were asked for.
    if job.request.rounds() == 0 {
        job.watch.expect_time(estimate.wall_time_s);
    }
    job.speed_bytes.store(estimate.speed_memory_bytes, Ordering::Relaxed);
    // Refused before the first speed begins, not when it claims its memory.
    engine.memory.hold(estimate.speed_memory_bytes).await.map(drop).map_err(Interruption::speed_memory)
}
