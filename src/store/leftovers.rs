//! Leftovers of an earlier service.

use super::handle::Store;

impl Store {
    /// Removes files that an earlier service left behind and that nobody will use. For a service that starts: files being written now look
    /// the same. Files that cannot be removed do no harm. Reserves disk space for deletions.
    pub async fn remove_leftovers(&self) {
        if let Err(error) = self.remove_stale_packages().await {
            tracing::warn!(%error, "could not remove the packages of broken uploads");
        }
        if let Err(error) = self.remove_stale_checkpoints().await {
            tracing::warn!(%error, "could not remove stale checkpoints");
        }
        if let Err(error) = self.remove_stale_bases().await {
            tracing::warn!(%error, "could not remove stale bases of reductions");
        }
        if let Err(error) = self.remove_stale_trials().await {
            tracing::warn!(%error, "could not remove the trials of another version");
        }
        match self.reserve.keep().await {
            Ok(true) => {}
            Ok(false) => {
                tracing::warn!("the disk of the data folder has too little room to keep some for deletions")
            }
            Err(error) => tracing::warn!(%error, "could not keep room for deletions"),
        }
    }
}
