//! Queue of one machine: the tables of `apalis`, in memory.
//!
//! On one machine the queue holds nothing that [`super::jobs`] and [`super::results`] do not hold better: it is filled from there at every
//! start, and no full disk, lock or lack of descriptors can stop it. Handlers must not depend on how often or where they are called; so the
//! same handlers can run on a queue that other machines share.

use std::sync::{Arc, Mutex};
use std::time::Duration;

use apalis::prelude::{TaskBuilder, TaskId};
use apalis_sqlite::{Config, SqliteStorage, queries};
use serde::{Deserialize, Serialize};
use sqlx::ConnectOptions;
use sqlx::sqlite::{SqliteConnectOptions, SqliteConnection, SqlitePool, SqlitePoolOptions};

use super::error::StoreError;
use super::jobs::job::JobId;

/// Task that brings a job to the point where its speeds can be computed (or, for a modal analysis, to its end).
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub struct PrepareJob {
    /// Id of the job.
    pub job: JobId,
}

/// Task that computes one speed of one job: the unit of work.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub struct RunSpeed {
    /// Id of the job.
    pub job: JobId,
    /// Index of the speed in its request.
    pub speed: u32,
}

const PREPARE: &str = "prepare";
const SPEEDS: &str = "speeds";

/// Queue of tasks in memory.
#[derive(Debug, Clone)]
pub struct Queue {
    pool: SqlitePool,
    /// Connection that keeps the tables in memory while the connection of the pool is replaced, as happens when its user is cancelled.
    _anchor: Arc<Mutex<SqliteConnection>>,
}

impl Queue {
    /// Creates an empty queue.
    pub async fn create() -> Result<Self, StoreError> {
        // A unique name gives each call a database of its own, which all its connections share.
        let options: SqliteConnectOptions = "sqlite::memory:".parse()?;
        let anchor = options.connect().await?;
        let pool = SqlitePoolOptions::new()
            .max_connections(1)
            .min_connections(1)
            .idle_timeout(None::<Duration>)
            .max_lifetime(None::<Duration>)
            .connect_with(options)
            .await?;
        SqliteStorage::<()>::migrations().run(&pool).await?;
        Ok(Self { pool, _anchor: Arc::new(Mutex::new(anchor)) })
    }

    /// Storage of tasks that prepare jobs.
    pub fn preparations(&self) -> SqliteStorage<PrepareJob> {
        SqliteStorage::new(&self.pool).with_config(config(PREPARE))
    }

    /// Storage of tasks that compute speeds.
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
        // Nobody else needs the finished tasks.
        sqlx::query("delete from Jobs where status in ('Done', 'Failed', 'Killed')")
            .execute(&mut *connection)
            .await?;
        queries::push_tasks(&mut *connection, SPEEDS, &[task]).await?;
        Ok(())
    }

    /// Closes the queue: workers that still ask for tasks are refused.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[tokio::test]
    async fn a_lost_connection_loses_no_tasks_and_queues_are_apart() {
        let (queue, other) = (Queue::create().await.unwrap(), Queue::create().await.unwrap());
        queue.push_preparation(JobId::new()).await.unwrap();
        let count = async |queue: &Queue| -> i64 {
            sqlx::query_scalar("select count(*) from Jobs").fetch_one(&queue.pool).await.unwrap()
        };
        queue.pool.acquire().await.unwrap().close().await.unwrap();
        assert_eq!((count(&queue).await, count(&other).await), (1, 0));
    }
}
