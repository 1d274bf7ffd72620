//! What `http` may ask of jobs. It does not know how many threads there are.

use std::path::PathBuf;
use std::sync::Arc;

use super::engine::Engine;
use super::pool::Panicked;
use crate::analysis::error::Violation;
use crate::analysis::run;
use crate::package;
use crate::store::StoreError;
use crate::store::idempotency::Answer;
use crate::store::jobs::{Insertion, JobId, JobRequest};
use crate::store::status::JobStatus;

/// A handle on the job runner.
#[derive(Debug, Clone)]
pub struct Jobs {
    engine: Arc<Engine>,
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
        let unknown = || SubmitError::UnknownModel(request.model().to_owned());
        let facts = engine.store.model(request.model()).await?.ok_or_else(unknown)?.facts;
        let (request, speeds) = match request.clone() {
            JobRequest::Sweep(request) => {
                let request = run::resolve_sweep(request, &facts).map_err(SubmitError::Refused)?;
                let speeds = request.speeds.resolve().map_err(SubmitError::Refused)?.len();
                (JobRequest::Sweep(request), speeds)
            }
            JobRequest::ModalAnalysis(request) => {
                let request = run::resolve_modal_analysis(request, &facts).map_err(SubmitError::Refused)?;
                let speeds = request.speeds.resolve().map_err(SubmitError::Refused)?.len();
                (JobRequest::ModalAnalysis(request), speeds)
            }
        };
        match engine.store.insert_job(id, &request, &facts, speeds as u32, answer).await? {
            Insertion::Accepted => {}
            Insertion::UnknownModel => return Err(SubmitError::UnknownModel(request.model().to_owned())),
            Insertion::KeyTaken => return Err(SubmitError::KeyTaken),
        }
        tracing::info!(job.id = %id, kind = request.kind().as_str(), model.id = request.model(), speeds, "accepted");
        // From here on the job is kept: should this fail, the next start queues it.
        engine.queue.push_preparation(id).await?;
        engine.new_preparation.notify_one();
        Ok(())
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
        self.engine.importer.run(read).await
    }
}
