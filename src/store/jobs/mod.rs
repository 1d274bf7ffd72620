//! Jobs: what was asked for and how far it is.

mod delete;
mod job;
mod revise;
mod take_up;

use sqlx::Row;
use sqlx::sqlite::SqliteRow;

use super::idempotency::{self, Answer};
use super::limits::{LimitReached, Limits};
use super::results::Document;
use super::status::JobStatus;
use super::{Store, StoreError, end_states, now};
use crate::analysis::run::{Estimate, ModelFacts};

pub use delete::JobDeletion;
pub use job::{Chosen, Failure, FailureCause, Job, JobId, JobKind, JobRequest, SpeedCounts};
pub use take_up::Unfinished;

/// What became of a job that was to be kept.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Insertion {
    /// It is accepted.
    Accepted,
    /// Its model is not there (any more).
    UnknownModel,
    /// The idempotency key was used meanwhile; nothing was kept.
    KeyTaken,
    /// Its owner has too much already.
    Limit(LimitReached),
}

/// Which jobs to list.
#[derive(Debug, Clone, Default)]
pub struct JobFilter {
    /// Only of this owner.
    pub owner: Option<String>,
    /// Only with this status.
    pub status: Option<JobStatus>,
    /// Only of this kind.
    pub kind: Option<JobKind>,
    /// Only older than this one: the last of the previous page.
    pub before: Option<JobId>,
}

impl Store {
    /// Keeps a new job of `owner`, within `limits`, with the answer its idempotency key will repeat. `facts` are those of the model it computes
    /// from, if it does.
    pub async fn insert_job(
        &self,
        id: JobId,
        (owner, limits): (&str, Limits),
        request: &JobRequest,
        facts: Option<&ModelFacts>,
        speeds: u32,
        answer: Option<&Answer>,
    ) -> Result<Insertion, StoreError> {
        let mut transaction = self.write().await?;
        if let Some(answer) = answer
            && !idempotency::insert(&mut transaction, answer).await?
        {
            transaction.rollback().await?;
            return Ok(Insertion::KeyTaken);
        }
        let asked = u64::from(speeds.max(1));
        if let Err(reached) = limits.allow_speeds(&mut transaction, owner, asked).await? {
            transaction.rollback().await?;
            return Ok(Insertion::Limit(reached));
        }
        let time = now();
        let inserted = sqlx::query(
            "insert into jobs (id, kind, model, modes_per_speed, facts, request, speeds, created_at, updated_at, owner)
             select ?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?8, ?9
             where ?3 is null or exists (select 1 from models where id = ?3)",
        )
        .bind(id.to_string())
        .bind(request.kind().as_str())
        .bind(request.model())
        .bind(request.modes_per_speed())
        .bind(facts.map(serde_json::to_string).transpose()?)
        .bind(request.to_json()?)
        .bind(speeds)
        .bind(time)
        .bind(owner)
        .execute(&mut *transaction)
        .await?;
        if inserted.rows_affected() == 0 {
            transaction.rollback().await?;
            return Ok(Insertion::UnknownModel);
        }
        transaction.commit().await?;
        self.seen(id).await?;
        Ok(Insertion::Accepted)
    }

    /// Whether others can read a job that was just kept: only then may its client be told so.
    async fn seen(&self, id: JobId) -> Result<(), StoreError> {
        let seen: bool = sqlx::query_scalar("select exists (select 1 from jobs where id = ?)")
            .bind(id.to_string())
            .fetch_one(&self.readers)
            .await?;
        if seen { Ok(()) } else { Err(StoreError::Unseen) }
    }

    /// The job `id`.
    pub async fn job(&self, id: JobId) -> Result<Option<Job>, StoreError> {
        sqlx::query("select * from jobs where id = ? and deleted = 0")
            .bind(id.to_string())
            .fetch_optional(&self.readers)
            .await?
            .map(|row| read(&row))
            .transpose()
    }

