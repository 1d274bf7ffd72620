//! The workers that take tasks from the queues, from start to stop.

use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::Duration;

use apalis::prelude::{BoxDynError, Data, WorkerBuilder, WorkerBuilderExt, WorkerError};
use futures::{FutureExt, future::BoxFuture};
use tokio::task::JoinHandle;
use tokio::time::MissedTickBehavior;
use tokio_util::sync::CancellationToken;

use super::computing::{MOST_CRASHES, pause};
use super::engine::Engine;
use super::handle::Jobs;
use super::memory::Memory;
use super::pool::CpuPool;
use super::progress::PendingReports;
#[cfg(feature = "cluster")]
use super::share;
use super::tasks::{self, Kind, Tasks};
use super::{error, prepare, speed};
use crate::store::jobs::Unfinished;
use crate::store::limits::Limits;
use crate::store::queue::{PrepareJob, RunSpeed};
use crate::store::{Store, StoreError};

/// How long tasks may take to notice that the service stops: those that compute look many times a second.
const LAST_TASKS: Duration = Duration::from_secs(1);

/// Time between two writes of a job's progress. Each is a flush of the disk, and nobody looks more often.
const BETWEEN_PROGRESS: Duration = Duration::from_secs(1);

/// Time between two looks for jobs that have been kept long enough, and for what a full disk has kept from being cleaned up.
const BETWEEN_CLEANINGS: Duration = Duration::from_secs(60);

/// How the runner is set up.
#[derive(Debug, Clone)]
pub struct Settings {
    /// Threads that compute; 0 where others do, of a database that is shared.
    pub workers: usize,
    /// Memory that computations, uploads and large downloads may take together; `None` for no limit.
    pub memory_bytes: Option<u64>,
    /// Days after which finished jobs are deleted; `None` keeps them.
    pub keep_days: Option<u32>,
    /// What one owner may have.
    pub limits: Limits,
}

/// The running workers.
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
        let pools = (pool("compute", threads)?, pool("import", threads)?, pool("plan", 1)?);
        let memory = Memory::new(settings.memory_bytes);
        let tasks = Tasks::of(&store, threads).await?;
        let engine = Engine::new(store.clone(), tasks, pools, memory, settings.limits);
        if let Err(error) = store.count_crashes().await {
            // Counted at the next start.
            tracing::warn!(%error, "could not count what the last service ended under");
        }
        let mut helpers = vec![
            tokio::spawn(record_progress(store.clone(), Arc::clone(&engine.reports))),
            tokio::spawn(keep_house(Arc::clone(&engine), settings.keep_days)),
        ];
        match &engine.tasks {
            Tasks::Own(_) => {
                store.restart_outdated().await?;
                resume(&engine).await?;
                let engine = Arc::clone(&engine);
                helpers.push(tokio::spawn(async move { engine.tasks.hand_out().await }));
            }
            #[cfg(feature = "cluster")]
            Tasks::Shared(_) => helpers.extend(share::start(&engine, settings.workers > 0)),
        }
        let stop = CancellationToken::new();
        let mut workers = Vec::new();
        if settings.workers > 0 {
            for (queue, work) in [("prepare", prepare_jobs as StartWorker), ("speeds", run_speeds)] {
                for &kind in engine.tasks.kinds() {
                    let start = {
                        let (engine, stop) = (Arc::clone(&engine), stop.clone());
                        move |name| work((name, kind), Arc::clone(&engine), threads, stop.clone())
                    };
                    engine.counters.queues.fetch_add(1, Ordering::Relaxed);
                    let queue = format!("{queue}-{kind:?}");
                    workers.push(tokio::spawn(supervise(queue, Arc::clone(&engine), stop.clone(), start)));
                }
            }
        }
        Ok(Self { engine, stop, workers, helpers })
    }

    /// The handle for `http`.
    pub fn jobs(&self) -> Jobs {
        Jobs::new(Arc::clone(&self.engine))
    }

    /// Ends running computations without finishing their jobs, which the next start resumes.
    pub async fn stop(self) {
        self.stop.cancel();
        // Before they end, which would be taken for having done what they had.
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
            // They wait for something; what they have finished is kept.
            workers.iter().for_each(JoinHandle::abort);
        }
        self.engine.store.stop_marking();
        self.helpers.iter().for_each(JoinHandle::abort);
        self.engine.tasks.close().await;
    }
}

