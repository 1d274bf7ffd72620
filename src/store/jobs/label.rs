//! Calling a job otherwise.

use sqlx::AssertSqlSafe;

use super::job::JobId;
use crate::store::error::StoreError;
use crate::store::handle::Store;
use crate::store::labels::{LabelChanges, SET};

impl Store {
    /// Changes the labels of a job, whatever its status. False if there is no such job.
    pub async fn label_job(&self, id: JobId, changes: LabelChanges) -> Result<bool, StoreError> {
        let (named, name, tags, noted, notes) = changes.columns()?;
        let mut write = self.write().await?;
        let changed =
            sqlx::query(AssertSqlSafe(format!("update jobs set {SET} where id = ?6 and deleted = 0")))
                .bind(named)
                .bind(name)
                .bind(tags)
                .bind(noted)
                .bind(notes)
                .bind(id.to_string())
                .execute(&mut *write)
                .await?;
        write.commit().await?;
        Ok(changed.rows_affected() == 1)
    }
}
