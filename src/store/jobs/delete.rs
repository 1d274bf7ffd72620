//! Deletion of jobs, and release of their disk space.

use chrono::{TimeDelta, Utc};
use sqlx::AnyConnection;

use super::job::JobId;
use super::row::{read_id, status_of};
use crate::store::dialect::{Dialect, Guarded};
use crate::store::error::StoreError;
use crate::store::handle::Store;
use crate::store::time::timestamp;

/// Number of speeds that one transaction deletes: others may write in between.
const SPEEDS_AT_ONCE: i64 = 64;

/// Number of database pages released at once.
const PAGES_AT_ONCE: u32 = 1024;

/// Outcome of deleting a job.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum JobDeletion {
    /// Deleted job, hidden from all listings; [`Store::purge`] releases its disk space.
    Deleted,
    /// Unknown job.
    Unknown,
    /// Unfinished job, which still wants work.
    Unfinished,
}

impl Store {
    /// Deletes a finished job with its results, on a full disk as well.
    pub async fn delete_job(&self, id: JobId) -> Result<JobDeletion, StoreError> {
        self.with_reserve(|| self.mark_deleted(id)).await
    }

    async fn mark_deleted(&self, id: JobId) -> Result<JobDeletion, StoreError> {
        let mut write = self.write_removal().await?;
        write.guard(Guarded::Job(id)).await?;
        let outcome = match status_of(&mut write, id).await? {
            None => JobDeletion::Unknown,
            Some(status) if !status.is_final() => JobDeletion::Unfinished,
            Some(_) => JobDeletion::Deleted,
        };
        if outcome != JobDeletion::Deleted {
            write.rollback().await?;
            return Ok(outcome);
        }
        sqlx::query("update jobs set deleted = 1 where id = $1")
            .bind(id.to_string())
            .execute(&mut *write)
            .await?;
        forget_answers(&mut write).await?;
        write.commit_job(id).await?;
        Ok(outcome)
    }

    /// Deletes the jobs that ended more than `days` days ago, on a full disk as well. Returns how many.
    pub async fn delete_older_jobs(&self, days: u32) -> Result<u64, StoreError> {
        self.with_reserve(|| self.mark_older_deleted(days)).await
    }

    async fn mark_older_deleted(&self, days: u32) -> Result<u64, StoreError> {
        let mut write = self.write_removal().await?;
        let deleted = sqlx::query("update jobs set deleted = 1 where deleted = 0 and finished_at < $1")
            .bind(timestamp(Utc::now() - TimeDelta::days(days.into())))
            .execute(&mut *write)
            .await?;
        forget_answers(&mut write).await?;
        write.commit_jobs().await?;
        Ok(deleted.rows_affected())
    }

    /// Removes the rows of deleted jobs, a few at a time, and releases their disk space. Continues after an interruption.
    pub async fn purge(&self) -> Result<(), StoreError> {
        self.with_reserve(|| self.remove_deleted()).await?;
        self.reserve.keep().await?;
        Ok(())
    }

    async fn remove_deleted(&self) -> Result<(), StoreError> {
        let deleted: Vec<String> =
            sqlx::query_scalar("select id from jobs where deleted = 1").fetch_all(&self.readers).await?;
        for id in &deleted {
            loop {
                let mut write = self.write_removal().await?;
                // Of two processes that remove the same rows, each would find that none are left.
                write.guard(Guarded::Job(read_id(id)?)).await?;
                let removed = sqlx::query(
                    "delete from speed_results where job = $1 and speed in
                         (select speed from speed_results where job = $1 limit $2)",
                )
                .bind(id)
                .bind(SPEEDS_AT_ONCE)
                .execute(&mut *write)
                .await?;
                let last = removed.rows_affected() == 0;
                if last {
                    sqlx::query("delete from jobs where id = $1").bind(id).execute(&mut *write).await?;
                }
                write.commit().await?;
                if last {
                    break;
                }
            }
        }
        // PostgreSQL reuses free space by itself.
        if deleted.is_empty() || self.dialect == Dialect::Postgres { Ok(()) } else { self.give_back().await }
    }