/// Has all unfinished jobs prepared: at once, or later those that the service died under again and again.
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
    // The first comes at once.
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

/// Starts a worker of this name for such tasks, with so many threads.
type StartWorker =
    fn((String, Kind), Arc<Engine>, usize, CancellationToken) -> BoxFuture<'static, Result<(), WorkerError>>;

/// A worker that hands the tasks of a source to a handler until it is told to stop; a macro, because the types of sources share nothing
/// that can be written down.
macro_rules! worker {
    ($name:expr, $source:expr, $concurrency:expr, $engine:expr, $stop:expr, $handler:expr) => {
        WorkerBuilder::new($name)
            .backend($source)
            .concurrency($concurrency)
            .data($engine)
            .build($handler)
            .run_until(stopped($stop))
            .boxed()
    };
}

fn prepare_jobs(
    (name, kind): (String, Kind),
    engine: Arc<Engine>,
    threads: usize,
    stop: CancellationToken,
) -> BoxFuture<'static, Result<(), WorkerError>> {
    async fn handle(task: PrepareJob, engine: Data<Arc<Engine>>) -> Result<(), BoxDynError> {
        let engine = Arc::clone(&engine);
        outliving(async move {
            let place = engine.tasks.preparing(task.job);
            let wanted = engine.attend(task.job, || prepare::prepare(&engine, task.job)).await;
            drop(place);
            if !wanted {
                engine.take_up_again(task.job).await;
            }
        })
        .await
    }
    let most = tasks::preparations_at_once(threads);
    match (&Arc::clone(&engine).tasks, kind) {
        (Tasks::Own(tasks), _) => worker!(name, tasks.preparations(), 4 * most, engine, stop, handle),
        #[cfg(feature = "cluster")]
        (Tasks::Shared(tasks), kind) => {
            worker!(tasks.name(&name), tasks.preparations(kind), most, engine, stop, handle)
        }
    }
}

fn run_speeds(
    (name, kind): (String, Kind),
    engine: Arc<Engine>,
    threads: usize,
    stop: CancellationToken,
) -> BoxFuture<'static, Result<(), WorkerError>> {
    async fn handle(task: RunSpeed, engine: Data<Arc<Engine>>) -> Result<(), BoxDynError> {
        let engine = Arc::clone(&engine);
        outliving(async move {
            let place = engine.tasks.running(task);
            let wanted = engine.attend(task.job, || speed::run(&engine, task)).await;
            drop(place);
            if !wanted {
                engine.take_up_again(task.job).await;
            }
        })
        .await
    }
    match (&Arc::clone(&engine).tasks, kind) {
        (Tasks::Own(tasks), _) => worker!(name, tasks.speeds(), threads, engine, stop, handle),
        #[cfg(feature = "cluster")]
        (Tasks::Shared(tasks), kind) => {
            worker!(tasks.name(&name), tasks.speeds(kind), threads, engine, stop, handle)
        }
    }
}

/// Does the work of a task to its end, even if the worker that has it is replaced: `apalis` gives one up, with all that it waits for, as
/// soon as its backend cannot be reached.
async fn outliving(work: impl Future<Output = ()> + Send + 'static) -> Result<(), BoxDynError> {
    Ok(tokio::spawn(work).await?)
}

async fn stopped(stop: CancellationToken) -> Result<(), WorkerError> {
    stop.cancelled().await;
    Ok(())
}

/// Keeps a worker of `queue` going: one that its backend lets down is replaced, under a name not used before, because
/// `apalis` refuses a name that was seen alive a moment ago.
async fn supervise<F>(queue: String, engine: Arc<Engine>, stop: CancellationToken, worker: F)
where
    F: Fn(String) -> BoxFuture<'static, Result<(), WorkerError>>,
{
    for generation in 0.. {
        engine.counters.workers.fetch_add(1, Ordering::Relaxed);
        let ended = worker(format!("{queue}-{generation}")).await;
        engine.counters.workers.fetch_sub(1, Ordering::Relaxed);
        if stop.is_cancelled() {
            break;
        }
        match ended {
            Ok(()) => tracing::error!(queue, "worker ended; starting another"),
            Err(error) => tracing::error!(queue, %error, "worker ended; starting another"),
        }
        tokio::time::sleep(Duration::from_secs(1)).await;
    }
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
