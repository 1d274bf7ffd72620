//! A job as it is remembered.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;
use uuid::Uuid;

use super::job_kind::JobKind;
use super::job_request::JobRequest;
use crate::analysis::error::Violation;
use crate::analysis::run::{Choice, Estimate, ModelFacts, ModesChoice};
use crate::store::labels::Labels;
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

/// A stored job as lists show it.
#[derive(Debug, Clone)]
pub struct JobHead {
    /// Its id.
    pub id: JobId,
    /// Whose it is; empty where the service knows no owners.
    pub owner: String,
    /// Its kind.
    pub kind: JobKind,
    /// What its owner calls it.
    pub labels: Labels,
    /// How far it is.
    pub status: JobStatus,
    /// The model it computes from, or the one that a finished generation made.
    pub model: Option<String>,
    /// Percent of the work done.
    pub progress: u8,
    /// What runs now, in words.
    pub phase: String,
    /// Its speeds.
    pub speeds: SpeedCounts,
    /// Bytes that its results take in the database.
    pub stored_bytes: u64,
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

/// A stored job.
#[derive(Debug, Clone)]
pub struct Job {
    /// What lists show of it.
    pub head: JobHead,
    /// Facts of the model it computes from when it was accepted.
    pub facts: Option<ModelFacts>,
    /// The whole request as resolved, and as revised since: see [`Store::revise_request`](crate::store::Store::revise_request).
    pub request: JobRequest,
    /// What a sweep was expected to cost when its first speeds were queued.
    pub plan: Option<Estimate>,
    /// The settings that were chosen for it.
    pub choice: Option<Chosen>,
    /// Revision of the numerics that its results are of.
    pub revision: u32,
    /// Kind of vectors of the processor that it was computed on; unknown of jobs of earlier versions.
    pub vectors: Option<String>,
}

impl std::ops::Deref for Job {
    type Target = JobHead;

    fn deref(&self) -> &JobHead {
        &self.head
    }
}

/// Speeds of a job, counted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
pub struct SpeedCounts {
    /// Asked for, and added by `refine` or for a threshold so far: grows while such a job runs.
    pub total: u32,
    /// With a result, whichever.
    pub finished: u32,
    /// Of the finished ones: stopped because the response grew beyond any physical bound.
    pub diverged: u32,
    /// Of the finished ones: could not be integrated.
    pub failed: u32,
}
