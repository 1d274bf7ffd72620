//! Tasks in PostgreSQL, from which workers on any number of machines take them: the tables of `apalis-postgres`.
//!
//! The tables of jobs and results remain the reference, as on one machine. A lost task is made again ([`SharedQueue::jobs_without_tasks`]),
//! and a task that runs twice does no harm.

use std::collections::HashSet;
use std::io::ErrorKind;
use std::time::Duration;

use apalis::prelude::TaskBuilder;
use apalis_postgres::{Config, PgTask, PostgresStorage, queries};
use serde::Serialize;
use sqlx::migrate::Migrator;
use sqlx::postgres::{PgConnection, PgListener, PgPoolOptions};
use sqlx::{AssertSqlSafe, Executor, PgPool};

use super::claims::Claim;
use crate::analysis::run::REVISION;
use crate::store::error::StoreError;
use crate::store::jobs::job::JobId;
use crate::store::session;
use crate::store::sqlite::PATIENCE;
use crate::store::tasks::{PrepareJob, RunSpeed};

/// Time between two signs of life of a worker; `MISSED`: number that may be missing before others get its tasks. Set here, because the
/// defaults of the crate differ from its documentation.
const HEARTBEAT: Duration = Duration::from_secs(5);
const MISSED: usize = 6;

/// Number of connections of one process: for signs of life and results of two queues, and one that listens.
const CONNECTIONS: u32 = 4;

/// Number of times that a task may be started; crashes of a job are counted in the table of jobs.
const ATTEMPTS: usize = 1_000_000;

/// Priority of the task whose turn comes first; larger goes before smaller.
const FIRST: i32 = 1_000_000_000;

/// Time without news after which the server is asked whether it is there.
const SILENCE: Duration = Duration::from_secs(30);

/// Setting for the query that takes one task: the server expects a tenth of a queue, and would read all of it for a join.
pub const TAKE_ONE: &str = "set enable_hashjoin = off; set enable_mergejoin = off";

/// Prefix of the names of queues that prepare jobs; `SPEEDS`: of those that compute speeds.
const PREPARE: &str = "prepare";
const SPEEDS: &str = "speeds";

/// Channel on which workers are told of new tasks.
const TASKS: &str = "rubmap_tasks";

/// Channel of the ids of changed jobs, which the tables notify.
const JOBS: &str = "rubmap_jobs";

/// Notifications that a process receives from others.
#[derive(Debug)]
pub struct News(PgListener);

/// Notification from another process.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Told {
    /// New tasks.
    Tasks,
    /// Job that has changed.
    Job(JobId),
}

impl News {
    /// Waits for the next notification; `None` where the connection was lost.
    pub async fn next(&mut self) -> Result<Option<Told>, StoreError> {
        loop {
            let Ok(said) = tokio::time::timeout(SILENCE, self.0.try_recv()).await else {
                self.expect_answer().await?;
                continue;
            };
            let Some(said) = said? else { return Ok(None) };
            if said.channel() == TASKS {
                return Ok(Some(Told::Tasks));
            }
            if let Some(job) = JobId::parse(said.payload()) {
                return Ok(Some(Told::Job(job)));
            }
        }
    }

    /// Checks that the server answers: a connection that only listens does not notice that the other end is gone.
    async fn expect_answer(&mut self) -> Result<(), StoreError> {
        let answer = tokio::time::timeout(PATIENCE, sqlx::query("select 1").execute(&mut self.0)).await;
        answer.map_err(|_| sqlx::Error::Io(ErrorKind::TimedOut.into()))??;
        Ok(())
    }
}

/// Queue of the tasks of all machines.
#[derive(Debug, Clone)]
pub struct SharedQueue {
    pool: PgPool,
}

impl SharedQueue {
    /// Opens the queue of the database at `url`, whose tables are up to date.
    pub(in crate::store) async fn open(url: &str) -> Result<Option<Self>, StoreError> {
        let pool = PgPoolOptions::new()
            .max_connections(CONNECTIONS)
            .acquire_timeout(2 * PATIENCE)
            .after_connect(|connection, _| {
                let settings = format!("{}; {TAKE_ONE}", session::settings());
                Box::pin(async move { connection.execute(AssertSqlSafe(settings)).await.map(drop) })
            })
            .connect(url)
            .await?;
        Ok(Some(Self { pool }))
    }

    pub(in crate::store) fn pool(&self) -> &PgPool {
        &self.pool
    }

