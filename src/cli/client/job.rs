//! Models and jobs as a service shows them, as far as they are used.

use anyhow::Context;
use serde::Deserialize;

use super::problem::Problem;
use crate::analysis::result::VerdictWord;
use crate::store::status::JobStatus;

/// Model, as far as it is used.
#[derive(Debug, Clone, Deserialize)]
pub(in crate::cli) struct Model {
    pub(in crate::cli) id: String,
    pub(in crate::cli) name: String,
    pub(in crate::cli) sectors: u64,
    pub(in crate::cli) contact_nodes: u64,
    #[serde(default)]
    pub(in crate::cli) size_bytes: u64,
    #[serde(default)]
    pub(in crate::cli) created_at: String,
}

/// Job, as far as it is used.
#[derive(Debug, Clone, Deserialize)]
pub(in crate::cli) struct Job {
    pub(in crate::cli) id: String,
    pub(in crate::cli) kind: String,
    #[serde(default)]
    pub(in crate::cli) name: Option<String>,
    pub(in crate::cli) status: JobStatus,
    #[serde(default)]
    pub(in crate::cli) progress: u64,
    #[serde(default)]
    pub(in crate::cli) phase: String,
    #[serde(default)]
    pub(in crate::cli) speeds: SpeedCounts,
    #[serde(default)]
    pub(in crate::cli) created_at: String,
    /// Verdict on a finished sweep; services of earlier versions do not tell it.
    #[serde(default)]
    pub(in crate::cli) verdict: Option<VerdictWord>,
    error: Option<Problem>,
    links: Vec<Link>,
}

/// Numbers of speeds of a job.
#[derive(Debug, Clone, Default, Deserialize)]
pub(in crate::cli) struct SpeedCounts {
    pub(in crate::cli) total: u32,
    pub(in crate::cli) finished: u32,
}

#[derive(Debug, Clone, Deserialize)]
struct Link {
    rel: String,
    href: String,
}

/// Error of a job that was not successful.
#[derive(Debug, thiserror::Error)]
pub(in crate::cli) enum JobError {
    /// Job that could not be computed.
    #[error("job {id} failed: {why}")]
    Failed {
        /// Id of the job.
        id: String,
        /// Problem in words.
        why: String,
    },
    /// Job that somebody cancelled, by its id.
    #[error("job {0} was cancelled")]
    Cancelled(String),
}

impl Job {
    /// Path of a result.
    pub(in crate::cli) fn link(&self, rel: &str) -> anyhow::Result<&str> {
        let link = self.links.iter().find(|link| link.rel == rel);
        link.map(|link| link.href.as_str()).with_context(|| format!("job {} links to no {rel}", self.id))
    }

    /// Paths of the results of the job, below its own path.
    pub(in crate::cli) fn results(&self) -> Vec<&str> {
        let own = format!("/v1/jobs/{}/", self.id);
        self.links.iter().filter_map(|link| link.href.strip_prefix(&own)).collect()
    }

    /// Succeeds if the job was successful.
    ///
    /// # Errors
    /// [`JobError`], if the job failed, was cancelled or has not ended.
    pub(in crate::cli) fn check(&self) -> Result<(), JobError> {
        let id = self.id.clone();
        match (self.status, &self.error) {
            (JobStatus::Successful, _) => Ok(()),
            (JobStatus::Dismissed, _) => Err(JobError::Cancelled(id)),
            (_, Some(problem)) => Err(JobError::Failed { id, why: problem.to_string() }),
            (status, None) => Err(JobError::Failed { id, why: format!("it is {}", status.as_str()) }),
        }
    }
}
