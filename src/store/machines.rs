//! Processes that compute for all that share a database.

use super::error::StoreError;
use super::shared_queue::SharedQueue;
use crate::analysis::result::Machine;
use crate::analysis::run::Calibration;
use crate::store::sql::of;

/// Seconds without a sign of life after which a process counts as gone.
const SILENCE: f64 = 60.0;

/// A process that computes.
#[derive(Debug, Clone, PartialEq)]
pub struct WorkerProcess {
    /// The machine it runs on.
    pub machine: Machine,
    /// What steps cost there.
    pub costs: Calibration,
    /// Its threads.
    pub threads: u32,
}

impl SharedQueue {
    /// Says that a process computes, or still does.
    pub async fn announce(&self, process: &str, worker: &WorkerProcess) -> Result<(), StoreError> {
        sqlx::query(
            "insert into machines (process, machine, costs, threads, seen) values ($1, $2, $3, $4, now())
             on conflict (process) do update set seen = excluded.seen",
        )
        .bind(process)
        .bind(serde_json::to_string(&worker.machine)?)
        .bind(serde_json::to_string(&worker.costs)?)
        .bind(i64::from(worker.threads))
        .execute(self.pool())
        .await?;
        Ok(())
    }

    /// Processes that compute, those with most threads first. Forgets the others.
    pub async fn worker_processes(&self) -> Result<Vec<WorkerProcess>, StoreError> {
        sqlx::query("delete from machines where seen < now() - make_interval(secs => $1)")
            .bind(SILENCE)
            .execute(self.pool())
            .await?;
        let rows: Vec<(String, String, i64)> =
            sqlx::query_as("select machine, costs, threads from machines order by threads desc, process")
                .fetch_all(self.pool())
                .await?;
        rows.into_iter()
            .map(|(machine, costs, threads)| {
                Ok(WorkerProcess {
                    machine: serde_json::from_str(&machine)?,
                    costs: serde_json::from_str(&costs)?,
                    threads: of("machines.threads", threads)?,
                })
            })
            .collect()
    }

    /// Says of unfinished jobs of one kind of processor that they wait, if nobody is there who may go on with them.
    pub async fn tell_who_waits(&self) -> Result<(), StoreError> {
        sqlx::query(
            "update jobs set phase = 'waiting for a worker with ' || vectors || ' vectors, on which it was begun'
             where status in ('accepted', 'running') and one_kind = 1 and phase not like 'waiting for a worker with %'
                 and not exists (
                     select 1 from machines where seen > now() - make_interval(secs => $1)
                         and machine::jsonb ->> 'vectors' = jobs.vectors
                 )
                 and vectors is not null",
        )
        .bind(SILENCE)
        .execute(self.pool())
        .await?;
        Ok(())
    }

    /// Says that a process has ended.
    pub async fn leave(&self, process: &str) -> Result<(), StoreError> {
        sqlx::query("delete from machines where process = $1").bind(process).execute(self.pool()).await?;
        Ok(())
    }
}
