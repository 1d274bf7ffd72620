//! Finished speeds of sweeps, and the documents computed during or at the end of a job.

use std::collections::BTreeSet;

use futures::TryStreamExt;
use sqlx::any::AnyRow;
use sqlx::{AnyConnection, Row};

use super::dialect::Guarded;
use super::error::StoreError;
use super::handle::Store;
use super::jobs::job::JobId;
use super::sql::{number, of};
use super::time::now;
use super::{end_states, packed};
use crate::analysis::kinds::document::Document;
use crate::analysis::result::{ContactForces, Point, PointStatus, SpeedResult, SpeedSpectra, WearMap};
use crate::analysis::run::REVISION;

/// Name and part of a document that a job has stored.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct StoredDocument {
    /// Name of the document.
    pub name: String,
    /// Part of the document.
    pub part: u32,
}

impl StoredDocument {
    /// Document by which the store finds it.
    pub fn document(&self) -> Document<'_> {
        Document::part(&self.name, self.part)
    }
}

/// Finished speed as it is stored.
#[derive(Debug)]
pub struct PackedSpeed {
    index: u32,
    status: PointStatus,
    vectors: Option<String>,
    point: String,
    /// Packed spectra, with the bytes that they take unpacked.
    spectra: Option<(Vec<u8>, u64)>,
    wear: Option<Vec<u8>>,
    contact: Option<Vec<u8>>,
    end_state: Option<Vec<u8>>,
}

impl PackedSpeed {
    /// Packs `result`, which takes a while where there are many sensors.
    pub fn of(result: &SpeedResult) -> Result<Self, StoreError> {
        Ok(Self {
            index: result.point.index,
            status: result.point.status,
            vectors: result.point.vectors.clone(),
            point: serde_json::to_string(&result.point)?,
            spectra: result.spectra.as_ref().map(packed::pack).transpose()?,
            wear: result.wear.as_ref().map(postcard::to_stdvec).transpose()?,
            contact: result.contact.as_ref().map(postcard::to_stdvec).transpose()?,
            end_state: result.end_state.as_ref().map(postcard::to_stdvec).transpose()?,
        })
    }

    /// Number of bytes that stay until the job is deleted.
    fn bytes(&self) -> usize {
        let spectra = self.spectra.as_ref().map_or(0, |(bytes, _)| bytes.len());
        let lists = [&self.wear, &self.contact].into_iter().flatten();
        self.point.len() + spectra + lists.map(Vec::len).sum::<usize>()
    }
}

impl Store {
    /// Stores a finished speed in a transaction of its own, with its end state in place of the last one if the job still wants work. An
    /// existing speed stays as it is; a speed of other numerics, or of another kind of processor where all must be of one, is dropped.
    /// Returns the number of finished speeds of the job; `None` if the job was deleted.
    pub async fn insert_speed(&self, job: JobId, speed: &PackedSpeed) -> Result<Option<u32>, StoreError> {
        let mut transaction = self.write().await?;
        transaction.guard(Guarded::Job(job)).await?;
        let inserted = sqlx::query(
            "insert into speed_results (job, speed, status, point, spectra, unpacked_bytes, wear, contact, created_at)
             select $1, $2, $3, $4, $5, $6, $7, $8, $9 where exists (
                 select 1 from jobs where id = $1 and deleted = 0 and revision = $10
                     and (one_kind = 0 or coalesce(vectors, $11, '') = coalesce($11, vectors, ''))
             )
             on conflict (job, speed) do nothing",
        )
        .bind(job.to_string())
        .bind(i64::from(speed.index))
        .bind(match speed.status {
            PointStatus::Completed => "completed",
            PointStatus::Diverged => "diverged",
            PointStatus::Failed => "failed",
        })
        .bind(&speed.point)
        .bind(speed.spectra.as_ref().map(|(bytes, _)| &bytes[..]))
        .bind(speed.spectra.as_ref().map(|(_, unpacked)| *unpacked as i64))
        .bind(speed.wear.as_deref())
        .bind(speed.contact.as_deref())
        .bind(now())
        .bind(i64::from(REVISION))
        .bind(speed.vectors.as_deref())
        .execute(&mut *transaction)
        .await?;
        if inserted.rows_affected() == 1 {
            end_states::replace(&mut transaction, job, speed.index, speed.end_state.as_deref()).await?;
            sqlx::query(
                "update jobs set crashes = 0, finished = finished + 1, diverged = diverged + $2, failed = failed + $3,
                     stored_bytes = stored_bytes + $4,
                     vectors = case when coalesce(vectors, $5) = coalesce($5, vectors) then coalesce(vectors, $5) else 'several' end
                 where id = $1",
            )
            .bind(job.to_string())
            .bind(i64::from(speed.status == PointStatus::Diverged))
            .bind(i64::from(speed.status == PointStatus::Failed))
            .bind(speed.bytes() as i64)
            .bind(speed.vectors.as_deref())
            .execute(&mut *transaction)
            .await?;
        }
        let finished: Option<i64> =
            sqlx::query_scalar("select finished from jobs where id = $1 and deleted = 0")
                .bind(job.to_string())
                .fetch_optional(&mut *transaction)
                .await?;
        transaction.commit_job(job).await?;
        finished.map(|finished| of("jobs.finished", finished)).transpose()
    }

