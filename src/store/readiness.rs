//! Readiness of the store: whether written data can be read, free disk space, and waiting work.

use sqlx::AssertSqlSafe;

use super::dialect::Dialect;
use super::error::StoreError;
use super::handle::Store;
use super::reserve::free_bytes;
use super::sql::kinds_of;
use crate::analysis::kinds::kind::Units;

/// Backlog of work that is waiting.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Backlog {
    /// Number of jobs that wait for their turn.
    pub jobs_accepted: u64,
    /// Number of jobs that are running.
    pub jobs_running: u64,
    /// Number of unfinished speeds of the accepted and running sweeps and campaigns.
    pub speeds_unfinished: u64,
}

impl Store {
    /// Writes a row as every other is written, and reads it back as every other is read: through another connection, which sees only
    /// committed data.
    pub async fn probe(&self) -> Result<(), StoreError> {
        let written = uuid::Uuid::now_v7().to_string();
        let mut write = self.write().await?;
        sqlx::query("insert into readiness (id, mark) values (1, $1) on conflict (id) do update set mark = excluded.mark")
            .bind(&written)
            .execute(&mut *write)
            .await?;
        write.commit().await?;
        let read: Option<String> = sqlx::query_scalar("select mark from readiness where id = 1")
            .fetch_optional(&self.readers)
            .await?;
        // On a server, another process may have written its own mark meanwhile.
        let is_seen = read.is_some_and(|read| read == written || self.dialect == Dialect::Postgres);
        if is_seen { Ok(()) } else { Err(StoreError::Unseen) }
    }

    /// Free space on the disk of the data folder for this process, bytes.
    pub fn free_bytes(&self) -> Result<u64, StoreError> {
        Ok(free_bytes(&self.folder)?)
    }

    /// Counts the work that is waiting.
    pub async fn backlog(&self) -> Result<Backlog, StoreError> {
        // The condition is worded as in the index of these jobs.
        let count = format!(
            "select count(*) filter (where status = 'accepted'), count(*) filter (where status = 'running'),
                 cast(coalesce(sum(speeds - finished) filter (where kind in {}), 0) as bigint)
             from jobs where status in ('accepted', 'running', 'paused') and status <> 'paused'",
            kinds_of(Units::Speeds)
        );
        let (jobs_accepted, jobs_running, speeds_unfinished) =
            sqlx::query_as::<_, (i64, i64, i64)>(AssertSqlSafe(count)).fetch_one(&self.readers).await?;
        // Only counts are read.
        Ok(Backlog {
            jobs_accepted: jobs_accepted.cast_unsigned(),
            jobs_running: jobs_running.cast_unsigned(),
            speeds_unfinished: speeds_unfinished.cast_unsigned(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[tokio::test]
    async fn a_connection_that_is_wrong_about_its_transaction_fails_once() {
        let folder = tempfile::tempdir().unwrap();
        let store = Store::open(folder.path()).await.unwrap();
        store.probe().await.unwrap();
        // State after a failed commit: a connection within a transaction that nobody ends.
        sqlx::query("begin").execute(&store.writer).await.unwrap();
        assert!(store.probe().await.is_err());
        store.probe().await.unwrap();
    }

    #[tokio::test]
    async fn there_is_room_in_a_folder_and_none_in_none() {
        let folder = tempfile::tempdir().unwrap();
        let store = Store::open(folder.path()).await.unwrap();
        assert!(store.free_bytes().unwrap() > 0);
        store.close().await;
        drop(folder);
        assert!(store.free_bytes().is_err());
    }
}
