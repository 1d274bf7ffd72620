//! Workers that take tasks as their turn comes, from start to stop.

use std::hash::Hash;
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::Duration;

use tokio::task::JoinHandle;
use tokio::time::MissedTickBehavior;
use tokio_util::sync::CancellationToken;
use tokio_util::task::TaskTracker;

use super::cluster;
use super::computing::{MOST_CRASHES, pause};
use super::engine::Engine;
use super::error;
use super::handle::Jobs;
use super::perform::{prepare_job, run_speed};
use super::progress::PendingReports;
use super::tasks::{Line, OwnTasks, Tasks};
use crate::import::Importer;
use crate::memory::Memory;
use crate::package;
use crate::pool::CpuPool;
use crate::store::jobs::{JobId, Unfinished};
use crate::store::limits::Limits;
use crate::store::{Store, StoreError};

/// Time that tasks may take to notice that the service stops: those that compute look many times a second.
const LAST_TASKS: Duration = Duration::from_secs(1);

/// Time between two writes of a job's progress. Each is a flush of the disk, and nobody looks more often.
const BETWEEN_PROGRESS: Duration = Duration::from_secs(1);

/// Time between two looks for jobs that have been kept long enough, and for what a full disk has kept from being cleaned up.
const BETWEEN_CLEANINGS: Duration = Duration::from_secs(60);

/// Settings of the runner.
#[derive(Debug, Clone)]
pub struct Settings {
    /// Number of threads that compute; 0 where other processes of a shared database do.
    pub workers: usize,
    /// Memory in bytes that computations, uploads and large downloads may take together; `None` for no limit.
    pub memory_bytes: Option<u64>,
    /// Days after which finished jobs are deleted; `None` keeps them.
    pub keep_days: Option<u32>,
    /// Limits on what one owner may have.
    pub limits: Limits,
    /// Largest upload, in bytes as sent.
    pub upload_bytes: u64,
    /// Limits while an uploaded package is read.
    pub package_limits: package::Limits,
}

/// Runner: the running workers.
#[derive(Debug)]
pub struct Runner {
    engine: Arc<Engine>,
    stop: CancellationToken,
    workers: Vec<JoinHandle<()>>,
    helpers: Vec<JoinHandle<()>>,
}

impl Runner {
    /// Starts the workers; on a data folder of their own with all unfinished jobs of the store. Only one runner may run on a data folder.
    pub async fn start(store: Store, settings: Settings) -> Result<Self, StoreError> {
        let threads = settings.workers.max(1);
        let pool = |name, size| CpuPool::start(name, size, threads);
        let memory = Arc::new(Memory::new(settings.memory_bytes));
        let (own, shared) = (pool("import", threads)?, Arc::clone(&memory));
        let importer =
            Importer::new(store.clone(), own, shared, settings.upload_bytes, settings.package_limits);
        let tasks = Tasks::of(&store, threads);
        let engine = Engine::new(
            store.clone(),
            tasks,
            pool("compute", threads)?,
            pool("plan", 1)?,
            Arc::new(importer),
            memory,
            settings.limits,
        );
        if let Err(error) = store.count_crashes().await {
            // Counted at the next start.
            tracing::warn!(%error, "could not count what the last service ended under");
        }
        let mut helpers = vec![
            tokio::spawn(record_progress(store.clone(), Arc::clone(&engine.reports))),
            tokio::spawn(keep_house(Arc::clone(&engine), settings.keep_days)),
        ];
        let stop = CancellationToken::new();
        let (workers, others) = match &engine.tasks {
            Tasks::Own(_) => {
                store.restart_outdated().await?;
                resume(&engine).await?;
                let workers = vec![
                    begin(&engine, &stop, |tasks| &tasks.preparations, prepare_job),
                    begin(&engine, &stop, |tasks| &tasks.speeds, run_speed),
                ];
                (workers, Vec::new())
            }
            Tasks::Shared(tasks) => cluster::workers::start(tasks, &engine, settings.workers, &stop),
        };
        helpers.extend(others);
        Ok(Self { engine, stop, workers, helpers })
    }

    /// Importer of model packages.
    pub fn importer(&self) -> Arc<Importer> {
        Arc::clone(&self.engine.importer)
    }

    /// Handle for `http`.
    pub fn jobs(&self) -> Jobs {
        Jobs::new(Arc::clone(&self.engine))
    }

