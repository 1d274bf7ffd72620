//! What is followed leg by leg, and how far it has been: branches and run-ups.

use super::dialect::Guarded;
use super::error::StoreError;
use super::handle::Store;
use super::jobs::job::JobId;
use super::results::{Document, insert_document, keep_result};
use super::sql::of;
use crate::analysis::result::PointStatus;

/// What has legs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Followed {
    /// Branches of periodic responses.
    Branches,
    /// Wheels whose speed changes.
    RunUps,
}

impl Followed {
    /// A leg of it.
    pub fn leg(self, index: u32) -> Document {
        match self {
            Self::Branches => Document::BranchLeg(index),
            Self::RunUps => Document::RunUpLeg(index),
        }
    }

    /// How far it has been followed.
    pub fn course(self) -> Document {
        match self {
            Self::Branches => Document::BranchCourse,
            Self::RunUps => Document::RunUpCourse,
        }
    }

    /// What is kept beside a leg, if it has such.
    pub fn beside(self, index: u32) -> Option<Document> {
        match self {
            Self::Branches => None,
            Self::RunUps => Some(Document::RunUpSpectra(index)),
        }
    }
}

impl Store {
    /// Keeps leg `index` of a job, with what belongs `beside` it and how the run it is the last of has `ended`, together with the course after it, in place of the one before; none where
    /// nothing is left to follow. A leg that is there already stays as it is, and so does its course; a job that was deleted keeps nothing.
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

    /// How many legs of a job there are.
    pub async fn legs(&self, job: JobId, followed: Followed) -> Result<u32, StoreError> {
        Ok(self.parts(job, followed.leg(0)).await?.0)
    }

    /// How many documents of the kind of this one a job has, and the bytes of their texts.
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
