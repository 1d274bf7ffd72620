//! Handle through which `http` asks for jobs. It does not know how many threads there are.

use std::sync::Arc;
use std::time::{Duration, Instant};

use super::choice;
use super::engine::Engine;
use super::planner::Permit;
use super::plans;
use crate::analysis::error::{AnalysisError, Violation};
use crate::analysis::kinds::kind::{Asked, GivenModel, NamedModel, ResolvedJob, Resolving, Unchecked};
use crate::analysis::kinds::name::name;
use crate::analysis::kinds::plan::PlannedModel;
use crate::analysis::monitor::Unwatched;
use crate::analysis::request::Sensor;
use crate::analysis::resolved::{Modes, ResolvedSweep};
use crate::analysis::run::{self, PlacedSensor, ReducedSector};
use crate::memory::Allowance;
use crate::pool::Panicked;
use crate::store::StoreError;
use crate::store::idempotency::Answer;
use crate::store::jobs::{Insertion, JobDeletion, JobId, NewJob, Posted};
use crate::store::labels::Labels;
use crate::store::limits::LimitReached;
use crate::store::status::JobStatus;
use crate::tokens::Principal;

/// Time for which one request is checked piece by piece before other plans have their turn.
const TURN: Duration = Duration::from_millis(25);

/// Handle on the job runner.
#[derive(Debug, Clone)]
pub struct Jobs {
    pub(super) engine: Arc<Engine>,
}

/// Reason why a job was not accepted.
#[derive(Debug, thiserror::Error)]
pub enum SubmitError {
    /// Model that is not there.
    #[error("there is no model {model:?}")]
    UnknownModel {
        /// Id of the model.
        model: String,
        /// JSON pointer to where the request names the model.
        at: &'static str,
    },
    /// Request for something impossible; all violations at once.
    #[error("the request cannot be met")]
    Refused(Vec<Violation>),
    /// Limit that the owner of the job has reached.
    #[error(transparent)]
    Limit(LimitReached),
    /// Another request with the same idempotency key was accepted at the same moment.
    #[error("the idempotency key is in use")]
    KeyTaken,
    /// Failure to store the job.
    #[error(transparent)]
    Store(#[from] StoreError),
    /// Panic in the planning of the job.
    #[error(transparent)]
    Defect(#[from] Panicked),
}

/// Request that was resolved and checked, and what that took.
pub struct Checked {
    job: Arc<dyn ResolvedJob>,
    /// Facts of its models.
    facts: Vec<run::ModelFacts>,
    /// Reductions of its scenes, where they are stored.
    reduced: Vec<Option<Arc<ReducedSector>>>,
    /// Positions of its sensors.
    placed_sensors: Vec<PlacedSensor>,
    _permit: Permit,
}

impl Checked {
    /// Resolved job.
    pub fn job(&self) -> &dyn ResolvedJob {
        &*self.job
    }
}

/// Outcome of a request to cancel a job.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Cancellation {
    /// The job is dismissed, now or before.
    Dismissed,
    /// The job does not exist.
    Unknown,
    /// The job had ended before.
    AlreadyFinal(JobStatus),
}

impl Jobs {
    pub(super) fn new(engine: Arc<Engine>) -> Self {
        Self { engine }
    }

    /// Resolves a request of `whose` against its models.
    pub async fn check(&self, whose: &Principal, asked: Box<dyn Asked>) -> Result<Checked, SubmitError> {
        let permit = self.engine.planner.admit(&whose.owner).map_err(SubmitError::Limit)?;
        let (mut facts, mut models) = (Vec::new(), Vec::new());
        let (mut placed_sensors, mut unplaced) = (Vec::new(), Vec::new());
        for NamedModel { id, pointer } in asked.models() {
            let mut sensors = asked.sensors().to_vec();
            let found = self.facts(whose, id, pointer).await?;
            match self.place(id, &mut sensors).await? {
                // Only positions on the first model are reported.
                Ok(placed) if facts.is_empty() => placed_sensors = placed,
                Ok(_) => {}
                Err(violations) => unplaced.extend(violations),
            }
            models.push(GivenModel { facts: found.clone(), sensors });
            facts.push(found);
        }
        let planner = &self.engine.planner;
        let mut resolving = planner.run(&whose.owner, move || asked.resolve(models)).await?;
        // Other requests have their turn in between; once the client has gone no other turn begins.
        while let Ok(Resolving::Unfinished(left)) = resolving {
            resolving = planner.run(&whose.owner, move || check_for_a_turn(left)).await?;
        }
        let job = all_violations(unplaced, resolving)?;
        let mut reduced = Vec::new();
        for scene in job.scenes() {
            reduced.push(self.check_scene(whose, scene).await?);
        }
        Ok(Checked { job, facts, reduced, placed_sensors, _permit: permit })
    }