    pub(in crate::store) async fn close(&self) {
        self.pool.close().await;
    }

    /// Storage of tasks that prepare jobs: those for any machine, or for processors with these `vectors`.
    pub fn preparations(&self, vectors: Option<&str>) -> PostgresStorage<PrepareJob> {
        PostgresStorage::new(&self.pool).with_config(config(&queue(PREPARE, vectors)))
    }

    /// Storage of tasks that compute speeds: those for any machine, or for processors with these `vectors`.
    pub fn speeds(&self, vectors: Option<&str>) -> PostgresStorage<RunSpeed> {
        PostgresStorage::new(&self.pool).with_config(config(&queue(SPEEDS, vectors)))
    }

    /// Listens for new tasks and changed jobs, from now on.
    pub async fn listen(&self) -> Result<News, StoreError> {
        let mut listener = PgListener::connect_with(&self.pool).await?;
        listener.listen_all([TASKS, JOBS]).await?;
        Ok(News(listener))
    }

    /// Queues the preparation of a job, unless it is queued already.
    pub async fn push_preparation(&self, job: JobId, vectors: Option<&str>) -> Result<(), StoreError> {
        self.push(&queue(PREPARE, vectors), [(job.to_string(), PrepareJob { job })]).await
    }

    /// Queues speeds of a job, except those that are queued already.
    pub async fn push_speeds(
        &self,
        job: JobId,
        vectors: Option<&str>,
        speed: &[u32],
    ) -> Result<(), StoreError> {
        let tasks = speed.iter().map(|&speed| (format!("{job}:{speed:010}"), RunSpeed { job, speed }));
        self.push(&queue(SPEEDS, vectors), tasks).await
    }

    async fn push<T: Serialize>(
        &self,
        queue: &str,
        tasks: impl IntoIterator<Item = (String, T)>,
    ) -> Result<(), StoreError> {
        let (keys, tasks): (Vec<String>, Vec<T>) = tasks.into_iter().unzip();
        let mut transaction = self.pool.begin().await?;
        // One push at a time: two that push the same would not see each other's tasks.
        sqlx::query("select pg_advisory_xact_lock(hashtext($1))")
            .bind(queue)
            .execute(&mut *transaction)
            .await?;
        // A finished task may be queued again.
        sqlx::query(
            "delete from apalis.jobs
             where job_type = $1 and idempotency_key = any($2) and status in ('Done', 'Failed', 'Killed')",
        )
        .bind(queue)
        .bind(&keys)
        .execute(&mut *transaction)
        .await?;
        let known: Vec<String> = sqlx::query_scalar(
            "select idempotency_key from apalis.jobs where job_type = $1 and idempotency_key = any($2)",
        )
        .bind(queue)
        .bind(&keys)
        .fetch_all(&mut *transaction)
        .await?;
        let known: HashSet<String> = known.into_iter().collect();
        let new = keys.into_iter().zip(tasks).filter(|(key, _)| !known.contains(key));
        let new = new.map(|(key, task)| {
            let task = TaskBuilder::new(serde_json::to_vec(&task)?)
                .idempotency_key(key)
                .max_attempts(ATTEMPTS)
                // The task may run at once by any clock: those of machines may differ.
                .run_at_timestamp(1)
                .build();
            Ok(task)
        });
        let new: Vec<PgTask> = new.collect::<Result<_, serde_json::Error>>()?;
        if !new.is_empty() {
            queries::push_tasks(&mut *transaction, queue, new).await?;
            take_turns(&mut transaction, queue).await?;
            sqlx::query("select pg_notify($1, '')").bind(TASKS).execute(&mut *transaction).await?;
        }
        transaction.commit().await?;
        Ok(())
    }

    /// Drops the waiting tasks of a job.
    pub async fn withdraw(&self, job: JobId) -> Result<(), StoreError> {
        sqlx::query(
            "delete from apalis.jobs where status = 'Pending' and split_part(idempotency_key, ':', 1) = $1",
        )
        .bind(job.to_string())
        .execute(&self.pool)
        .await?;
        Ok(())
    }

    /// Releases the tasks of workers that have ended to others.
    pub async fn give_back(&self, workers: &[String]) -> Result<(), StoreError> {
        sqlx::query(
            "update apalis.jobs set status = 'Pending', lock_by = null, lock_at = null
             where lock_by = any($1) and status in ('Queued', 'Running')",
        )
        .bind(workers)
        .execute(&self.pool)
        .await?;
        self.tell_of_tasks().await
    }

