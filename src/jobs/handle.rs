//! Handle through which `http` asks for jobs. It does not know how many threads there are.

use std::io::ErrorKind;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

use super::choice;
use super::engine::Engine;
use super::memory::Allowance;
use super::plans;
use super::pool::Panicked;
use super::submission::Submission;
use crate::analysis::error::{AnalysisError, Violation};
use crate::analysis::monitor::Unwatched;
use crate::analysis::request::{
    BranchesRequest, CampaignRequest, ModalAnalysisRequest, RunUpRequest, Sensor, SweepRequest,
};
use crate::analysis::resolved::{Modes, ResolvedCampaign, ResolvedSweep};
use crate::analysis::result::{BranchesPlan, CampaignPlan, RunUpPlan};
use crate::analysis::run::{self, ModalAnalysisPlan, PlacedSensor, ReducedSector, SweepPlan};
use crate::impeller::{GenerationPlan, ImpellerError, ImpellerParameters, ImpellerRequest, plan_generation};
use crate::package;
use crate::store::StoreError;
use crate::store::idempotency::Answer;
use crate::store::jobs::{Insertion, JobDeletion, JobId, JobRequest};
use crate::store::labels::Labels;
use crate::store::limits::LimitReached;
use crate::store::status::JobStatus;
use crate::tokens::Principal;

/// Ratio of the memory that reading a package takes to the size of its zip.
const EXPANSION: u64 = 12;