    /// Stores a checked job of `whose` as job `id`, named if it has no name, and queues it. `answer` is what its idempotency key will repeat.
    pub async fn submit(
        &self,
        whose: &Principal,
        id: JobId,
        checked: Checked,
        posted: Option<Posted>,
        mut labels: Labels,
        answer: Option<&Answer>,
    ) -> Result<(), SubmitError> {
        let (engine, owner, answer) = (Arc::clone(&self.engine), whose.owner.clone(), answer.cloned());
        // Reductions are not held while the job waits to be stored.
        let Checked { job, facts, reduced, placed_sensors: _, _permit } = checked;
        drop(reduced);
        labels.name = labels.name.or_else(|| Some(name(&*job, facts.first()?)));
        let model = job.models().first().copied().unwrap_or_default().to_owned();
        let (kind, speeds) = (job.kind().name, job.speeds());
        tracing::info!(job.id = %id, kind, model.id = model, speeds, "submitted");
        // Runs to its end, whatever becomes of the client: a job that is stored is queued.
        let kept = tokio::spawn(async move {
            let (request, facts) = (&*job, facts.first());
            let new = NewJob { id, owner: &owner, request, posted: posted.as_ref(), labels: &labels, facts };
            let kept = engine.store.insert_job(new, engine.limits, answer.as_ref()).await;
            // Queued also where nobody knows whether the job was stored: a task without a job harms nobody.
            if matches!(kept, Ok(Insertion::Accepted) | Err(_)) {
                engine.tasks.prepare(&owner, id);
            }
            kept
        });
        match kept.await.map_err(|_| Panicked { message: "a job was being kept".to_owned() })?? {
            Insertion::Accepted => Ok(()),
            Insertion::Limit(reached) => Err(SubmitError::Limit(reached)),
            Insertion::UnknownModel => Err(SubmitError::UnknownModel { model, at: "/model" }),
            Insertion::KeyTaken => Err(SubmitError::KeyTaken),
        }
    }

    /// Checks a request of `whose` and says what its job would do and cost, as JSON. Starts nothing, not even a reduction.
    pub async fn plan(&self, whose: &Principal, asked: Box<dyn Asked>) -> Result<String, SubmitError> {
        let Checked { mut job, facts, mut reduced, placed_sensors, _permit } =
            self.check(whose, asked).await?;
        let mut choice = None;
        if let Some(facts) = facts.first() {
            let stored = choice::stored(&self.engine, &*job, facts.sectors).await?;
            if let Some((chosen, explicit)) =
                stored.map_err(|violation| SubmitError::Refused(vec![violation]))?
            {
                (choice, job) = (Some(chosen), explicit);
                reduced.clear();
                for scene in job.scenes() {
                    reduced.push(self.check_scene(whose, scene).await?);
                }
            }
        }
        if reduced.is_empty()
            && let (Some(model), Some(modes)) = (job.models().first(), job.modes_per_speed())
        {
            reduced.push(self.engine.reductions.stored(model, modes).await?);
        }
        let reduced = reduced.into_iter().chain(std::iter::repeat(None));
        let models = facts.into_iter().zip(reduced).map(|(facts, reduced)| PlannedModel { facts, reduced });
        let plan = plans::of::<SubmitError>(
            &self.engine,
            &whose.owner,
            job,
            models.collect(),
            placed_sensors,
            choice,
        );
        Ok(plan.await?.text)
    }

    /// Places `sensors` at nodes of the model, if any is to be placed.
    async fn place(
        &self,
        model: &str,
        sensors: &mut [Sensor],
    ) -> Result<Result<Vec<PlacedSensor>, Vec<Violation>>, SubmitError> {
        if !run::name_nodes(sensors) {
            return Ok(Ok(Vec::new()));
        }
        let mut placed = sensors.to_vec();
        let place = move |nodes: &[_]| (run::place_sensors(&mut placed, nodes), placed);
        let (found, placed) = self.engine.importer.with_nodes(model, place).await??;
        sensors.copy_from_slice(&placed);
        Ok(found)
    }

    /// Checks what only the reduction of a scene can tell, if it is stored; returns the reduction.
    async fn check_scene(
        &self,
        whose: &Principal,
        request: &ResolvedSweep,
    ) -> Result<Option<Arc<ReducedSector>>, SubmitError> {
        let reduced = self.reduction(request.model(), request.modes()).await?;
        if let Some(reduced) = reduced.clone() {
            let request = request.clone();
            let check = move || run::check(&reduced, &request, &Unwatched);
            if let Err(AnalysisError::Refused(violations)) =
                self.engine.planner.run(&whose.owner, check).await?
            {
                return Err(SubmitError::Refused(violations));
            }
        }
        Ok(reduced)
    }

