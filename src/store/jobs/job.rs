//! A job as it is remembered.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;
use uuid::Uuid;

use crate::analysis::error::Violation;
use crate::analysis::request::auto_or::AutoOr;
use crate::analysis::request::{ModalAnalysisRequest, SweepRequest};
use crate::analysis::run::{Choice, Estimate, ModelFacts, ModesChoice, StudyRequest};
use crate::impeller::ImpellerParameters;
use crate::store::status::JobStatus;

/// Id of a job: a version 7 UUID, so that order of ids is order of age.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(transparent)]
pub struct JobId(Uuid);

impl JobId {
    /// A new id, greater than all before it.
    pub fn new() -> Self {
        Self(Uuid::now_v7())
    }

    /// Reads an id; `None` if `text` is not one.
    pub fn parse(text: &str) -> Option<Self> {
        Uuid::try_parse(text).ok().map(Self)
    }
}

impl Default for JobId {
    fn default() -> Self {
        Self::new()
    }
}

impl std::fmt::Display for JobId {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.0.hyphenated().fmt(f)
    }
}

/// Kind of a job.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum JobKind {
    /// Contact simulations over speeds.
    Sweep,
    /// Natural frequencies over speeds.
    ModalAnalysis,
    /// A model from the parameters of the generator.
    ModelGeneration,
    /// Errors and times of a grid of settings.
    Study,
}

impl JobKind {
    /// The word on the wire and in the database.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Sweep => "sweep",
            Self::ModalAnalysis => "modal_analysis",
            Self::ModelGeneration => "model_generation",
            Self::Study => "study",
        }
    }
}

/// What a job computes.
#[derive(Debug, Clone, PartialEq)]
pub enum JobRequest {
    /// Contact simulations over speeds.
    Sweep(Box<SweepRequest>),
    /// Natural frequencies over speeds.
    ModalAnalysis(ModalAnalysisRequest),
    /// A model from the parameters of the generator.
    ModelGeneration(Box<ImpellerParameters>),
    /// Errors and times of a grid of settings.
    Study(Box<StudyRequest>),
}

impl JobRequest {
    /// Its kind.
    pub fn kind(&self) -> JobKind {
        match self {
            Self::Sweep(_) => JobKind::Sweep,
            Self::ModalAnalysis(_) => JobKind::ModalAnalysis,
            Self::ModelGeneration(_) => JobKind::ModelGeneration,
            Self::Study(_) => JobKind::Study,
        }
    }

    /// The model it computes from, if it does.
    pub fn model(&self) -> Option<&str> {
        match self {
            Self::Sweep(request) => Some(&request.model),
            Self::ModalAnalysis(request) => Some(&request.model),
            Self::ModelGeneration(_) => None,
            Self::Study(request) => Some(&request.model),
        }
    }

    /// `modes_per_speed` of the reduction that its results rest on, if there is one and it is known.
    pub fn modes_per_speed(&self) -> Option<u32> {
        let given = match self {
            Self::Sweep(request) => request.modes_per_speed,
            Self::ModalAnalysis(request) => request.modes_per_speed,
            Self::ModelGeneration(_) | Self::Study(_) => AutoOr::Auto,
        };
        match given {
            AutoOr::Auto => None,
            AutoOr::Fixed(modes_per_speed) => Some(modes_per_speed),
        }
    }

    pub(super) fn to_json(&self) -> Result<String, serde_json::Error> {
        match self {
            Self::Sweep(request) => serde_json::to_string(request),
            Self::ModalAnalysis(request) => serde_json::to_string(request),
            Self::ModelGeneration(parameters) => serde_json::to_string(parameters),
            Self::Study(request) => serde_json::to_string(request),
        }
    }
}

/// Why a job failed.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Failure {
    /// Which kind of failure.
    pub cause: FailureCause,
    /// What happened, in words an engineer can act on.
    pub message: String,
    /// Offending fields of the request, if it was the request.
    #[serde(default)]
    pub violations: Vec<Violation>,
}

/// Kinds of failure.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FailureCause {
    /// The request asks for something that only the reduced model shows to be impossible.
    Refused,
    /// The model cannot be reduced or evaluated.
    Model,
    /// The stored package could not be read again.
    Package,
    /// It needs more memory than allowed.
    Memory,
    /// Its owner has too much already.
    Limit,
    /// No speed of a sweep was integrated to its end.
    NothingCompleted,
    /// A defect of this program: a computation panicked.
    Defect,
    /// The database or the disk failed.
    Storage,
}

/// Settings that were chosen for a job, and why.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum Chosen {
    /// For a sweep, by pilot runs.
    Setting(Choice),
    /// For a modal analysis, by its reductions.
    Modes(ModesChoice),
}

/// A stored job.
#[derive(Debug, Clone)]
pub struct Job {
    /// Its id.
    pub id: JobId,
    /// Whose it is; empty where the service knows no owners.
    pub owner: String,
    /// How far it is.
    pub status: JobStatus,
    /// The model it computes from, or the one that a finished generation made.
    pub model: Option<String>,
    /// Facts of the model it computes from when it was accepted.
    pub facts: Option<ModelFacts>,
    /// The whole request as resolved, and as revised since: see [`Store::revise_request`](crate::store::Store::revise_request).
    pub request: JobRequest,
    /// Percent of the work done.
    pub progress: u8,
    /// What runs now, in words.
    pub phase: String,
    /// Its speeds.
    pub speeds: SpeedCounts,
    /// Bytes that its results take in the database.
    pub stored_bytes: u64,
    /// What a sweep was expected to cost when its first speeds were queued.
    pub plan: Option<Estimate>,
    /// The settings that were chosen for it.
    pub choice: Option<Chosen>,
    /// Why it failed.
    pub failure: Option<Failure>,
    /// RFC 3339, as all below.
    pub created_at: String,
    /// When computing began.
    pub started_at: Option<String>,
    /// When it became final.
    pub finished_at: Option<String>,
    /// When anything of the above last changed.
    pub updated_at: String,
}

/// Speeds of a job, counted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
pub struct SpeedCounts {
    /// Asked for, and added by `refine` so far: grows while such a job runs.
    pub total: u32,
    /// With a result, whichever.
    pub finished: u32,
    /// Of the finished ones: stopped because the response grew beyond any physical bound.
    pub diverged: u32,
    /// Of the finished ones: could not be integrated.
    pub failed: u32,
}
