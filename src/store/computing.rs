//! Marks of jobs being computed, and the jobs during which the last service died.

use std::sync::PoisonError;

use super::error::StoreError;
use super::handle::Store;
use super::jobs::job::JobId;
use super::marks::Mark;

impl Store {
    /// Marks `job` as being computed.
    pub fn mark_computing(&self, job: JobId) -> Mark {
        self.marks.change(job, |count| *count += 1);
        Mark { job, marks: self.marks.clone() }
    }

    /// Drops all marks and sets no more: the service stops in order.
    pub fn stop_marking(&self) {
        *self.marks.counts.lock().unwrap_or_else(PoisonError::into_inner) = None;
        if let Err(error) = self.marks.clear() {
            tracing::warn!(%error, "could not lay down the running jobs; the next start takes this for a crash");
        }
    }

    /// Jobs that were being computed when the last service died.
    pub(super) fn marked(&self) -> Result<Vec<JobId>, StoreError> {
        let files = self.marks.files()?;
        let mut jobs: Vec<JobId> =
            files.iter().filter_map(|file| JobId::parse(file.file_name()?.to_str()?)).collect();
        // Processes that died together guard the same jobs in the same order.
        jobs.sort_unstable();
        Ok(jobs)
    }

    /// Drops the marks of the last service, once they are counted.
    pub(super) fn forget_marked(&self) -> Result<(), StoreError> {
        Ok(self.marks.clear()?)
    }
}