    /// Releases free pages to the file system, some at a time, and the grown part of the write-ahead log.
    async fn give_back(&self) -> Result<(), StoreError> {
        let mut before = i64::MAX;
        loop {
            let free: i64 = sqlx::query_scalar("pragma freelist_count").fetch_one(&self.readers).await?;
            // A database of an earlier version that could not be rebuilt keeps its free pages.
            if free == 0 || free >= before {
                break;
            }
            before = free;
            self.pragma(format!("pragma incremental_vacuum({PAGES_AT_ONCE})")).await?;
        }
        self.pragma("pragma wal_checkpoint(truncate)".to_owned()).await
    }

    /// Runs a writing statement that allows no transaction around it.
    async fn pragma(&self, statement: String) -> Result<(), StoreError> {
        let mut writer = self.writer.acquire().await?;
        if let Err(error) = sqlx::query(sqlx::AssertSqlSafe(statement)).fetch_all(&mut *writer).await {
            writer.close_on_drop();
            return Err(error.into());
        }
        Ok(())
    }
}

/// Frees the idempotency keys of deleted jobs: a repeated request must not get the old answer.
async fn forget_answers(connection: &mut AnyConnection) -> Result<(), StoreError> {
    sqlx::query(
        "delete from idempotency_keys where location in (select '/v1/jobs/' || id from jobs where deleted = 1)",
    )
    .execute(connection)
    .await?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::store::testing::stores;

    #[tokio::test]
    async fn a_deleted_job_gives_its_room_back() {
        let folder = tempfile::tempdir().unwrap();
        let store = Store::open(folder.path()).await.unwrap();
        let file = || folder.path().join("rubmap.sqlite").metadata().unwrap().len();
        let [kept, gone] = [JobId::new(), JobId::new()];
        for (id, status, finished) in
            [(kept, "running", None), (gone, "successful", Some("2026-01-01T00:00:00.000Z"))]
        {
            sqlx::query(
                "insert into jobs (id, kind, status, model, modes_per_speed, facts, request, speeds, created_at,
                     finished_at, updated_at)
                 values ($1, 'sweep', $2, 'm', 20, '{}', '{}', 300, 'a', $3, 'a')",
            )
            .bind(id.to_string())
            .bind(status)
            .bind(finished)
            .execute(&store.writer)
            .await
            .unwrap();
        }
        for speed in 0..300 {
            sqlx::query(
                "insert into speed_results (job, speed, status, point, spectra, created_at)
                 values ($1, $2, 'completed', '{}', zeroblob(10000), 'a')",
            )
            .bind(gone.to_string())
            .bind(speed)
            .execute(&store.writer)
            .await
            .unwrap();
        }
        store.give_back().await.unwrap();
        let full = file();
        assert!(full > 3_000_000, "{full}");
        assert_eq!(store.delete_job(kept).await.unwrap(), JobDeletion::Unfinished);
        assert_eq!(store.delete_job(JobId::new()).await.unwrap(), JobDeletion::Unknown);
        assert_eq!(store.delete_job(gone).await.unwrap(), JobDeletion::Deleted);
        assert!(store.job(gone).await.unwrap().is_none(), "nobody sees it any more");
        assert_eq!(store.delete_job(gone).await.unwrap(), JobDeletion::Unknown);
        store.purge().await.unwrap();
        assert!(file() < 500_000, "{} of {full} bytes", file());
        let left: i64 =
            sqlx::query_scalar("select count(*) from jobs").fetch_one(&store.readers).await.unwrap();
        assert_eq!(left, 1);
        store.purge().await.unwrap();
    }

    #[tokio::test]
    async fn jobs_are_deleted_by_their_age() {
        for store in stores().await {
            for (days, status) in [(0, "successful"), (2, "dismissed"), (9, "successful")] {
                sqlx::query(
                    "insert into jobs (id, kind, status, model, modes_per_speed, facts, request, speeds, created_at,
                         finished_at, updated_at)
                     values ($1, 'sweep', $2, 'm', 20, '{}', '{}', 1, 'a', $3, 'a')",
                )
                .bind(JobId::new().to_string())
                .bind(status)
                .bind(timestamp(Utc::now() - TimeDelta::days(days)))
                .execute(&store.writer)
                .await
                .unwrap();
            }
            assert_eq!(store.delete_older_jobs(10).await.unwrap(), 0);
            assert_eq!(store.delete_older_jobs(1).await.unwrap(), 2);
            assert_eq!(store.delete_older_jobs(1).await.unwrap(), 0);
        }
    }
}
