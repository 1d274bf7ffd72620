//! Insertion of a new job.

use super::job::{JobId, Posted};
use super::kept;
use crate::analysis::kinds::kind::{ResolvedJob, Units};
use crate::analysis::run::{ModelFacts, REVISION};
use crate::store::dialect::Guarded;
use crate::store::error::StoreError;
use crate::store::handle::Store;
use crate::store::idempotency::{self, Answer};
use crate::store::labels::Labels;
use crate::store::limits::{LimitReached, Limits};
use crate::store::time::now;

/// Outcome of inserting a job.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Insertion {
    /// Accepted job.
    Accepted,
    /// Model that does not exist (any more).
    UnknownModel,
    /// Idempotency key that was used meanwhile; nothing was stored.
    KeyTaken,
    /// Limit of the owner that is reached.
    Limit(LimitReached),
}

/// Job to be stored.
#[derive(Debug, Clone, Copy)]
pub struct NewJob<'a> {
    /// Id of the job.
    pub id: JobId,
    /// Owner of the job.
    pub owner: &'a str,
    /// Resolved request.
    pub request: &'a dyn ResolvedJob,
    /// Request as it was posted.
    pub posted: Option<&'a Posted>,
    /// Labels of the job.
    pub labels: &'a Labels,
    /// Facts of the model that it computes from, if it does.
    pub facts: Option<&'a ModelFacts>,
}

impl Store {
    /// Stores a new job, within the `limits` of its owner, with the answer that its idempotency key will repeat.
    pub async fn insert_job(
        &self,
        new: NewJob<'_>,
        limits: Limits,
        answer: Option<&Answer>,
    ) -> Result<Insertion, StoreError> {
        let NewJob { id, owner, request, posted, labels, facts } = new;
        let models = request.models();
        let mut transaction = self.write().await?;
        transaction.guard(Guarded::Owner(owner)).await?;
        // One order of models: otherwise two jobs that compare the same models could wait for each other.
        let mut guarded = models.clone();
        guarded.sort_unstable();
        for model in guarded {
            transaction.guard(Guarded::Model(model)).await?;
        }
        if let Some(answer) = answer
            && !idempotency::insert(&mut transaction, answer).await?
        {
            transaction.rollback().await?;
            return Ok(Insertion::KeyTaken);
        }
        let speeds = request.speeds();
        let asked = u64::from(request.speeds_at_most().max(1));
        if let Err(reached) = limits.allow_speeds(&mut transaction, owner, asked).await? {
            transaction.rollback().await?;
            return Ok(Insertion::Limit(reached));
        }
        if request.kind().units == Units::Model
            && let Err(reached) = limits.allow_generation(&mut transaction, owner).await?
        {
            transaction.rollback().await?;
            return Ok(Insertion::Limit(reached));
        }
        let time = now();
        let inserted = sqlx::query(
            "insert into jobs (id, kind, model, modes_per_speed, facts, request, speeds, created_at, updated_at, owner,
                 revision, name, tags, notes, one_kind, compared_model, posted_to, posted)
             select $1, $2, $3, $4, $5, $6, $7, $8, $8, $9, $10, $11, $12, $13, $14, $15, $16, $17
             where ($3 is null or exists (select 1 from models where id = $3))
                 and ($15 is null or exists (select 1 from models where id = $15))",
        )
        .bind(id.to_string())
        .bind(request.kind().name)
        .bind(models.first().copied())
        .bind(request.modes_per_speed().map(i64::from))
        .bind(facts.map(serde_json::to_string).transpose()?)
        .bind(kept::write(request)?)
        .bind(i64::from(speeds))
        .bind(time)
        .bind(owner)
        .bind(i64::from(REVISION))
        .bind(&labels.name)
        .bind(serde_json::to_string(&labels.tags)?)
        .bind(&labels.notes)
        .bind(i64::from(request.is_of_one_kind()))
        .bind(models.get(1).copied())
        .bind(posted.map(|posted| posted.to.as_str()))
        .bind(posted.map(|posted| posted.body.as_str()))
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

    /// Checks that other connections can read a job that was just stored: only then may its client be told so.
    async fn seen(&self, id: JobId) -> Result<(), StoreError> {
        let seen = sqlx::query("select id from jobs where id = $1")
            .bind(id.to_string())
            .fetch_optional(&self.readers)
            .await?;
        if seen.is_some() { Ok(()) } else { Err(StoreError::Unseen) }
    }
}
