//! The queue's tables, which belong to `apalis`, in a file of their own.
//!
//! A file of their own because two migrators on one file trip over each other's `_sqlx_migrations`. On one machine the
//! queue remembers nothing that [`super::jobs`] and [`super::results`] do not know better, so its file is made afresh at
//! every start and filled from there: interrupted work is queued again at once, not after the minute that `apalis`
//! needs to notice a dead worker, and nothing piles up. Handlers must not care how often or where they are called; that
//! is what lets the same ones run on a queue that other machines share.

use std::path::Path;
use std::time::Duration;

use apalis::prelude::{TaskBuilder, TaskId};
use apalis_sqlite::{Config, SqliteStorage, queries};
use serde::{Deserialize, Serialize};
use sqlx::sqlite::{
    SqliteConnectOptions, SqliteJournalMode, SqlitePool, SqlitePoolOptions, SqliteSynchronous,
};

use super::StoreError;
use super::jobs::JobId;

/// Bring a job to the point where its speeds can be computed (or, for a modal analysis, to its end).
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub struct PrepareJob {
    /// The job.
    pub job: JobId,
}

/// Compute one speed of one job: the unit of work.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub struct RunSpeed {
    /// The job.
    pub job: JobId,
    /// Index of the speed in its request.
    pub speed: u32,
}

const PREPARE: &str = "prepare";
const SPEEDS: &str = "speeds";

/// The queue's file.
#[derive(Debug, Clone)]
pub struct QueueFile {
    pool: SqlitePool,
}

impl QueueFile {
    /// Makes an empty queue in `folder`. Only the one process that owns the folder may call this.
    pub async fn create(folder: &Path) -> Result<Self, StoreError> {
        for suffix in ["", "-wal", "-shm"] {
            match std::fs::remove_file(folder.join(format!("queue.sqlite{suffix}"))) {
                Err(error) if error.kind() != std::io::ErrorKind::NotFound => return Err(error.into()),
                _ => {}
            }
        }
        let options = SqliteConnectOptions::new()
            .filename(folder.join("queue.sqlite"))
            .create_if_missing(true)
            .journal_mode(SqliteJournalMode::Wal)
            // Lost with the process anyway.
            .synchronous(SqliteSynchronous::Off)
            .busy_timeout(Duration::from_secs(10));
        // One connection: every statement of a queue is a write.
        let pool = SqlitePoolOptions::new().max_connections(1).connect_with(options).await?;
        SqliteStorage::<()>::migrations().run(&pool).await?;
        Ok(Self { pool })
    }

    /// Tasks that prepare jobs.
    pub fn preparations(&self) -> SqliteStorage<PrepareJob> {
        SqliteStorage::new(&self.pool).with_config(config(PREPARE))
    }

    /// Tasks that compute speeds.
    pub fn speeds(&self) -> SqliteStorage<RunSpeed> {
        SqliteStorage::new(&self.pool).with_config(config(SPEEDS))
    }

    /// Queues the preparation of a job.
    pub async fn push_preparation(&self, job: JobId) -> Result<(), StoreError> {
        let task = TaskBuilder::new(serde_json::to_vec(&PrepareJob { job })?).build();
        let mut connection = self.pool.acquire().await?;
        queries::push_tasks(&mut *connection, PREPARE, &[task]).await?;
        Ok(())
    }

    /// Queues speeds of a job, to run in the order given and after all queued before.
    pub async fn push_speeds(&self, job: JobId, speeds: &[u32]) -> Result<(), StoreError> {
        let tasks = speeds
            .iter()
            .map(|&speed| {
                let args = serde_json::to_vec(&RunSpeed { job, speed })?;
                // Tasks run in the order of these ids. The key keeps a repeated preparation from queueing twice, and
                // finds the tasks of a job again.
                let id = ulid::Ulid::from(uuid::Uuid::now_v7().as_u128());
                let key = format!("{job}/{speed}");
                Ok(TaskBuilder::new(args)
                    .task_id(TaskId::from_string(id.to_string()))
                    .idempotency_key(key)
                    .build())
            })
            .collect::<Result<Vec<_>, serde_json::Error>>()?;
        let mut transaction = self.pool.begin().await?;
        queries::push_tasks(&mut *transaction, SPEEDS, &tasks).await?;
        transaction.commit().await?;
        Ok(())
    }

    /// Takes the speeds of a job that no worker has begun out of the queue.
    pub async fn withdraw_speeds(&self, job: JobId) -> Result<(), StoreError> {
        sqlx::query(
            "delete from Jobs where job_type = ?1 and status = 'Pending'
             and idempotency_key >= ?2 || '/' and idempotency_key < ?2 || '0'",
        )
        .bind(SPEEDS)
        .bind(job.to_string())
        .execute(&self.pool)
        .await?;
        Ok(())
    }

    /// Closes the file.
    pub async fn close(&self) {
        self.pool.close().await;
    }
}

fn config(queue: &str) -> Config {
    Config::default()
        .queue(queue)
        // A worker that fetches ten tasks of a minute each keeps nine from the others.
        .batch_size(1)
        // A fetched task counts as taken already; locking it again would be one more write per speed.
        .lock_tasks(false)
}
