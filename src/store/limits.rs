//! Limits on what one owner may have in the store.

use sqlx::{AnyConnection, AssertSqlSafe, SqlSafeStr};

use super::error::StoreError;
use super::sql::kinds_of;
use crate::analysis::kinds::kind::Units;

/// Limits of one owner; `None` for no limit.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Limits {
    /// Number of speeds of unfinished jobs that are still to be computed; a job without speeds counts as one.
    pub queued_speeds: Option<u64>,
    /// Size of results and packages, bytes.
    pub stored_bytes: Option<u64>,
    /// Number of models.
    pub models: Option<u64>,
}

/// Limit that a request would exceed, or that is reached.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum LimitReached {
    /// Limit on queued speeds.
    #[error("{queued} speeds of yours wait to be computed, {asked} more would exceed the limit of {limit}")]
    QueuedSpeeds {
        /// Number of speeds that wait already.
        queued: u64,
        /// Number of speeds of the new job.
        asked: u64,
        /// Largest number of speeds that may wait.
        limit: u64,
    },
    /// Limit on simultaneous requests.
    #[error(
        "{limit} of your requests are already being checked or planned, the most for one owner: wait for some of their answers"
    )]
    Plans {
        /// Largest number of simultaneous requests.
        limit: usize,
    },
    /// Limit on stored bytes.
    #[error(
        "your models and results take {stored} bytes, with {more} to be added, and the limit is {limit}: delete jobs or models"
    )]
    StoredBytes {
        /// Bytes already stored.
        stored: u64,
        /// Bytes that were to be added, as far as known.
        more: u64,
        /// Largest number of stored bytes.
        limit: u64,
    },
    /// Limit on models.
    #[error(
        "you have {models} models, those that are being generated included, and the limit is {limit}: delete some"
    )]
    Models {
        /// Number of existing models.
        models: u64,
        /// Largest number of models.
        limit: u64,
    },
}

impl Limits {
    /// Checks that `owner` may queue `asked` more speeds.
    pub(super) async fn allow_speeds(
        self,
        connection: &mut AnyConnection,
        owner: &str,
        asked: u64,
    ) -> Result<Result<(), LimitReached>, StoreError> {
        if let Some(limit) = self.queued_speeds {
            let sql = "select cast(coalesce(sum(case when speeds > finished then speeds - finished else 1 end), 0) as bigint) from jobs
                       where owner = $1 and status in ('accepted', 'running', 'paused')";
            let queued = count(connection, sql, owner).await?;
            if queued + asked > limit {
                return Ok(Err(LimitReached::QueuedSpeeds { queued, asked, limit }));
            }
        }
        // The bytes of their results are not known yet.
        self.allow_bytes(connection, owner, 0).await
    }

    /// Checks that `owner` may have one more model of `bytes` bytes, beside those that are being generated.
    pub(super) async fn allow_model(
        self,
        connection: &mut AnyConnection,
        owner: &str,
        bytes: u64,
    ) -> Result<Result<(), LimitReached>, StoreError> {
        if let Err(reached) = self.allow_generation(connection, owner).await? {
            return Ok(Err(reached));
        }
        self.allow_bytes(connection, owner, bytes).await
    }

    /// Checks that `owner` may have one more model whose size is not known yet.
    pub(super) async fn allow_generation(
        self,
        connection: &mut AnyConnection,
        owner: &str,
    ) -> Result<Result<(), LimitReached>, StoreError> {
        let Some(limit) = self.models else { return Ok(Ok(())) };
        let sql = format!(
            "select (select count(*) from model_owners where owner = $1)
                   + (select count(*) from jobs where owner = $1 and kind in {}
                      and status in ('accepted', 'running', 'paused'))",
            kinds_of(Units::Model)
        );
        let models = count(connection, AssertSqlSafe(sql), owner).await?;
        Ok(if models >= limit { Err(LimitReached::Models { models, limit }) } else { Ok(()) })
    }

    async fn allow_bytes(
        self,
        connection: &mut AnyConnection,
        owner: &str,
        more: u64,
    ) -> Result<Result<(), LimitReached>, StoreError> {
        let Some(limit) = self.stored_bytes else { return Ok(Ok(())) };
        let sql =
            "select cast((select coalesce(sum(stored_bytes), 0) from jobs where owner = $1 and deleted = 0)
                   + (select coalesce(sum(size_bytes), 0) from models
                      where id in (select model from model_owners where owner = $1)) as bigint)";
        let stored = count(connection, sql, owner).await?;
        let reached = stored >= limit || stored.saturating_add(more) > limit;
        Ok(if reached { Err(LimitReached::StoredBytes { stored, more, limit }) } else { Ok(()) })
    }
}

async fn count(connection: &mut AnyConnection, sql: impl SqlSafeStr, owner: &str) -> Result<u64, StoreError> {
    let count: i64 = sqlx::query_scalar(sql).bind(owner).fetch_one(connection).await?;
    Ok(count.unsigned_abs())
}
