//! One job, or a page of them.

use sqlx::AssertSqlSafe;

use super::job::{Job, JobHead, JobId};
use super::job_kind::JobKind;
use super::row::{HEAD, read, read_head};
use crate::store::error::StoreError;
use crate::store::handle::Store;
use crate::store::status::JobStatus;

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
    pub async fn jobs(&self, filter: JobFilter, limit: u32) -> Result<Vec<JobHead>, StoreError> {
        sqlx::query(AssertSqlSafe(format!(
            "select {HEAD} from jobs where deleted = 0 and (?1 is null or status = ?1) and (?2 is null or kind = ?2)
                 and (?3 is null or id < ?3) and (?5 is null or owner = ?5)
             order by id desc limit ?4",
        )))
            .bind(filter.status.map(JobStatus::as_str))
            .bind(filter.kind.map(JobKind::as_str))
            .bind(filter.before.map(|id| id.to_string()))
            .bind(limit)
            .bind(filter.owner)
            .fetch_all(&self.readers)
            .await?
            .iter()
            .map(read_head)
            .collect()
    }
}
