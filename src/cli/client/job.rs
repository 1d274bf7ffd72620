//! Models and jobs as a service shows them, as far as they are used.

use anyhow::Context;
use serde::Deserialize;

use super::problem::Problem;
use crate::store::status::JobStatus;

/// A model.
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

/// A job.
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
    error: Option<Problem>,
    links: Vec<Link>,
}

/// Speeds of a job.
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

/// A job that did not end well.
#[derive(Debug, thiserror::Error)]
pub(in crate::cli) enum JobError {
    /// It could not be computed.
    #[error("job {id} failed: {why}")]
    Failed {
        /// Of the job.
        id: String,
        /// The problem in words.
        why: String,
    },
    /// Somebody cancelled it.
    #[error("job {0} was cancelled")]
    Cancelled(String),
}

impl Job {
    /// Path of a result.
    pub(in crate::cli) fn link(&self, rel: &str) -> anyhow::Result<&str> {
        let link = self.links.iter().find(|link| link.rel == rel);
        link.map(|link| link.href.as_str()).with_context(|| format!("job {} links to no {rel}", self.id))
    }

    /// Paths of its results below its own.
    pub(in crate::cli) fn results(&self) -> Vec<&str> {
        let own = format!("/v1/jobs/{}/", self.id);
        self.links.iter().filter_map(|link| link.href.strip_prefix(&own)).collect()
    }

    /// Nothing, if it ended well.
    ///
    /// # Errors
    /// That it did not.
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