    /// Up to `limit` jobs that pass `filter`, newest first.
    pub async fn jobs(&self, filter: JobFilter, limit: u32) -> Result<Vec<Job>, StoreError> {
        sqlx::query(
            "select * from jobs where deleted = 0 and (?1 is null or status = ?1) and (?2 is null or kind = ?2)
                 and (?3 is null or id < ?3) and (?5 is null or owner = ?5)
             order by id desc limit ?4",
        )
            .bind(filter.status.map(JobStatus::as_str))
            .bind(filter.kind.map(JobKind::as_str))
            .bind(filter.before.map(|id| id.to_string()))
            .bind(limit)
            .bind(filter.owner)
            .fetch_all(&self.readers)
            .await?
            .iter()
            .map(read)
            .collect()
    }

    /// Moves a job on, if the transition table allows it. Returns the status it has now; `None` if there is no
    /// such job. `failure` goes with [`JobStatus::Failed`] and with nothing else.
    pub async fn advance_job(
        &self,
        id: JobId,
        next: JobStatus,
        failure: Option<&Failure>,
    ) -> Result<Option<JobStatus>, StoreError> {
        let mut transaction = self.write().await?;
        let status = status_of(&mut transaction, id).await?;
        if !status.is_some_and(|status| status.may_become(next)) {
            transaction.rollback().await?;
            return Ok(status);
        }
        let time = now();
        sqlx::query(
            "update jobs set status = ?2, error = ?3, updated_at = ?4,
                 finished_at = case when ?5 then ?4 end
             where id = ?1",
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
        transaction.commit().await?;
        Ok(Some(next))
    }

    /// Takes a job in hand: it is running from here on. False if it wants no work any more.
    pub async fn begin_job(&self, id: JobId) -> Result<bool, StoreError> {
        let mut write = self.write().await?;
        let begun = sqlx::query(
            "update jobs set status = 'running', updated_at = ?2,
                 started_at = coalesce(started_at, ?2)
             where id = ?1 and status in ('accepted', 'running')",
        )
        .bind(id.to_string())
        .bind(now())
        .execute(&mut *write)
        .await?;
        write.commit().await?;
        Ok(begun.rows_affected() == 1)
    }

    /// Ends a running job well: keeps the `documents` computed at its end (as JSON) or the id of the model it `made`,
    /// and marks it successful, in one transaction. False if the job was not running any more.
    pub async fn complete_job(
        &self,
        id: JobId,
        documents: &[(Document, String)],
        made: Option<&str>,
    ) -> Result<bool, StoreError> {
        let mut transaction = self.write().await?;
        let status = status_of(&mut transaction, id).await?;
        if !status.is_some_and(|status| status.may_become(JobStatus::Successful)) {
            transaction.rollback().await?;
            return Ok(false);
        }
        let time = now();
        for (document, body) in documents {
            let (name, part) = document.columns();
            sqlx::query("insert into documents (job, name, part, body, created_at) values (?, ?, ?, ?, ?)")
                .bind(id.to_string())
                .bind(name)
                .bind(part)
                .bind(body)
                .bind(&time)
                .execute(&mut *transaction)
                .await?;
        }
        let bytes: usize = documents.iter().map(|(_, body)| body.len()).sum();
        sqlx::query(
            "update jobs set status = 'successful', progress = 100, phase = '', stored_bytes = stored_bytes + ?4,
                 finished_at = ?2, updated_at = ?2, model = coalesce(?3, model)
             where id = ?1",
        )
        .bind(id.to_string())
        .bind(time)
        .bind(made)
        .bind(bytes as i64)
        .execute(&mut *transaction)
        .await?;
        end_states::drop_of(&mut transaction, id).await?;
        transaction.commit().await?;
        Ok(true)
    }

    /// Records progress of a running job. It never falls, and only [`Store::complete_job`] reaches 100.
    pub async fn record_progress(&self, id: JobId, percent: u8, phase: &str) -> Result<(), StoreError> {
        let mut write = self.write().await?;
        sqlx::query(
            "update jobs set progress = max(progress, min(?2, 99)), phase = ?3, updated_at = ?4
             where id = ?1 and status = 'running'",
        )
        .bind(id.to_string())
        .bind(percent)
        .bind(phase)
        .bind(now())
        .execute(&mut *write)
        .await?;
        write.commit().await
    }

    /// Keeps the settings that were chosen for a job, and why.
    pub async fn record_choice(&self, id: JobId, choice: &Chosen) -> Result<(), StoreError> {
        let mut write = self.write().await?;
        sqlx::query("update jobs set choice = ? where id = ?")
            .bind(serde_json::to_string(choice)?)
            .bind(id.to_string())
            .execute(&mut *write)
            .await?;
        write.commit().await
    }

    /// Keeps what a sweep is expected to cost; the first estimate stays.
    pub async fn record_plan(&self, id: JobId, estimate: &Estimate) -> Result<(), StoreError> {
        let mut write = self.write().await?;
        sqlx::query("update jobs set plan = ? where id = ? and plan is null")
            .bind(serde_json::to_string(estimate)?)
            .bind(id.to_string())
            .execute(&mut *write)
            .await?;
        write.commit().await
    }
}

async fn status_of(
    connection: &mut sqlx::SqliteConnection,
    id: JobId,
) -> Result<Option<JobStatus>, StoreError> {
    let status: Option<String> = sqlx::query_scalar("select status from jobs where id = ? and deleted = 0")
        .bind(id.to_string())
        .fetch_optional(connection)
        .await?;
    status.map(|status| JobStatus::from_column(&status)).transpose()
}

fn read_id(text: &str) -> Result<JobId, StoreError> {
    JobId::parse(text).ok_or_else(|| StoreError::Unknown { column: "jobs.id", value: text.to_owned() })
}

pub(super) fn read(row: &SqliteRow) -> Result<Job, StoreError> {
    let kind: &str = row.try_get("kind")?;
    let request: &str = row.try_get("request")?;
    let request = match kind {
        "sweep" => JobRequest::Sweep(serde_json::from_str(request)?),
        "modal_analysis" => JobRequest::ModalAnalysis(serde_json::from_str(request)?),
        "study" => JobRequest::Study(serde_json::from_str(request)?),
        "model_generation" => JobRequest::ModelGeneration(serde_json::from_str(request)?),
        _ => return Err(StoreError::Unknown { column: "jobs.kind", value: kind.to_owned() }),
    };
    let status = JobStatus::from_column(row.try_get("status")?)?;
    let total = row.try_get("speeds")?;
    let finished = match (&request, status) {
        // These compute their speeds together.
        (JobRequest::ModalAnalysis(_) | JobRequest::Study(_), JobStatus::Successful) => total,
        _ => row.try_get("finished")?,
    };
    Ok(Job {
        id: read_id(row.try_get("id")?)?,
        owner: row.try_get("owner")?,
        status,
        model: row.try_get("model")?,
        facts: row.try_get::<Option<&str>, _>("facts")?.map(serde_json::from_str).transpose()?,
        request,
        progress: row.try_get("progress")?,
        phase: row.try_get("phase")?,
        speeds: SpeedCounts {
            total,
            finished,
            diverged: row.try_get("diverged")?,
            failed: row.try_get("failed")?,
        },
        stored_bytes: row.try_get::<i64, _>("stored_bytes")?.unsigned_abs(),
        plan: row.try_get::<Option<&str>, _>("plan")?.map(serde_json::from_str).transpose()?,
        choice: row.try_get::<Option<&str>, _>("choice")?.map(serde_json::from_str).transpose()?,
        failure: row.try_get::<Option<&str>, _>("error")?.map(serde_json::from_str).transpose()?,
        created_at: row.try_get("created_at")?,
        started_at: row.try_get("started_at")?,
        finished_at: row.try_get("finished_at")?,
        updated_at: row.try_get("updated_at")?,
    })
}