    /// Lists the indices of the finished speeds of a job.
    pub async fn finished_speeds(&self, job: JobId) -> Result<BTreeSet<u32>, StoreError> {
        let speeds: Vec<i64> = sqlx::query_scalar("select speed from speed_results where job = $1")
            .bind(job.to_string())
            .fetch_all(&self.readers)
            .await?;
        speeds.into_iter().map(|speed| of("speed_results.speed", speed)).collect()
    }

    /// Whether speed `index` of a job is finished.
    pub async fn is_speed_finished(&self, job: JobId, index: u32) -> Result<bool, StoreError> {
        let found = sqlx::query("select speed from speed_results where job = $1 and speed = $2")
            .bind(job.to_string())
            .bind(i64::from(index))
            .fetch_optional(&self.readers)
            .await?;
        Ok(found.is_some())
    }

    /// Lists the credentials of all finished speeds of a job, in the order of the request.
    pub async fn points(&self, job: JobId) -> Result<Vec<Point>, StoreError> {
        let points: Vec<String> =
            sqlx::query_scalar("select point from speed_results where job = $1 order by speed")
                .bind(job.to_string())
                .fetch_all(&self.readers)
                .await?;
        Ok(points.iter().map(|point| serde_json::from_str(point)).collect::<Result<_, _>>()?)
    }

