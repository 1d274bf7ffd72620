//! Marks of jobs being computed, as empty files `computing/<job>`: a service that dies leaves the marks of the jobs it died under.
//!
//! Files that nobody flushes, not rows: they cost microseconds, and outlive the process, which is all they are for (a power cut is nobody's
//! fault). A mark that cannot be made is left out: then no job is blamed.

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use super::jobs::job::JobId;

/// Marks of one data folder.
#[derive(Debug, Clone)]
pub(super) struct Marks {
    folder: PathBuf,
    /// Number of marks of each job; `None` once the service stops in order.
    pub(super) counts: Arc<Mutex<Option<HashMap<JobId, u32>>>>,
}

/// Mark that a job is being computed, for as long as it is held.
#[derive(Debug)]
pub struct Mark {
    pub(super) job: JobId,
    pub(super) marks: Marks,
}

impl Marks {
    pub(super) fn new(data: &Path) -> std::io::Result<Self> {
        let folder = data.join("computing");
        std::fs::create_dir_all(&folder)?;
        Ok(Self { folder, counts: Arc::new(Mutex::new(Some(HashMap::new()))) })
    }

    /// Changes the count of a job, and creates or removes its file where that matters.
    pub(super) fn change(&self, job: JobId, count: impl FnOnce(&mut u32)) {
        let mut counts = self.counts.lock().unwrap_or_else(PoisonError::into_inner);
        let Some(counts) = counts.as_mut() else { return };
        let entry = counts.entry(job).or_default();
        let before = *entry;
        count(entry);
        let path = self.folder.join(job.to_string());
        let changed = match (before, *entry) {
            (0, 1) => std::fs::File::create(path).map(drop),
            (_, 0) => {
                counts.remove(&job);
                std::fs::remove_file(path)
            }
            _ => Ok(()),
        };
        if let Err(error) = changed {
            tracing::debug!(job.id = %job, %error, "could not mark what is being computed");
        }
    }

    pub(super) fn files(&self) -> std::io::Result<Vec<PathBuf>> {
        std::fs::read_dir(&self.folder)?.map(|entry| Ok(entry?.path())).collect()
    }

    pub(super) fn clear(&self) -> std::io::Result<()> {
        self.files()?.into_iter().try_for_each(std::fs::remove_file)
    }
}

impl Drop for Mark {
    fn drop(&mut self) {
        self.marks.change(self.job, |count| *count -= 1);
    }
}
