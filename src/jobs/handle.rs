//! What `http` may ask of jobs. It does not know how many threads there are.

use std::path::PathBuf;
use std::sync::Arc;

use super::choice;
use super::engine::Engine;
use super::plans;
use super::pool::Panicked;
use crate::analysis::error::Violation;
use crate::analysis::request::{ModalAnalysisRequest, SweepRequest};
use crate::analysis::run::{self, ModalAnalysisPlan, ReducedSector, SweepPlan};
use crate::impeller::{GenerationPlan, ImpellerError, ImpellerParameters, ImpellerRequest, plan_generation};
use crate::package;
use crate::store::StoreError;
use crate::store::idempotency::Answer;
use crate::store::jobs::{Insertion, JobId, JobRequest};
use crate::store::status::JobStatus;

/// A handle on the job runner.
#[derive(Debug, Clone)]
pub struct Jobs {
    pub(super) engine: Arc<Engine>,
}

/// Why a job was not accepted.
#[derive(Debug, thiserror::Error)]
pub enum SubmitError {
    /// Its model is not there.
    #[error("there is no model {0:?}")]
    UnknownModel(String),
    /// It asks for something impossible; all violations at once.
    #[error("the request cannot be met")]
    Refused(Vec<Violation>),
    /// Another request with the same idempotency key was accepted at the same moment.
    #[error("the idempotency key is in use")]
    KeyTaken,
    /// It could not be kept.
    #[error(transparent)]
    Store(#[from] StoreError),
    /// Planning it panicked.
    #[error(transparent)]
    Defect(#[from] Panicked),
}

/// What became of a job that was to be cancelled.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Cancellation {
    /// It is dismissed, now or before.
    Dismissed,
    /// There is no such job.
    Unknown,
    /// It had ended before.
    AlreadyFinal(JobStatus),
}

impl Jobs {
    pub(super) fn new(engine: Arc<Engine>) -> Self {
        Self { engine }
    }

    /// Checks a request against its model, keeps it as job `id` and queues it. `answer` is what its idempotency key
    /// will repeat.
    pub async fn submit(
        &self,
        id: JobId,
        request: JobRequest,
        answer: Option<&Answer>,
    ) -> Result<(), SubmitError> {
        let engine = &self.engine;
        let refused = SubmitError::Refused;
        let (request, facts, speeds) = match request {
            JobRequest::Sweep(mut request) => {
                let facts = self.facts(&request.model).await?;
                request.speeds.ask_for_all();
                let request = run::resolve_sweep(*request, &facts).map_err(refused)?;
                let speeds = request.speeds.resolve().map_err(refused)?.len();
                (JobRequest::Sweep(Box::new(request)), Some(facts), speeds)
            }
            JobRequest::ModalAnalysis(request) => {
                let facts = self.facts(&request.model).await?;
                let request = run::resolve_modal_analysis(request, &facts).map_err(refused)?;
                let speeds = request.speeds.ascending().map_err(refused)?.len();
                (JobRequest::ModalAnalysis(request), Some(facts), speeds)
            }
            JobRequest::Study(request) => {
                let facts = self.facts(&request.model).await?;
                let request = run::resolve_study(*request, &facts).map_err(refused)?;
                let speeds = request.speeds.resolve().map_err(refused)?.len();
                (JobRequest::Study(Box::new(request)), Some(facts), speeds)
            }
            // Resolved by `generation_of`.
            generation @ JobRequest::ModelGeneration(_) => (generation, None, 0),
        };
        let model = request.model();
        match engine.store.insert_job(id, &request, facts.as_ref(), speeds as u32, answer).await? {
            Insertion::Accepted => {}
            Insertion::UnknownModel => {
                return Err(SubmitError::UnknownModel(model.unwrap_or_default().to_owned()));
            }
            Insertion::KeyTaken => return Err(SubmitError::KeyTaken),
        }
        tracing::info!(job.id = %id, kind = request.kind().as_str(), model.id = model, speeds, "accepted");
        // From here on the job is kept: should this fail, the next start queues it.
        engine.queue.push_preparation(id).await?;
        engine.new_preparation.notify_one();
        Ok(())
    }

