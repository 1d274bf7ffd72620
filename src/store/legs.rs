//! Legs of jobs, stored one by one, with the course that the next leg continues.

use super::dialect::Guarded;
use super::error::StoreError;
use super::handle::Store;
use super::jobs::job::JobId;
use super::results::{count_run, insert_document, keep_result};
use super::sql::of;
use crate::analysis::kinds::document::Document;
use crate::analysis::kinds::kind::{Leg, LegNames};

impl Store {
    /// Stores leg `index` of a job with the document beside it and the course after it, in place of the course before. An existing leg
    /// stays as it is, and so does its course; a deleted job stores nothing.
    pub async fn keep_leg(
        &self,
        job: JobId,
        names: LegNames,
        index: u32,
        leg: &Leg,
    ) -> Result<(), StoreError> {
        let mut transaction = self.write().await?;
        transaction.guard(Guarded::Job(job)).await?;
        if keep_result(&mut transaction, job, Document::part(names.leg, index), &leg.text).await? {
            if let Some((name, text)) = names.beside.zip(leg.beside.as_deref()) {
                keep_result(&mut transaction, job, Document::part(name, index), text).await?;
            }
            if let Some(status) = leg.ended {
                count_run(&mut transaction, job, status).await?;
            }
            let course = Document::only(names.course);
            sqlx::query("delete from documents where job = $1 and name = $2 and part = $3")
                .bind(job.to_string())
                .bind(course.name)
                .bind(i64::from(course.part))
                .execute(&mut *transaction)
                .await?;
            if let Some(text) = &leg.course {
                insert_document(&mut transaction, job, course, text).await?;
            }
        }
        transaction.commit_job(job).await?;
        Ok(())
    }

    /// Number of documents called `name` that a job has, and the bytes of their texts.
    pub async fn parts(&self, job: JobId, name: &str) -> Result<(u32, u64), StoreError> {
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
