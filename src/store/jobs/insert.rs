//! Insertion of a new job.

use super::job::JobId;
use super::job_kind::JobKind;
use super::job_request::JobRequest;
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

impl Store {
    /// Stores a new job of `owner`, within `limits`, with the names and tags of `labels`, and with the answer its idempotency key will
    /// repeat. `facts` are those of the model it computes from, if it does.
    pub async fn insert_job(
        &self,
        id: JobId,
        (owner, limits): (&str, Limits),
        request: &JobRequest,
        labels: &Labels,
        facts: Option<&ModelFacts>,
        answer: Option<&Answer>,
    ) -> Result<Insertion, StoreError> {
        let mut transaction = self.write().await?;
        transaction.guard(Guarded::Owner(owner)).await?;
        // One order of models: otherwise two jobs that compare the same models could wait for each other.
        let mut models: Vec<&str> = request.model().into_iter().chain(request.compared_model()).collect();
        models.sort_unstable();
        for model in models {
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
        if request.kind() == JobKind::ModelGeneration
            && let Err(reached) = limits.allow_generation(&mut transaction, owner).await?
        {
            transaction.rollback().await?;
            return Ok(Insertion::Limit(reached));
        }
        let time = now();
        let inserted = sqlx::query(
            "insert into jobs (id, kind, model, modes_per_speed, facts, request, speeds, created_at, updated_at, owner,
                 revision, name, tags, notes, one_kind, compared_model)
             select $1, $2, $3, $4, $5, $6, $7, $8, $8, $9, $10, $11, $12, $13, $14, $15
             where ($3 is null or exists (select 1 from models where id = $3))
                 and ($15 is null or exists (select 1 from models where id = $15))",
        )
        .bind(id.to_string())
        .bind(request.kind().as_str())
        .bind(request.model())
        .bind(request.modes_per_speed().map(i64::from))
        .bind(facts.map(serde_json::to_string).transpose()?)
        .bind(request.to_json()?)
        .bind(i64::from(speeds))
        .bind(time)
        .bind(owner)
        .bind(i64::from(REVISION))
        .bind(&labels.name)
        .bind(serde_json::to_string(&labels.tags)?)
        .bind(&labels.notes)
        .bind(i64::from(request.is_of_one_kind()))
        .bind(request.compared_model())
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