    /// Lists unfinished jobs without a task, with their owners: the process that should have queued one died before it did.
    pub async fn jobs_without_tasks(&self) -> Result<Vec<(String, String)>, StoreError> {
        Ok(sqlx::query_as(
            "with busy as (
                 select distinct split_part(idempotency_key, ':', 1) as job from apalis.jobs
                 where status in ('Pending', 'Queued', 'Running') and split_part(job_type, '-', 2) = $1::bigint::text
             )
             select id, owner from jobs
             where status in ('accepted', 'running') and revision = $1 and id not in (select job from busy)
             order by id",
        )
        .bind(i64::from(REVISION))
        .fetch_all(&self.pool)
        .await?)
    }

    /// Claims the task `name` for this process, unless another process has it.
    pub async fn claim(&self, name: &str) -> Result<Option<Claim>, StoreError> {
        Claim::of(&self.pool, name).await
    }

    /// Whether there are workers of another revision of the numerics, which continue the jobs that they began.
    pub async fn has_other_revisions(&self) -> Result<bool, StoreError> {
        let others = "select exists (select 1 from apalis.workers
                          where last_seen > now() - interval '1 minute' and split_part(worker_type, '-', 2) <> $1)";
        Ok(sqlx::query_scalar(others).bind(REVISION.to_string()).fetch_one(&self.pool).await?)
    }

    /// Removes finished tasks, tasks of jobs that another revision of the numerics computes by now, and workers that have been away for a
    /// day.
    pub async fn tidy(&self) -> Result<(), StoreError> {
        sqlx::query(
            "delete from apalis.jobs as task using jobs
             where jobs.id = split_part(task.idempotency_key, ':', 1)
                 and split_part(task.job_type, '-', 2) <> jobs.revision::text",
        )
        .execute(&self.pool)
        .await?;
        sqlx::query("delete from apalis.jobs where status in ('Done', 'Failed', 'Killed')")
            .execute(&self.pool)
            .await?;
        sqlx::query(
            "delete from apalis.workers as worker where last_seen < now() - interval '1 day'
                 and not exists (select 1 from apalis.jobs where lock_by = worker.id)",
        )
        .execute(&self.pool)
        .await?;
        Ok(())
    }

    async fn tell_of_tasks(&self) -> Result<(), StoreError> {
        sqlx::query("select pg_notify($1, '')").bind(TASKS).execute(&self.pool).await?;
        Ok(())
    }
}

/// Orders the waiting tasks: owners take turns, and so do the jobs of each owner.
async fn take_turns(connection: &mut PgConnection, queue: &str) -> Result<(), StoreError> {
    connection.execute("set local enable_hashjoin = on").await?;
    sqlx::query(
        "with nth as (
             select id, split_part(idempotency_key, ':', 1) as job,
                 row_number() over (partition by split_part(idempotency_key, ':', 1) order by idempotency_key) as place
             from apalis.jobs where status = 'Pending' and job_type = $1
         ), turn as (
             select nth.id, row_number() over (partition by owner order by nth.place, jobs.id) as turn
             from nth join jobs on jobs.id = nth.job
         )
         update apalis.jobs as task set priority = $2 - turn.turn
         from turn where task.id = turn.id and task.priority <> $2 - turn.turn",
    )
    .bind(queue)
    .bind(FIRST)
    .execute(connection)
    .await?;
    Ok(())
}

/// Migrations that make the tables of the queue, in order.
pub(in crate::store) fn migrations() -> Option<Migrator> {
    Some(PostgresStorage::<()>::migrations())
}

/// Name of a queue. A worker takes tasks of its own revision of the numerics: all speeds of a job belong to one revision. Some queues
/// belong to one kind of vectors as well.
fn queue(tasks: &str, vectors: Option<&str>) -> String {
    match vectors {
        Some(vectors) => format!("{tasks}-{REVISION}-{vectors}"),
        None => format!("{tasks}-{REVISION}"),
    }
}

fn config(queue: &str) -> Config {
    Config::default()
        .queue(queue)
        // A worker that fetches ten tasks of a minute each keeps nine from the others.
        .batch_size(1)
        .heartbeat_interval(HEARTBEAT)
        .missed_heartbeats(MISSED)
        // A fetched task counts as taken already; locking it again would be one more write per speed.
        .lock_tasks(false)
}
