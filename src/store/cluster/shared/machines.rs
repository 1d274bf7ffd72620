//! Worker processes that compute for all processes sharing a database.

use std::sync::Arc;

use super::queue::SharedQueue;
use crate::analysis::kinds::plan::Capacity;
use crate::analysis::result::Machine;
use crate::analysis::run::Calibration;
use crate::store::error::StoreError;
use crate::store::sql::of;

/// Time in seconds without a sign of life after which a worker process counts as gone.
const SILENCE: f64 = 60.0;

/// Worker process.
#[derive(Debug, Clone, PartialEq)]
pub struct WorkerProcess {
    /// Machine that the process runs on.
    pub machine: Machine,
    /// Costs of time steps on this machine.
    pub costs: Calibration,
    /// Number of threads of the process.
    pub threads: u32,
}

impl SharedQueue {
    /// Announces that a worker process computes, or still does.
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

    /// Capacity of all machines that share the work, each taken as fast as the one with most threads; none where nobody computes.
    pub async fn capacity(&self) -> Result<Option<Capacity>, StoreError> {
        let processes = self.worker_processes().await?;
        let threads = processes.iter().map(|process| process.threads as usize).sum();
        let first = processes.into_iter().next();
        Ok(first.map(|WorkerProcess { machine, costs, .. }| Capacity {
            machine,
            costs: Arc::new(costs),
            threads,
        }))
    }

    /// Lists the worker processes that compute, most threads first. Forgets the others.
    async fn worker_processes(&self) -> Result<Vec<WorkerProcess>, StoreError> {
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

    /// Sets the phase of unfinished jobs bound to one kind of processor to waiting, if no worker of that kind is there.
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

    /// Reports that a worker process has ended.
    pub async fn leave(&self, process: &str) -> Result<(), StoreError> {
        sqlx::query("delete from machines where process = $1").bind(process).execute(self.pool()).await?;
        Ok(())
    }
}
