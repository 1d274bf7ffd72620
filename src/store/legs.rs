//! Legs of branches and run-ups, stored one by one, with the course that the next leg continues.

use super::dialect::Guarded;
use super::error::StoreError;
use super::handle::Store;
use super::jobs::job::JobId;
use super::results::{Document, insert_document, keep_result};
use super::sql::of;
use crate::analysis::result::PointStatus;

/// Kind of job that is computed leg by leg.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Followed {
    /// Branches of periodic responses.
    Branches,
    /// Run-ups: wheels whose speed changes.
    RunUps,
}

impl Followed {
    /// Document of leg `index`.
    pub fn leg(self, index: u32) -> Document {
        match self {
            Self::Branches => Document::BranchLeg(index),
            Self::RunUps => Document::RunUpLeg(index),
        }
    }

    /// Document of the course: the state from which the next leg continues.
    pub fn course(self) -> Document {
        match self {
            Self::Branches => Document::BranchCourse,
            Self::RunUps => Document::RunUpCourse,
        }
    }

    /// Document stored beside leg `index`, if this kind has one.
    pub fn beside(self, index: u32) -> Option<Document> {
        match self {
            Self::Branches => None,
            Self::RunUps => Some(Document::RunUpSpectra(index)),
        }
    }
}

impl Store {
    /// Stores leg `index` of a job, with the document `beside` it, and the status with which a run has `ended` if this leg is its last,
    /// together with the course after it in place of the one before; no course where nothing is left to compute. An existing leg stays as
    /// it is, and so does its course; a deleted job stores nothing.
    pub async fn keep_leg(
        &self,
        job: JobId,
        (followed, index): (Followed, u32),
        (leg, beside): (&str, Option<&str>),
        ended: Option<PointStatus>,
        course: Option<&str>,
    ) -> Result<(), StoreError> {
        let mut transaction = self.write().await?;
        transaction.guard(Guarded::Job(job)).await?;
        if keep_result(&mut transaction, job, followed.leg(index), leg).await? {
            if let Some((document, text)) = followed.beside(index).zip(beside) {
                keep_result(&mut transaction, job, document, text).await?;
            }
            if let Some(status) = ended {
                sqlx::query(
                    "update jobs set finished = finished + 1, diverged = diverged + $2, failed = failed + $3 where id = $1",
                )
                .bind(job.to_string())
                .bind(i64::from(status == PointStatus::Diverged))
                .bind(i64::from(status == PointStatus::Failed))
                .execute(&mut *transaction)
                .await?;
            }
            let (name, part) = followed.course().columns();
            sqlx::query("delete from documents where job = $1 and name = $2 and part = $3")
                .bind(job.to_string())
                .bind(name)
                .bind(i64::from(part))
                .execute(&mut *transaction)
                .await?;
            if let Some(course) = course {
                insert_document(&mut transaction, job, followed.course(), course).await?;
            }
        }
        transaction.commit_job(job).await?;
        Ok(())
    }

    /// Number of legs of a job.
    pub async fn legs(&self, job: JobId, followed: Followed) -> Result<u32, StoreError> {
        Ok(self.parts(job, followed.leg(0)).await?.0)
    }

    /// Number of documents of the kind of `of_kind` that a job has, and the bytes of their texts.
    pub async fn parts(&self, job: JobId, of_kind: Document) -> Result<(u32, u64), StoreError> {
        let (name, _) = of_kind.columns();
        let (count, bytes): (i64, i64) = sqlx::query_as(
            "select count(*), cast(coalesce(sum(octet_length(body)), 0) as bigint) from documents where job = $1 and name = $2",
        )
        .bind(job.to_string())
        .bind(name)
        .fetch_one(&self.readers)
        .await?;
        Ok((of("documents.part", count)?, bytes.unsigned_abs()))
    }
}