    /// Reduction that a plan can rest on: `None` while its modes are not chosen.
    async fn reduction(&self, model: &str, modes: Modes) -> Result<Option<Arc<ReducedSector>>, SubmitError> {
        let Some(modes_per_speed) = modes.given() else { return Ok(None) };
        Ok(self.engine.reductions.stored(model, modes_per_speed).await?)
    }

    /// Facts of a model that the request names `at` this place.
    async fn facts(
        &self,
        whose: &Principal,
        model: &str,
        at: &'static str,
    ) -> Result<run::ModelFacts, SubmitError> {
        let model = self
            .engine
            .store
            .model(model, whose.only())
            .await?
            .ok_or_else(|| SubmitError::UnknownModel { model: model.to_owned(), at })?;
        Ok(model.facts)
    }

    /// Cancels a job. Its finished speeds stay.
    pub async fn cancel(&self, id: JobId) -> Result<Cancellation, StoreError> {
        match self.engine.store.dismiss_job(id).await? {
            None => Ok(Cancellation::Unknown),
            Some(JobStatus::Dismissed) => {
                self.engine.retire(id);
                tracing::info!(job.id = %id, "dismissed");
                Ok(Cancellation::Dismissed)
            }
            Some(status) => Ok(Cancellation::AlreadyFinal(status)),
        }
    }

    /// Pauses a job, or lets it go on where it was: what is finished of it stays. Returns the status it has now, which is another one
    /// where it has ended; `None` if there is no such job.
    pub async fn set_paused(&self, id: JobId, paused: bool) -> Result<Option<JobStatus>, StoreError> {
        let store = &self.engine.store;
        if paused {
            let status = store.pause_job(id).await?;
            if status == Some(JobStatus::Paused) {
                self.engine.retire(id);
                tracing::info!(job.id = %id, "paused");
                // Another request may have let the job go on meanwhile, whose tasks were withdrawn with the others.
                self.engine.take_up_again(id).await;
            }
            return Ok(status);
        }
        let before = store.job_head(id).await?;
        let Some(job) = before.as_ref().filter(|job| job.status == JobStatus::Paused) else {
            return Ok(before.map(|job| job.status));
        };
        let status = store.advance_job(id, JobStatus::Accepted, None).await?;
        if status == Some(JobStatus::Accepted) {
            self.engine.tasks.prepare(&job.owner, id);
            tracing::info!(job.id = %id, "goes on");
        }
        Ok(status)
    }

    /// Deletes a finished job with its results, whose room is given back soon after.
    pub async fn delete(&self, id: JobId) -> Result<JobDeletion, StoreError> {
        let deletion = self.engine.store.delete_job(id).await?;
        if deletion == JobDeletion::Deleted {
            tracing::info!(job.id = %id, "deleted");
            self.engine.deleted.notify_one();
        }
        Ok(deletion)
    }

    /// Phase of a job in words: what it does or waits for now; `None` if nothing is known beyond what is stored.
    pub fn phase(&self, id: JobId) -> Option<String> {
        self.engine.phase(id)
    }

    /// Memory in bytes that one answer can get; `None` for no limit.
    pub fn most_memory(&self) -> Option<u64> {
        self.engine.memory.most()
    }

    /// Waits for memory for an answer that takes so many bytes while it is made.
    pub async fn answer_memory(&self, bytes: u64) -> Allowance {
        self.engine.memory.hold_up_to(bytes).await
    }
}

/// Checks pieces of a job until its turn is over, or all are checked.
fn check_for_a_turn(mut left: Box<dyn Unchecked>) -> Result<Resolving, Vec<Violation>> {
    let begin = Instant::now();
    loop {
        match left.check()? {
            Resolving::Unfinished(more) if begin.elapsed() < TURN => left = more,
            resolving => return Ok(resolving),
        }
    }
}

/// Resolved job.
///
/// # Errors
/// All violations. For a sensor that could not be placed the reason is reported, and not that it has no node.
fn all_violations(
    mut unplaced: Vec<Violation>,
    resolving: Result<Resolving, Vec<Violation>>,
) -> Result<Arc<dyn ResolvedJob>, SubmitError> {
    let others = match resolving {
        Ok(Resolving::Done(job)) if unplaced.is_empty() => return Ok(job),
        Ok(_) => Vec::new(),
        Err(violations) => violations,
    };
    let follows = |violation: &Violation| {
        ["/gauge", "/nearest"].iter().any(|place| violation.pointer.ends_with(place))
            && unplaced.iter().any(|cause| cause.pointer.starts_with(&violation.pointer))
    };
    let others: Vec<Violation> = others.into_iter().filter(|violation| !follows(violation)).collect();
    unplaced.extend(others);
    Err(SubmitError::Refused(unplaced))
}
