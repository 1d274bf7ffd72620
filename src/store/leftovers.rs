//! What an earlier service left behind.

use super::handle::Store;

impl Store {
    /// Removes what an earlier service left behind and nobody will use. For a service that starts: what is being
    /// written now looks the same. What cannot be removed does no harm. Keeps room for deletions on a full disk.
    pub async fn remove_leftovers(&self) {
        if let Err(error) = self.remove_stale_packages().await {
            tracing::warn!(%error, "could not remove the packages of broken uploads");
        }
        if let Err(error) = self.remove_stale_checkpoints().await {
            tracing::warn!(%error, "could not remove stale checkpoints");
        }
        if let Err(error) = self.remove_stale_trials().await {
            tracing::warn!(%error, "could not remove the trials of another version");
        }
        if !self.keep_reserve().await {
            tracing::warn!(
                "there is little room on the disk of the data folder, and none to keep for deletions"
            );
        }
    }
}
