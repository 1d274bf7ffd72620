//! The queue's tables, which belong to `apalis`, in memory.
//!
//! On one machine the queue remembers nothing that [`super::jobs`] and [`super::results`] do not know better: it is filled
//! from there at every start, and no full disk, lock or lack of descriptors can stop it. Handlers must not care how often or
//! where they are called; that is what lets the same ones run on a queue that other machines share.

use std::time::Duration;

use apalis::prelude::{TaskBuilder, TaskId};
use apalis_sqlite::{Config, SqliteStorage, queries};
use serde::{Deserialize, Serialize};
use sqlx::sqlite::{SqliteConnectOptions, SqlitePool, SqlitePoolOptions};

use super::error::StoreError;
use super::jobs::job::JobId;

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

/// The queue.
#[derive(Debug, Clone)]
pub struct Queue {
    pool: SqlitePool,
}

impl Queue {
    /// Makes an empty queue.
    pub async fn create() -> Result<Self, StoreError> {
        let options = SqliteConnectOptions::new().in_memory(true);
        // One connection, which is the database, and for ever.
        let pool = SqlitePoolOptions::new()
            .max_connections(1)
            .min_connections(1)
            .idle_timeout(None::<Duration>)
            .max_lifetime(None::<Duration>)
            .connect_with(options)
            .await?;
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

    /// Queues a speed of a job, to run after all queued before.
    pub async fn push_speed(&self, task: RunSpeed) -> Result<(), StoreError> {
        // Tasks run in the order of these ids.
        let id = ulid::Ulid::from(uuid::Uuid::now_v7().as_u128());
        let task =
            TaskBuilder::new(serde_json::to_vec(&task)?).task_id(TaskId::from_string(id.to_string())).build();
        let mut connection = self.pool.acquire().await?;
        // Those that have ended are kept by nobody else's wish.
        sqlx::query("delete from Jobs where status in ('Done', 'Failed', 'Killed')")
            .execute(&mut *connection)
            .await?;
        queries::push_tasks(&mut *connection, SPEEDS, &[task]).await?;
        Ok(())
    }

    /// Ends it: who still asks for tasks is refused.
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
