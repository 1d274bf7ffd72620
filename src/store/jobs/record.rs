//! Records of a job while it runs: progress, choice and plan.

use super::job::JobId;
use crate::analysis::result::{Chosen, VerdictWord};
use crate::analysis::run::Estimate;
use crate::store::error::StoreError;
use crate::store::handle::Store;
use crate::store::time::now;

impl Store {
    /// Records progress of a running job. It never falls, and only [`Store::complete_job`] reaches 100.
    pub async fn record_progress(&self, id: JobId, percent: u8, phase: &str) -> Result<(), StoreError> {
        let mut write = self.write().await?;
        sqlx::query(
            "update jobs set progress = case when progress < $2 then $2 else progress end, phase = $3, updated_at = $4
             where id = $1 and status = 'running'",
        )
        .bind(id.to_string())
        .bind(i64::from(percent.min(99)))
        .bind(phase)
        .bind(now())
        .execute(&mut *write)
        .await?;
        write.commit_job(id).await
    }

    /// Stores the settings that were chosen for a job, with the reasons.
    pub async fn record_choice(&self, id: JobId, choice: &Chosen) -> Result<(), StoreError> {
        let mut write = self.write().await?;
        sqlx::query("update jobs set choice = $1 where id = $2")
            .bind(serde_json::to_string(choice)?)
            .bind(id.to_string())
            .execute(&mut *write)
            .await?;
        write.commit_job(id).await
    }

    /// Stores the verdict on a sweep that is about to end.
    pub async fn record_verdict(&self, id: JobId, verdict: VerdictWord) -> Result<(), StoreError> {
        let mut write = self.write().await?;
        sqlx::query("update jobs set verdict = $1 where id = $2")
            .bind(verdict.as_str())
            .bind(id.to_string())
            .execute(&mut *write)
            .await?;
        write.commit().await
    }

    /// Stores the expected cost of a sweep; the first estimate stays.
    pub async fn record_plan(&self, id: JobId, estimate: &Estimate) -> Result<(), StoreError> {
        let mut write = self.write().await?;
        sqlx::query("update jobs set plan = $1 where id = $2 and plan is null")
            .bind(serde_json::to_string(estimate)?)
            .bind(id.to_string())
            .execute(&mut *write)
            .await?;
        write.commit().await
    }
}
