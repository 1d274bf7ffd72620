//! Results that are stored leg by leg.

use serde::de::DeserializeOwned;
use tokio::runtime::Handle;

use super::forms::READ_MEMORY;
use super::problem::{Kind, Problem};
use super::state::AppState;
use crate::analysis::kinds::document::Document;
use crate::analysis::kinds::kind::LegNames;
use crate::store::Store;
use crate::store::jobs::{Job, JobId};
use crate::store::status::JobStatus;

/// Legs that a job has stored so far.
pub(super) struct Legs {
    store: Store,
    runtime: Handle,
    job: JobId,
    names: LegNames,
    count: u32,
    stored_bytes: u64,
}

impl Legs {
    /// Finds the legs of `job`.
    ///
    /// # Errors
    /// If it has no `thing` yet, or never will.
    pub(super) async fn of(
        state: &AppState,
        job: &Job,
        names: LegNames,
        thing: &str,
    ) -> Result<Self, Problem> {
        let (count, stored_bytes) = state.store.parts(job.id, names.leg).await?;
        if count == 0 {
            let kind = match job.status {
                JobStatus::Accepted | JobStatus::Running | JobStatus::Paused => Kind::ResultNotReady,
                _ => Kind::ResultUnavailable,
            };
            let detail = format!("the job is {} and has no {thing}", job.status.as_str());
            return Err(Problem::new(kind, detail));
        }
        let (store, runtime) = (state.store.clone(), Handle::current());
        Ok(Self { store, runtime, job: job.id, names, count, stored_bytes })
    }

    /// Memory that reading the legs takes, bytes.
    pub(super) fn bytes(&self) -> u64 {
        READ_MEMORY * self.stored_bytes
    }

    /// Reads all legs; waits for the database.
    pub(super) fn read<L: DeserializeOwned>(&self) -> Result<Vec<L>, Problem> {
        let mut found = Vec::new();
        for index in 0..self.count {
            found.extend(self.document(Document::part(self.names.leg, index))?);
        }
        Ok(found)
    }

    /// Reads the document that is stored beside one leg, if there is one; waits for the database.
    pub(super) fn read_beside<B: DeserializeOwned>(&self, index: usize) -> Result<Option<B>, Problem> {
        let name = self.names.beside;
        name.map_or(Ok(None), |name| self.document(Document::part(name, index as u32)))
    }

    fn document<D: DeserializeOwned>(&self, document: Document<'_>) -> Result<Option<D>, Problem> {
        let text = self.runtime.block_on(self.store.document(self.job, document))?;
        Ok(text.map(|text| serde_json::from_str(&text)).transpose()?)
    }
}