/// Time for which the designs of one campaign are checked before other plans have their turn.
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

    /// Resolves a submission of `whose` against its model, stores it as job `id` with its `labels`, and queues it.
    /// `answer` is what its idempotency key will repeat.
    pub async fn submit(
        &self,
        whose: &Principal,
        id: JobId,
        submission: Submission,
        labels: Labels,
        answer: Option<&Answer>,
    ) -> Result<(), SubmitError> {
        let engine = &self.engine;
        let _asked = engine.planner.admit(&whose.owner).map_err(SubmitError::Limit)?;
        let refused = SubmitError::Refused;
        let (request, facts) = match submission {
            Submission::Sweep(mut request) => {
                let facts = self.facts(whose, &request.model).await?;
                let placed = self.place(&request.model, &mut request.sensors).await?;
                let (_, request) =
                    both(placed, self.resolve(whose, *request, &facts, run::resolve_sweep).await?)?;
                self.check(whose, &request).await?;
                (JobRequest::Sweep(Box::new(request)), Some(facts))
            }
            Submission::ModalAnalysis(request) => {
                let facts = self.facts(whose, &request.model).await?;
                let request = self
                    .resolve(whose, *request, &facts, run::resolve_modal_analysis)
                    .await?
                    .map_err(refused)?;
                (JobRequest::ModalAnalysis(Box::new(request)), Some(facts))
            }
            Submission::Study(mut request) => {
                let facts = self.facts(whose, &request.model).await?;
                let placed = self.place(&request.model, &mut request.sensors).await?;
                let (_, request) =
                    both(placed, self.resolve(whose, *request, &facts, run::resolve_study).await?)?;
                (JobRequest::Study(Box::new(request)), Some(facts))
            }
            Submission::CaseStudy(mut request) => {
                let facts = self.facts(whose, &request.model).await?;
                let placed = self.place(&request.model, &mut request.sensors).await?;
                let (_, case) =
                    both(placed, self.resolve(whose, *request, &facts, run::resolve_case_study).await?)?;
                self.check(whose, case.sweep()).await?;
                (JobRequest::CaseStudy(Box::new(case)), Some(facts))
            }
            Submission::Branches(mut request) => {
                let facts = self.facts(whose, &request.model).await?;
                let placed = self.place(&request.model, &mut request.sensors).await?;
                let (_, branches) =
                    both(placed, self.resolve(whose, *request, &facts, run::resolve_branches).await?)?;
                self.check(whose, branches.sweep()).await?;
                (JobRequest::Branches(Box::new(branches)), Some(facts))
            }
            Submission::RunUps(mut request) => {
                let facts = self.facts(whose, &request.model).await?;
                let placed = self.place(&request.model, &mut request.sensors).await?;
                let (_, run_ups) =
                    both(placed, self.resolve(whose, *request, &facts, run::resolve_run_ups).await?)?;
                self.check(whose, run_ups.sweep()).await?;
                (JobRequest::RunUps(Box::new(run_ups)), Some(facts))
            }
            Submission::Campaign(request) => {
                let (campaign, facts, _) = self.campaign(whose, *request).await?;
                for sweep in campaign.sweeps() {
                    self.check(whose, sweep).await?;
                }
                (JobRequest::Campaign(Box::new(campaign)), Some(facts))
            }
            Submission::Histories(of) => {
                let (sweep, critical, request) = *of;
                let facts = self.facts(whose, sweep.model()).await?;
                let held = facts.clone();
                let resolve = move || run::histories_of(&sweep, &request, &critical, &held);
                let case = engine.planner.run(&whose.owner, resolve).await?.map_err(refused)?;
                (JobRequest::CaseStudy(Box::new(case)), Some(facts))
            }
            Submission::ModelGeneration(parameters) => {
                let planned = parameters.clone();
                let plan = engine.planner.run(&whose.owner, move || plan_generation(&planned)).await?;
                plan.map_err(|error| refused(vec![violation(&error)]))?;
                (JobRequest::ModelGeneration(parameters), None)
            }
        };
        let speeds = request.speeds();
        let model = request.model().unwrap_or_default().to_owned();
        tracing::info!(job.id = %id, kind = request.kind().as_str(), model.id = model, speeds, "submitted");
        let (engine, owner) = (Arc::clone(engine), whose.owner.clone());
        let answer = answer.cloned();
        // Runs to its end, whatever becomes of the client: a job that is stored is queued.
        let kept = tokio::spawn(async move {
            let whose = (owner.as_str(), engine.limits);
            let kept =
                engine.store.insert_job(id, whose, &request, &labels, facts.as_ref(), answer.as_ref()).await;
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

    /// Checks a sweep against its model and says what it would do and cost. Starts nothing, not even its reduction.
    pub async fn plan_sweep(
        &self,
        whose: &Principal,
        mut request: SweepRequest,
    ) -> Result<SweepPlan, SubmitError> {
        let _asked = self.engine.planner.admit(&whose.owner).map_err(SubmitError::Limit)?;
        let facts = self.facts(whose, &request.model).await?;
        let placed = self.place(&request.model, &mut request.sensors).await?;
        let (placed_sensors, mut request) =
            both(placed, self.resolve(whose, request, &facts, run::resolve_sweep).await?)?;
        let mut choice = None;
        if request.is_sought() {
            let stored = choice::stored(&self.engine, &request, facts.sectors).await?;
            choice = stored.map_err(|violation| SubmitError::Refused(vec![violation]))?;
            request = choice.as_ref().map_or(request.clone(), |choice| choice.explicit(&request));
        }
        let reduced = self.check(whose, &request).await?;
        let plan = plans::sweep::<SubmitError>(&self.engine, &whose.owner, request, facts, reduced).await?;
        Ok(SweepPlan { choice, placed_sensors, ..plan })
    }

    /// Checks branches against their model and says what they would do and cost. Starts nothing.
    pub async fn plan_branches(
        &self,
        whose: &Principal,
        mut request: BranchesRequest,
    ) -> Result<BranchesPlan, SubmitError> {
        let _asked = self.engine.planner.admit(&whose.owner).map_err(SubmitError::Limit)?;
        let facts = self.facts(whose, &request.model).await?;
        let placed = self.place(&request.model, &mut request.sensors).await?;
        let (_, request) = both(placed, self.resolve(whose, request, &facts, run::resolve_branches).await?)?;
        let reduced = self.check(whose, request.sweep()).await?;
        plans::branches(&self.engine, &whose.owner, request, facts, reduced).await
    }

    /// Checks run-ups against their model and says what they would do and cost. Starts nothing.
    pub async fn plan_run_ups(
        &self,
        whose: &Principal,
        mut request: RunUpRequest,
    ) -> Result<RunUpPlan, SubmitError> {
        let _asked = self.engine.planner.admit(&whose.owner).map_err(SubmitError::Limit)?;
        let facts = self.facts(whose, &request.model).await?;
        let placed = self.place(&request.model, &mut request.sensors).await?;
        let (_, request) = both(placed, self.resolve(whose, request, &facts, run::resolve_run_ups).await?)?;
        let reduced = self.check(whose, request.sweep()).await?;
        plans::run_ups(&self.engine, &whose.owner, request, facts, reduced).await
    }

    /// Checks a campaign against its models and says what it would do and cost. Starts nothing.
    pub async fn plan_campaign(
        &self,
        whose: &Principal,
        request: CampaignRequest,
    ) -> Result<CampaignPlan, SubmitError> {
        let _asked = self.engine.planner.admit(&whose.owner).map_err(SubmitError::Limit)?;
        let (campaign, facts, others) = self.campaign(whose, request).await?;
        let own = (facts, self.check(whose, campaign.sweep()).await?);
        let compared = match campaign.compared().zip(others) {
            Some((sweep, facts)) => Some((facts, self.check(whose, sweep).await?)),
            None => None,
        };
        plans::campaign(&self.engine, &whose.owner, campaign, own, compared).await
    }

    /// Resolves `request` against its model on the planning thread: tables, cuts and designs take longer than a thread that
    /// serves requests may be away.
    async fn resolve<Q: Send + 'static, T: Send + 'static>(
        &self,
        whose: &Principal,
        request: Q,
        facts: &run::ModelFacts,
        resolve: fn(Q, &run::ModelFacts) -> Result<T, Vec<Violation>>,
    ) -> Result<Result<T, Vec<Violation>>, SubmitError> {
        let facts = facts.clone();
        Ok(self.engine.planner.run(&whose.owner, move || resolve(request, &facts)).await?)
    }

    /// Resolves a campaign against its models, and gives their facts, too. Designs are checked a [`TURN`] at a time, between which other
    /// requests have theirs; once the client has gone no other turn begins.
    async fn campaign(
        &self,
        whose: &Principal,
        mut request: CampaignRequest,
    ) -> Result<(ResolvedCampaign, run::ModelFacts, Option<run::ModelFacts>), SubmitError> {
        let facts = self.facts(whose, &request.model).await?;
        let compared = match &request.compared_model {
            None => None,
            Some(model) => {
                let facts = self.facts_of(whose, model, "/compared_model").await?;
                let mut sensors = request.sensors.clone();
                self.place(model, &mut sensors).await?.map_err(SubmitError::Refused)?;
                Some(run::ComparedModel { facts, sensors })
            }
        };
        let placed = self.place(&request.model, &mut request.sensors).await?;
        let held = (facts.clone(), compared.clone());
        let planner = &self.engine.planner;
        let resolved =
            planner.run(&whose.owner, move || run::resolve_campaign(request, held.0, held.1)).await?;
        let (_, mut designs) = both(placed, resolved)?;
        loop {
            let check = move || {
                let begin = Instant::now();
                let mut left = true;
                while left && begin.elapsed() < TURN {
                    left = designs.check_next();
                }
                (designs, left)
            };
            let (checked, left) = planner.run(&whose.owner, check).await?;
            designs = checked;
            if !left {
                break;
            }
        }
        let campaign = designs.finish().map_err(SubmitError::Refused)?;
        Ok((campaign, facts, compared.map(|compared| compared.facts)))
    }

    /// Checks a modal analysis against its model and says what it would do and cost. Starts nothing.
    pub async fn plan_modal_analysis(
        &self,
        whose: &Principal,
        request: ModalAnalysisRequest,
    ) -> Result<ModalAnalysisPlan, SubmitError> {
        let _asked = self.engine.planner.admit(&whose.owner).map_err(SubmitError::Limit)?;
        let facts = self.facts(whose, &request.model).await?;
        let mut request = self
            .resolve(whose, request, &facts, run::resolve_modal_analysis)
            .await?
            .map_err(SubmitError::Refused)?;
        let mut choice = None;
        if request.is_sought() {
            let stored = choice::stored_modes(&self.engine, &request).await?;
            choice = stored.map_err(|violation| SubmitError::Refused(vec![violation]))?;
            request = choice.as_ref().map_or(request.clone(), |choice| choice.explicit(&request));
        }
        let reduced = self.reduction(request.model(), request.modes()).await?;
        let plan = plans::modal_analysis(&self.engine, &whose.owner, request, facts, reduced).await?;
        Ok(ModalAnalysisPlan { choice, ..plan })
    }

    /// Places `sensors` at nodes of the model; see [`run::place_sensors`].
    async fn place(
        &self,
        model: &str,
        sensors: &mut [Sensor],
    ) -> Result<Result<Vec<PlacedSensor>, Vec<Violation>>, SubmitError> {
        if !run::name_nodes(sensors) {
            return Ok(Ok(Vec::new()));
        }
        let path = self.engine.store.package(model).await?;
        let mut placed = sensors.to_vec();
        let place = move || {
            let nodes = package::read_nodes(&path, &package::Limits::default())?;
            let found = run::place_sensors(&mut placed, &nodes);
            Ok::<_, package::PackageError>((placed, found))
        };
        let (placed, found) = self.engine.importer.run(place).await?.map_err(|error| match error {
            package::PackageError::Io { source } => StoreError::Package(source),
            error => StoreError::Package(std::io::Error::new(ErrorKind::InvalidData, error.to_string())),
        })?;
        sensors.copy_from_slice(&placed);
        Ok(found)
    }

    /// Checks what only the reduction of a resolved sweep can tell, if it is stored; returns the reduction.
    async fn check(
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

    /// Checks the generation of a model and says what it would do and cost. Starts nothing.
    pub async fn plan_generation(
        &self,
        whose: &Principal,
        request: &ImpellerRequest,
    ) -> Result<GenerationPlan, SubmitError> {
        let _asked = self.engine.planner.admit(&whose.owner).map_err(SubmitError::Limit)?;
        let parameters = parameters_of(request)?;
        let planned = self.engine.planner.run(&whose.owner, move || plan_generation(&parameters)).await?;
        planned.map_err(|error| SubmitError::Refused(vec![violation(&error)]))
    }

    async fn facts(&self, whose: &Principal, model: &str) -> Result<run::ModelFacts, SubmitError> {
        self.facts_of(whose, model, "/model").await
    }

    /// Facts of a model that the request names `at` this place.
    async fn facts_of(
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

    /// Reads and checks an uploaded package, on a thread of its own.
    pub async fn read_package(
        &self,
        path: PathBuf,
        limits: package::Limits,
    ) -> Result<Result<(run::ModelFacts, String), Box<package::PackageError>>, Panicked> {
        // The expanded size is not known yet; texts of numbers shrink to a fifth or less.
        let bytes = path.metadata().map_or(0, |file| file.len().saturating_mul(EXPANSION));
        let memory = self.engine.memory.hold_up_to(bytes).await;
        let read = move || {
            let _memory = memory;
            package::read(&path, &limits)
                .map(|read| {
                    let facts = run::ModelFacts::of_package(&read.sector, read.mesh.as_ref(), &read.findings);
                    (facts, read.digest)
                })
                .map_err(Box::new)
        };
        self.engine.importer.run_parallel(read).await
    }
}

/// Job that generates the model of `request`.
///
/// # Errors
/// [`SubmitError::Refused`] points at a field that is unknown or out of range.
pub fn generation_of(request: &ImpellerRequest) -> Result<Submission, SubmitError> {
    Ok(Submission::ModelGeneration(Box::new(parameters_of(request)?)))
}

/// Joins the outcomes of placing sensors and of resolving a request: both, or all that is wrong with the request. For sensors that
/// could not be placed it reports why, and not that they have no nodes, which follows.
fn both<A, B>(
    placed: Result<A, Vec<Violation>>,
    resolved: Result<B, Vec<Violation>>,
) -> Result<(A, B), SubmitError> {
    match (placed, resolved) {
        (Ok(placed), Ok(resolved)) => Ok((placed, resolved)),
        (placed, resolved) => {
            let mut found = placed.err().unwrap_or_default();
            let follows = |violation: &Violation| {
                ["/gauge", "/nearest"].iter().any(|place| violation.pointer.ends_with(place))
                    && found.iter().any(|cause| cause.pointer.starts_with(&violation.pointer))
            };
            let others = resolved.err().into_iter().flatten().filter(|violation| !follows(violation));
            let others: Vec<Violation> = others.collect();
            found.extend(others);
            Err(SubmitError::Refused(found))
        }
    }
}

fn parameters_of(request: &ImpellerRequest) -> Result<ImpellerParameters, SubmitError> {
    request.resolve().map_err(|error| SubmitError::Refused(vec![violation(&error)]))
}

/// Violation for refused parameters of the generator, at the field.
fn violation(error: &ImpellerError) -> Violation {
    let at = |field: &str, message: String| Violation::new(format!("/{}", field.replace('.', "/")), message);
    match error {
        ImpellerError::Parameter { field, value, requirement } => {
            at(field, format!("{value}: {requirement}"))
        }
        ImpellerError::Field { field, problem } => at(field, problem.to_string()),
        other => Violation::new("", other.to_string()),
    }
}