    /// Ends running computations without finishing their jobs, which the next start resumes.
    pub async fn stop(self) {
        self.stop.cancel();
        // Tasks are given back before they end, which would be taken for having done what they had.
        self.engine.tasks.give_back().await;
        self.engine.stopping.store(true, Ordering::Relaxed);
        let mut workers = self.workers;
        let ended = async {
            for worker in &mut workers {
                if let Err(error) = worker.await {
                    tracing::error!(%error, "a worker ended badly");
                }
            }
        };
        if tokio::time::timeout(LAST_TASKS, ended).await.is_err() {
            // The workers still wait for something; what they have finished is stored.
            workers.iter().for_each(JoinHandle::abort);
        }
        self.engine.store.stop_marking();
        self.helpers.iter().for_each(JoinHandle::abort);
        self.engine.tasks.give_back().await;
    }
}

/// Prepares all unfinished jobs: at once, or later those under which the service died again and again.
async fn resume(engine: &Arc<Engine>) -> Result<(), StoreError> {
    for Unfinished { id, owner, crashes } in engine.store.unfinished_jobs().await? {
        if crashes >= MOST_CRASHES && engine.fail(id, &error::crashed(crashes)).await.is_ok() {
            continue;
        }
        tracing::info!(job.id = %id, crashes, "resuming");
        engine.computing.suspect(id, crashes);
        let pause = pause(crashes);
        if pause.is_zero() {
            engine.tasks.prepare(&owner, id);
        } else {
            let engine = Arc::clone(engine);
            tokio::spawn(async move {
                tokio::time::sleep(pause).await;
                engine.tasks.prepare(&owner, id);
            });
        }
    }
    Ok(())
}

/// Deletes jobs that have been kept long enough, and gives the room of deleted ones back.
async fn keep_house(engine: Arc<Engine>, keep_days: Option<u32>) {
    let mut interval = tokio::time::interval(BETWEEN_CLEANINGS);
    interval.set_missed_tick_behavior(MissedTickBehavior::Delay);
    // The first tick comes at once.
    interval.tick().await;
    loop {
        let cleaned = async {
            if let Some(days) = keep_days {
                let deleted = engine.store.delete_older_jobs(days).await?;
                if deleted > 0 {
                    tracing::info!(deleted, days, "deleted jobs that have been kept long enough");
                }
            }
            engine.store.purge().await
        };
        if let Err(error) = cleaned.await {
            tracing::warn!(%error, "could not clean up; trying again later");
        }
        tokio::select! {
            () = engine.deleted.notified() => {}
            _ = interval.tick() => {}
        }
    }
}

/// Begins a worker for tasks of one kind.
fn begin<T, F>(
    engine: &Arc<Engine>,
    stop: &CancellationToken,
    line: fn(&OwnTasks) -> &Line<T>,
    work: fn(Arc<Engine>, JobId, T) -> F,
) -> JoinHandle<()>
where
    T: Copy + Eq + Hash + Send + Sync + 'static,
    F: Future<Output = ()> + Send + 'static,
{
    engine.counters.queues.fetch_add(1, Ordering::Relaxed);
    tokio::spawn(work_off(Arc::clone(engine), stop.clone(), line, work))
}

/// Takes tasks of one kind as their turn comes, and does their work beside each other, until it is told to stop.
async fn work_off<T, F>(
    engine: Arc<Engine>,
    stop: CancellationToken,
    line: fn(&OwnTasks) -> &Line<T>,
    work: fn(Arc<Engine>, JobId, T) -> F,
) where
    T: Copy + Eq + Hash,
    F: Future<Output = ()> + Send + 'static,
{
    let Some(tasks) = engine.tasks.own() else { return };
    let running = TaskTracker::new();
    engine.counters.workers.fetch_add(1, Ordering::Relaxed);
    loop {
        tokio::select! {
            () = stop.cancelled() => break,
            (job, task) = line(tasks).next() => running.spawn(work(Arc::clone(&engine), job, task)),
        };
    }
    engine.counters.workers.fetch_sub(1, Ordering::Relaxed);
    running.close();
    running.wait().await;
}

/// Writes the latest progress to the store, now and then.
async fn record_progress(store: Store, reports: Arc<PendingReports>) {
    let mut interval = tokio::time::interval(BETWEEN_PROGRESS);
    loop {
        interval.tick().await;
        let mut lets_down = false;
        for (job, report) in reports.take() {
            if !lets_down && let Err(error) = store.record_progress(job, report.percent, &report.phase).await
            {
                tracing::warn!(job.id = %job, %error, "could not record progress");
                lets_down = true;
            }
            if lets_down {
                reports.put_back(job, report);
            }
        }
    }
}
