//! Job as it is stored.

use std::sync::Arc;

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;
use uuid::Uuid;

use crate::analysis::error::Violation;
use crate::analysis::kinds::kind::ResolvedJob;
use crate::analysis::result::{Chosen, VerdictWord};
use crate::analysis::run::{Estimate, ModelFacts};
use crate::kinds::JobKind;
use crate::store::labels::Labels;
use crate::store::status::JobStatus;

/// Id of a job: a version 7 UUID, so that order of ids is order of age.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(transparent)]
pub struct JobId(Uuid);

impl JobId {
    /// Creates an id greater than all before it.
    pub fn new() -> Self {
        Self(Uuid::now_v7())
    }

    /// Reads an id; `None` if `text` is not one.
    pub fn parse(text: &str) -> Option<Self> {
        let id = Uuid::try_parse(text).ok()?;
        // Other spellings (capitals, braces, URNs) would be other paths to the same job.
        (id.to_string() == text).then_some(Self(id))
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

/// Failure of a job, with its reason.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Failure {
    /// Cause of the failure.
    pub cause: FailureCause,
    /// Description of the failure, in words an engineer can act on.
    pub message: String,
    /// Invalid fields of the request, if the request caused the failure.
    #[serde(default)]
    pub violations: Vec<Violation>,
}

/// Causes of failure.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FailureCause {
    /// Request for something that only the reduced model shows to be impossible.
    Refused,
    /// Model that cannot be reduced or evaluated.
    Model,
    /// Stored package that could not be read again.
    Package,
    /// Job that needs more memory than allowed.
    Memory,
    /// Owner whose limits are reached.
    Limit,
    /// Sweep of which no speed was integrated to its end.
    NothingCompleted,
    /// Defect of this program: a computation panicked.
    Defect,
    /// Database or disk that failed.
    Storage,
}

/// Request as it was posted, which can be posted again as it stands.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Posted {
    /// Path to which it was posted.
    pub to: String,
    /// Body without labels, as JSON.
    pub body: String,
}

/// Stored job as lists show it.
#[derive(Debug, Clone)]
pub struct JobHead {
    /// Id of the job.
    pub id: JobId,
    /// Owner of the job; empty where the service knows no owners.
    pub owner: String,
    /// Kind of the job.
    pub kind: JobKind,
    /// Name, tags and notes that the owner gave the job.
    pub labels: Labels,
    /// Status of the job.
    pub status: JobStatus,
    /// Model that the job computes from, or that a finished generation made.
    pub model: Option<String>,
    /// Progress, percent of the work.
    pub progress: u8,
    /// Phase of the computation, in words.
    pub phase: String,
    /// Numbers of speeds of the job.
    pub speeds: SpeedCounts,
    /// Size of its results in the database, bytes.
    pub stored_bytes: u64,
    /// Failure of the job, if it failed.
    pub failure: Option<Failure>,
    /// Verdict on a finished sweep, as it was when the job ended; `None` for jobs of earlier versions.
    pub verdict: Option<VerdictWord>,
    /// Time at which the job was accepted, RFC 3339.
    pub created_at: String,
    /// Time at which computing began, RFC 3339.
    pub started_at: Option<String>,
    /// Time at which the status became final, RFC 3339.
    pub finished_at: Option<String>,
    /// Time at which anything of the above last changed, RFC 3339.
    pub updated_at: String,
}

/// Stored job.
#[derive(Debug, Clone)]
pub struct Job {
    /// Part of the job that lists show.
    pub head: JobHead,
    /// Facts of the model that the job computes from, when the job was accepted.
    pub facts: Option<ModelFacts>,
    /// Request as resolved in full, and as revised since: see [`Store::revise_request`](crate::store::Store::revise_request).
    pub request: Arc<dyn ResolvedJob>,
    /// Request as it was posted; `None` for some jobs of earlier versions.
    pub posted: Option<Posted>,
    /// Expected cost of a sweep when its first speeds were queued.
    pub plan: Option<Estimate>,
    /// Settings that the service chose for the job.
    pub choice: Option<Chosen>,
    /// Revision of the numerics that computed its results.
    pub revision: u32,
    /// Kind of vectors of the processor that computed the job; unknown for jobs of earlier versions.
    pub vectors: Option<String>,
}

impl std::ops::Deref for Job {
    type Target = JobHead;

    fn deref(&self) -> &JobHead {
        &self.head
    }
}

/// Numbers of speeds of a job.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
pub struct SpeedCounts {
    /// Number of speeds requested, and added by `refine` or for a threshold so far: grows while such a job runs.
    pub total: u32,
    /// Number of speeds with a result, whatever the outcome.
    pub finished: u32,
    /// Number of finished speeds that were stopped because the response grew beyond any physical bound.
    pub diverged: u32,
    /// Number of finished speeds that could not be integrated.
    pub failed: u32,
}