    /// Replaces the credentials of finished speeds of a job that still wants work, in one transaction.
    pub async fn revise_points(&self, job: JobId, points: &[Point]) -> Result<(), StoreError> {
        let mut transaction = self.write().await?;
        transaction.guard(Guarded::Job(job)).await?;
        for point in points {
            sqlx::query(
                "update speed_results set point = $3 where job = $1 and speed = $2 and exists (
                     select 1 from jobs where id = $1 and status in ('accepted', 'running', 'paused'))",
            )
            .bind(job.to_string())
            .bind(i64::from(point.index))
            .bind(serde_json::to_string(point)?)
            .execute(&mut *transaction)
            .await?;
        }
        transaction.commit_job(job).await?;
        Ok(())
    }

    /// Size of the credentials of all finished speeds of a job, bytes.
    pub async fn points_bytes(&self, job: JobId) -> Result<u64, StoreError> {
        let bytes: i64 = sqlx::query_scalar(
            "select cast(coalesce(sum(octet_length(point)), 0) as bigint) from speed_results where job = $1",
        )
        .bind(job.to_string())
        .fetch_one(&self.readers)
        .await?;
        Ok(bytes.unsigned_abs())
    }

    /// Row that `row` takes from the spectra of the finished speed `index` of a job; `None` where the speed has no spectra.
    ///
    /// # Errors
    /// Also a speed that does not exist (any more).
    pub async fn map_row(
        &self,
        job: JobId,
        index: u32,
        row: impl Fn(&SpeedSpectra) -> Option<Vec<f64>>,
    ) -> Result<Option<Vec<f64>>, StoreError> {
        let found =
            sqlx::query("select spectra, unpacked_bytes from speed_results where job = $1 and speed = $2")
                .bind(job.to_string())
                .bind(i64::from(index))
                .fetch_one(&self.readers)
                .await?;
        Ok(spectra(&found)?.and_then(|spectra| row(&spectra)))
    }

    /// Largest size that the spectra of one speed of a job take unpacked, bytes.
    pub async fn largest_spectra(&self, job: JobId) -> Result<u64, StoreError> {
        let bytes: i64 = sqlx::query_scalar(
            "select coalesce(max(coalesce(unpacked_bytes, length(spectra))), 0) from speed_results where job = $1",
        )
        .bind(job.to_string())
        .fetch_one(&self.readers)
        .await?;
        Ok(bytes.unsigned_abs())
    }

    /// Finds speed `index` of a job, if it is finished.
    pub async fn speed_result(&self, job: JobId, index: u32) -> Result<Option<SpeedResult>, StoreError> {
        sqlx::query(
            "select point, spectra, unpacked_bytes, wear, contact from speed_results where job = $1 and speed = $2",
        )
        .bind(job.to_string())
        .bind(i64::from(index))
        .fetch_optional(&self.readers)
        .await?
        .map(|row| read(&row))
        .transpose()
    }

    /// Lists what `row` takes from the contact of each speed of a job that has any, by index.
    pub async fn contacts<T>(
        &self,
        job: JobId,
        row: impl Fn(&Point, &ContactForces) -> Option<T>,
    ) -> Result<Vec<(u32, T)>, StoreError> {
        let mut speeds = sqlx::query(
            "select speed, point, contact from speed_results where job = $1 and contact is not null order by speed",
        )
        .bind(job.to_string())
        .fetch(&self.readers);
        let mut found = Vec::new();
        while let Some(speed) = speeds.try_next().await? {
            let point = serde_json::from_str(speed.try_get("point")?)?;
            if let Some(taken) = contact(&speed)?.and_then(|contact| row(&point, &contact)) {
                found.push((number(&speed, "speed")?, taken));
            }
        }
        Ok(found)
    }

    /// Stores a document of a running job, in a transaction of its own, and counts the run that it is of, if that `ended`. An existing document
    /// stays as it is; a deleted job stores nothing.
    pub async fn keep_document(
        &self,
        job: JobId,
        document: Document<'_>,
        body: &str,
        ended: Option<PointStatus>,
    ) -> Result<(), StoreError> {
        let mut transaction = self.write().await?;
        transaction.guard(Guarded::Job(job)).await?;
        let is_new = keep_result(&mut transaction, job, document, body).await?;
        if let Some(status) = ended.filter(|_| is_new) {
            count_run(&mut transaction, job, status).await?;
        }
        transaction.commit_job(job).await?;
        Ok(())
    }

    /// Size of the text of a document in bytes, if it exists.
    pub async fn document_bytes(
        &self,
        job: JobId,
        document: Document<'_>,
    ) -> Result<Option<u64>, StoreError> {
        let Document { name, part } = document;
        let bytes: Option<i64> = sqlx::query_scalar(
            "select octet_length(body) from documents where job = $1 and name = $2 and part = $3",
        )
        .bind(job.to_string())
        .bind(name)
        .bind(i64::from(part))
        .fetch_optional(&self.readers)
        .await?;
        Ok(bytes.map(i64::unsigned_abs))
    }

    /// Lists the documents of a finished job.
    pub async fn documents(&self, job: JobId) -> Result<Vec<StoredDocument>, StoreError> {
        let rows = sqlx::query("select name, part from documents where job = $1 order by name, part")
            .bind(job.to_string())
            .fetch_all(&self.readers)
            .await?;
        rows.iter()
            .map(|row| Ok(StoredDocument { name: row.try_get("name")?, part: number(row, "part")? }))
            .collect()
    }

    /// Lists the parts of the documents called `name` that a job has stored, ascending.
    pub async fn document_parts(&self, job: JobId, name: &str) -> Result<Vec<u32>, StoreError> {
        let parts: Vec<i64> =
            sqlx::query_scalar("select part from documents where job = $1 and name = $2 order by part")
                .bind(job.to_string())
                .bind(name)
                .fetch_all(&self.readers)
                .await?;
        parts.into_iter().map(|part| of("documents.part", part)).collect()
    }

    /// Finds a document of a finished job, as JSON text.
    pub async fn document(&self, job: JobId, document: Document<'_>) -> Result<Option<String>, StoreError> {
        let Document { name, part } = document;
        Ok(sqlx::query_scalar("select body from documents where job = $1 and name = $2 and part = $3")
            .bind(job.to_string())
            .bind(name)
            .bind(i64::from(part))
            .fetch_optional(&self.readers)
            .await?)
    }
}

