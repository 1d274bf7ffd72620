//! Status changes of jobs: from start to end.

use super::job::{Failure, JobId};
use super::row::status_of;
use crate::analysis::kinds::document::Document;
use crate::analysis::run::REVISION;
use crate::store::dialect::Guarded;
use crate::store::end_states;
use crate::store::error::StoreError;
use crate::store::handle::Store;
use crate::store::results::insert_document;
use crate::store::status::JobStatus;
use crate::store::time::now;

/// Outcome of starting a job.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Begun {
    /// Job that is running from here on.
    Yes,
    /// Job that wants no work any more.
    Unwanted,
    /// Job that belongs to processors with this other kind of vectors.
    Elsewhere(String),
}

impl Store {
    /// Moves a job to another status, if the transition table allows it. Returns the status it has now; `None` if there is no such job.
    /// `failure` belongs to [`JobStatus::Failed`] and to no other status.
    pub async fn advance_job(
        &self,
        id: JobId,
        next: JobStatus,
        failure: Option<&Failure>,
    ) -> Result<Option<JobStatus>, StoreError> {
        let mut transaction = self.write_removal().await?;
        transaction.guard(Guarded::Job(id)).await?;
        let status = status_of(&mut transaction, id).await?;
        if !status.is_some_and(|status| status.may_become(next)) {
            transaction.rollback().await?;
            return Ok(status);
        }
        let time = now();
        sqlx::query(
            "update jobs set status = $2, error = $3, updated_at = $4,
                 finished_at = case when $5 then $4 end
             where id = $1",
        )
        .bind(id.to_string())
        .bind(next.as_str())
        .bind(failure.map(serde_json::to_string).transpose()?)
        .bind(time)
        .bind(next.is_final())
        .execute(&mut *transaction)
        .await?;
        if next.is_final() {
            end_states::drop_of(&mut transaction, id).await?;
        }
        transaction.commit_job(id).await?;
        Ok(Some(next))
    }

    /// Dismisses a job, on a full disk as well. Returns the status it has now; `None` if there is no such job.
    pub async fn dismiss_job(&self, id: JobId) -> Result<Option<JobStatus>, StoreError> {
        self.with_reserve(|| self.advance_job(id, JobStatus::Dismissed, None)).await
    }

    /// Pauses a job, on a full disk as well. Returns the status it has now; `None` if there is no such job.
    pub async fn pause_job(&self, id: JobId) -> Result<Option<JobStatus>, StoreError> {
        self.with_reserve(|| self.advance_job(id, JobStatus::Paused, None)).await
    }

    /// Starts a job on a processor with this kind of vectors; a job of another revision of the numerics is unwanted here.
    pub async fn begin_job(&self, id: JobId, vectors: &str) -> Result<Begun, StoreError> {
        let mut write = self.write().await?;
        let begun = sqlx::query(
            "update jobs set status = 'running', updated_at = $2,
                 started_at = coalesce(started_at, $2),
                 vectors = case when coalesce(vectors, $3) = $3 then $3 else 'several' end
             where id = $1 and status in ('accepted', 'running') and revision = $4
                 and (one_kind = 0 or coalesce(vectors, $3) = $3)",
        )
        .bind(id.to_string())
        .bind(now())
        .bind(vectors)
        .bind(i64::from(REVISION))
        .execute(&mut *write)
        .await?;
        if begun.rows_affected() == 1 {
            write.commit_job(id).await?;
            return Ok(Begun::Yes);
        }
        let kept: Option<Option<String>> = sqlx::query_scalar(
            "select vectors from jobs where id = $1 and status in ('accepted', 'running') and revision = $2",
        )
        .bind(id.to_string())
        .bind(i64::from(REVISION))
        .fetch_optional(&mut *write)
        .await?;
        write.rollback().await?;
        Ok(kept.flatten().map_or(Begun::Unwanted, Begun::Elsewhere))
    }

    /// Completes a running job: stores the `documents` computed at its end (as JSON) or the id of the model it `made`, and marks it
    /// successful, in one transaction. False if the job was not running any more.
    pub async fn complete_job(
        &self,
        id: JobId,
        documents: &[(Document<'_>, String)],
        made: Option<&str>,
    ) -> Result<bool, StoreError> {
        let mut transaction = self.write().await?;
        transaction.guard(Guarded::Job(id)).await?;
        let status = status_of(&mut transaction, id).await?;
        if !status.is_some_and(|status| status.may_become(JobStatus::Successful)) {
            transaction.rollback().await?;
            return Ok(false);
        }
        let time = now();
        for (document, body) in documents {
            insert_document(&mut transaction, id, *document, body).await?;
        }
        let bytes: usize = documents.iter().map(|(_, body)| body.len()).sum();
        sqlx::query(
            "update jobs set status = 'successful', progress = 100, phase = '', stored_bytes = stored_bytes + $4,
                 finished_at = $2, updated_at = $2, model = coalesce($3, model)
             where id = $1",
        )
        .bind(id.to_string())
        .bind(time)
        .bind(made)
        .bind(bytes as i64)
        .execute(&mut *transaction)
        .await?;
        end_states::drop_of(&mut transaction, id).await?;
        transaction.commit_job(id).await?;
        Ok(true)
    }
}
