//! Changes of the labels of a job.

use super::job::JobId;
use crate::store::error::StoreError;
use crate::store::handle::Store;
use crate::store::labels::LabelChanges;

impl Store {
    /// Changes the labels of a job, whatever its status. False if there is no such job.
    pub async fn label_job(&self, id: JobId, changes: LabelChanges) -> Result<bool, StoreError> {
        let update = changes.update("jobs", "id = $6 and deleted = 0")?;
        let mut write = self.write().await?;
        let changed = update.bind(id.to_string()).execute(&mut *write).await?;
        write.commit_job(id).await?;
        Ok(changed.rows_affected() == 1)
    }
}