/// Stores a document that is not one of the job's results. Returns whether it was new and the job exists.
pub(super) async fn insert_document(
    connection: &mut AnyConnection,
    job: JobId,
    document: Document<'_>,
    body: &str,
) -> Result<bool, StoreError> {
    let Document { name, part } = document;
    let inserted = sqlx::query(
        "insert into documents (job, name, part, body, created_at)
         select $1, $2, $3, $4, $5 where exists (select 1 from jobs where id = $1 and deleted = 0)
         on conflict (job, name, part) do nothing",
    )
    .bind(job.to_string())
    .bind(name)
    .bind(i64::from(part))
    .bind(body)
    .bind(now())
    .execute(connection)
    .await?;
    Ok(inserted.rows_affected() == 1)
}

/// Stores a document that is a result: its bytes count, and the crash count of the job begins anew. Returns whether it was new and the job
/// exists.
pub(super) async fn keep_result(
    connection: &mut AnyConnection,
    job: JobId,
    document: Document<'_>,
    body: &str,
) -> Result<bool, StoreError> {
    let inserted = insert_document(connection, job, document, body).await?;
    if inserted {
        sqlx::query("update jobs set crashes = 0, stored_bytes = stored_bytes + $2 where id = $1")
            .bind(job.to_string())
            .bind(body.len() as i64)
            .execute(connection)
            .await?;
    }
    Ok(inserted)
}

/// Counts a run of a job by the status with which it ended.
pub(super) async fn count_run(
    connection: &mut AnyConnection,
    job: JobId,
    status: PointStatus,
) -> Result<(), StoreError> {
    sqlx::query(
        "update jobs set finished = finished + 1, diverged = diverged + $2, failed = failed + $3 where id = $1",
    )
    .bind(job.to_string())
    .bind(i64::from(status == PointStatus::Diverged))
    .bind(i64::from(status == PointStatus::Failed))
    .execute(connection)
    .await?;
    Ok(())
}

fn contact(row: &AnyRow) -> Result<Option<ContactForces>, StoreError> {
    let contact: Option<&[u8]> = row.try_get("contact")?;
    Ok(contact.map(postcard::from_bytes).transpose()?)
}

pub(super) fn read(row: &AnyRow) -> Result<SpeedResult, StoreError> {
    let wear: Option<&[u8]> = row.try_get("wear")?;
    let wear: Option<WearMap> = wear.map(postcard::from_bytes).transpose()?;
    let point = serde_json::from_str(row.try_get("point")?)?;
    Ok(SpeedResult { point, spectra: spectra(row)?, wear, contact: contact(row)?, end_state: None })
}

fn spectra(row: &AnyRow) -> Result<Option<SpeedSpectra>, StoreError> {
    let Some(bytes) = row.try_get::<Option<&[u8]>, _>("spectra")? else { return Ok(None) };
    // Earlier versions stored spectra without packing.
    let packed = row.try_get::<Option<i64>, _>("unpacked_bytes")?.is_some();
    Ok(Some(if packed { packed::unpack(bytes)? } else { packed::read_unpacked(bytes)? }))
}
