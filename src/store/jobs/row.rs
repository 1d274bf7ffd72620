//! Conversion of rows to jobs.

use sqlx::Row;
use sqlx::any::AnyRow;

use super::job::{Job, JobHead, JobId, Posted, SpeedCounts};
use super::kept;
use crate::analysis::kinds::kind::{ResolvedJob, Units};
use crate::analysis::result::VerdictWord;
use crate::kinds::JobKind;
use crate::store::error::StoreError;
use crate::store::labels;
use crate::store::sql::number;
use crate::store::status::JobStatus;

pub(super) async fn status_of(
    connection: &mut sqlx::AnyConnection,
    id: JobId,
) -> Result<Option<JobStatus>, StoreError> {
    let status: Option<String> = sqlx::query_scalar("select status from jobs where id = $1 and deleted = 0")
        .bind(id.to_string())
        .fetch_optional(connection)
        .await?;
    status.map(|status| JobStatus::from_column(&status)).transpose()
}

pub(super) fn read_id(text: &str) -> Result<JobId, StoreError> {
    JobId::parse(text).ok_or_else(|| StoreError::Unknown { column: "jobs.id", value: text.to_owned() })
}

/// Columns that [`read_head`] reads.
pub(super) const HEAD: &str = "id, owner, kind, status, model, progress, phase, speeds, finished, diverged, failed, stored_bytes, error, verdict,
    created_at, started_at, finished_at, updated_at, name, tags, notes";

pub(super) fn read_head(row: &AnyRow) -> Result<JobHead, StoreError> {
    let kind = kind(row.try_get("kind")?)?;
    let status = JobStatus::from_column(row.try_get("status")?)?;
    let total = number(row, "speeds")?;
    // Only speeds that are tasks of their own are counted one by one.
    let finished = match status {
        JobStatus::Successful if kind.units != Units::Speeds => total,
        _ => number(row, "finished")?,
    };
    Ok(JobHead {
        id: read_id(row.try_get("id")?)?,
        owner: row.try_get("owner")?,
        kind,
        labels: labels::read(row)?,
        status,
        model: row.try_get("model")?,
        progress: number(row, "progress")?,
        phase: row.try_get("phase")?,
        speeds: SpeedCounts {
            total,
            finished,
            diverged: number(row, "diverged")?,
            failed: number(row, "failed")?,
        },
        stored_bytes: row.try_get::<i64, _>("stored_bytes")?.unsigned_abs(),
        failure: row.try_get::<Option<&str>, _>("error")?.map(serde_json::from_str).transpose()?,
        verdict: row.try_get::<Option<&str>, _>("verdict")?.map(verdict).transpose()?,
        created_at: row.try_get("created_at")?,
        started_at: row.try_get("started_at")?,
        finished_at: row.try_get("finished_at")?,
        updated_at: row.try_get("updated_at")?,
    })
}

/// Kind that a column holds.
fn kind(name: &str) -> Result<JobKind, StoreError> {
    JobKind::named(name).ok_or_else(|| StoreError::Unknown { column: "jobs.kind", value: name.to_owned() })
}

/// Verdict that a column holds.
fn verdict(word: &str) -> Result<VerdictWord, StoreError> {
    let unknown = || StoreError::Unknown { column: "jobs.verdict", value: word.to_owned() };
    VerdictWord::named(word).ok_or_else(unknown)
}

/// Request as it was posted; earlier versions did not keep it, but what they resolved can often be posted.
fn posted(row: &AnyRow, head: &JobHead, request: &dyn ResolvedJob) -> Result<Option<Posted>, StoreError> {
    let (to, body): (Option<String>, Option<String>) = (row.try_get("posted_to")?, row.try_get("posted")?);
    if let Some((to, body)) = to.zip(body) {
        return Ok(Some(Posted { to, body }));
    }
    Ok(request.as_posted()?.map(|body| Posted { to: head.kind.route.to_owned(), body }))
}

pub(crate) fn read(row: &AnyRow) -> Result<Job, StoreError> {
    let head = read_head(row)?;
    let request = kept::read(head.kind, row.try_get("request")?)?;
    Ok(Job {
        posted: posted(row, &head, &*request)?,
        request,
        facts: row.try_get::<Option<&str>, _>("facts")?.map(serde_json::from_str).transpose()?,
        plan: row.try_get::<Option<&str>, _>("plan")?.map(serde_json::from_str).transpose()?,
        choice: row.try_get::<Option<&str>, _>("choice")?.map(serde_json::from_str).transpose()?,
        revision: number(row, "revision")?,
        vectors: row.try_get("vectors")?,
        head,
    })
}