    /// Checks a sweep against its model and says what it would do and cost. Starts nothing, not even its reduction.
    pub async fn plan_sweep(&self, mut request: SweepRequest) -> Result<SweepPlan, SubmitError> {
        let facts = self.facts(&request.model).await?;
        request.speeds.ask_for_all();
        let mut request = run::resolve_sweep(request, &facts).map_err(SubmitError::Refused)?;
        let mut choice = None;
        if request.unchosen() {
            let stored = choice::stored(&self.engine, &request, facts.sectors).await?;
            choice = stored.map_err(|violation| SubmitError::Refused(vec![violation]))?;
            request = choice.as_ref().map_or(request.clone(), |choice| choice.explicit(&request));
        }
        let reduced = self.reduction(&request.model, request.unchosen(), request.modes()).await?;
        let plan = plans::sweep::<SubmitError>(&self.engine, request, facts, reduced).await?;
        Ok(SweepPlan { choice, ..plan })
    }

    /// The same for a modal analysis.
    pub async fn plan_modal_analysis(
        &self,
        request: ModalAnalysisRequest,
    ) -> Result<ModalAnalysisPlan, SubmitError> {
        let facts = self.facts(&request.model).await?;
        let mut request = run::resolve_modal_analysis(request, &facts).map_err(SubmitError::Refused)?;
        let mut choice = None;
        if request.unchosen() {
            let stored = choice::stored_modes(&self.engine, &request).await?;
            choice = stored.map_err(|violation| SubmitError::Refused(vec![violation]))?;
            request = choice.as_ref().map_or(request.clone(), |choice| choice.explicit(&request));
        }
        let reduced = self.reduction(&request.model, request.unchosen(), request.modes()).await?;
        let plan = plans::modal_analysis(&self.engine, request, facts, reduced).await?;
        Ok(ModalAnalysisPlan { choice, ..plan })
    }

    /// The reduction that a plan can rest on: none while its modes are not chosen.
    async fn reduction(
        &self,
        model: &str,
        unchosen: bool,
        modes_per_speed: u32,
    ) -> Result<Option<Arc<ReducedSector>>, SubmitError> {
        if unchosen {
            return Ok(None);
        }
        Ok(self.engine.reductions.stored(model, modes_per_speed).await?)
    }

    /// The same for the generation of a model.
    pub async fn plan_generation(&self, request: &ImpellerRequest) -> Result<GenerationPlan, SubmitError> {
        let parameters = parameters_of(request)?;
        let planned = self.engine.planner.run(move || plan_generation(&parameters)).await?;
        planned.map_err(|error| SubmitError::Refused(vec![violation(&error)]))
    }

    async fn facts(&self, model: &str) -> Result<run::ModelFacts, SubmitError> {
        let model = self
            .engine
            .store
            .model(model)
            .await?
            .ok_or_else(|| SubmitError::UnknownModel(model.to_owned()))?;
        Ok(model.facts)
    }

    /// Cancels a job. Its finished speeds stay.
    pub async fn cancel(&self, id: JobId) -> Result<Cancellation, StoreError> {
        match self.engine.store.advance_job(id, JobStatus::Dismissed, None).await? {
            None => Ok(Cancellation::Unknown),
            Some(JobStatus::Dismissed) => {
                self.engine.retire(id).await;
                tracing::info!(job.id = %id, "dismissed");
                Ok(Cancellation::Dismissed)
            }
            Some(status) => Ok(Cancellation::AlreadyFinal(status)),
        }
    }

    /// Reads and checks an uploaded package, on a thread of its own.
    pub async fn read_package(
        &self,
        path: PathBuf,
        limits: package::Limits,
    ) -> Result<Result<(run::ModelFacts, String), Box<package::PackageError>>, Panicked> {
        let read = move || {
            package::read(&path, &limits)
                .map(|imported| (run::ModelFacts::of(&imported.sector), imported.digest))
                .map_err(Box::new)
        };
        self.engine.importer.run_parallel(read).await
    }
}

/// The job that generates what `request` describes.
///
/// # Errors
/// [`SubmitError::Refused`] points at a field that is unknown or out of range.
pub fn generation_of(request: &ImpellerRequest) -> Result<JobRequest, SubmitError> {
    Ok(JobRequest::ModelGeneration(Box::new(parameters_of(request)?)))
}

fn parameters_of(request: &ImpellerRequest) -> Result<ImpellerParameters, SubmitError> {
    request.resolve().map_err(|error| SubmitError::Refused(vec![violation(&error)]))
}

/// Why parameters of the generator are refused, at the field.
fn violation(error: &ImpellerError) -> Violation {
    let at = |field: &str, message: String| Violation::new(format!("/{}", field.replace('.', "/")), message);
    match error {
        ImpellerError::Parameter { field, value, requirement } => {
            at(field, format!("{value}: {requirement}"))
        }
        ImpellerError::Field { field, detail } => at(field, detail.clone()),
        other => Violation::new("", other.to_string()),
    }
}
