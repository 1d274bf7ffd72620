//! The workers that take tasks from the queues, from start to stop.

use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::task::{Context, Poll};
use std::time::Duration;

use apalis::prelude::{
    BackendExt, BoxDynError, Data, PollSnapshot, PollStrategy, WorkerBuilder, WorkerBuilderExt, WorkerError,
};
use futures::{FutureExt, future::BoxFuture};
use tokio::sync::Notify;
use tokio::task::JoinHandle;
use tokio::time::MissedTickBehavior;
use tokio_util::sync::CancellationToken;

use super::computing::{MOST_CRASHES, pause};
use super::engine::Engine;
use super::handle::Jobs;
use super::memory::Memory;
use super::pool::CpuPool;
use super::progress::PendingReports;
use super::{error, prepare, speed};
use crate::store::jobs::Unfinished;
use crate::store::limits::Limits;
use crate::store::queue::{PrepareJob, Queue, RunSpeed};
use crate::store::{Store, StoreError};

/// How often a queue is asked for tasks without having been notified.
const IDLE_POLL: Duration = Duration::from_millis(500);

/// How long tasks may take to notice that the service stops: those that compute look many times a second.
const LAST_TASKS: Duration = Duration::from_secs(1);

/// Time between two writes of a job's progress. Each is a flush of the disk, and nobody looks more often.
const BETWEEN_PROGRESS: Duration = Duration::from_secs(1);

/// Time between two looks for jobs that have been kept long enough, and for what a full disk has kept from being cleaned up.
const BETWEEN_CLEANINGS: Duration = Duration::from_secs(60);

/// How the runner is set up.
#[derive(Debug, Clone)]
pub struct Settings {
    /// Threads that compute.
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
    /// Starts the workers and queues all unfinished jobs of the store. Only one runner may run on a data folder.
    pub async fn start(store: Store, settings: Settings) -> Result<Self, StoreError> {
        let queue = Queue::create().await?;
        let pool = |name, threads| CpuPool::start(name, threads, settings.workers);
        let pools = (pool("compute", settings.workers)?, pool("import", settings.workers)?, pool("plan", 1)?);
        let memory = Memory::new(settings.memory_bytes);
        let engine = Engine::new(store.clone(), queue, pools, memory, settings.limits);
        let all_preparations = engine.tasks.preparations.most();
        if let Err(error) = store.count_crashes().await {
            // Counted at the next start.
            tracing::warn!(%error, "could not count what the last service ended under");
        }
        store.restart_outdated().await?;
        for Unfinished { id, owner, crashes } in store.unfinished_jobs().await? {
            if crashes >= MOST_CRASHES && engine.fail(id, &error::crashed(crashes)).await.is_ok() {
                continue;
            }
            tracing::info!(job.id = %id, crashes, "resuming");
            engine.computing.suspect(id, crashes);
            let pause = pause(crashes);
            if pause.is_zero() {
                engine.tasks.prepare(&owner, id);
            } else {
                let engine = Arc::clone(&engine);
                tokio::spawn(async move {
                    tokio::time::sleep(pause).await;
                    engine.tasks.prepare(&owner, id);
                });
            }
        }
        let stop = CancellationToken::new();
        let workers = vec![
            tokio::spawn(supervise("prepare", Arc::clone(&engine), stop.clone(), {
                let (engine, stop) = (Arc::clone(&engine), stop.clone());
                move |name| prepare_jobs(name, Arc::clone(&engine), all_preparations, stop.clone())
            })),
            tokio::spawn(supervise("speeds", Arc::clone(&engine), stop.clone(), {
                let (engine, stop) = (Arc::clone(&engine), stop.clone());
                move |name| run_speeds(name, Arc::clone(&engine), settings.workers, stop.clone())
            })),
        ];
        let helpers = vec![
            tokio::spawn(record_progress(store, Arc::clone(&engine.reports))),
            tokio::spawn({
                let engine = Arc::clone(&engine);
                async move { engine.tasks.hand_out().await }
            }),
            tokio::spawn(keep_house(Arc::clone(&engine), settings.keep_days)),
        ];
        Ok(Self { engine, stop, workers, helpers })
    }

    /// The handle for `http`.
    pub fn jobs(&self) -> Jobs {
        Jobs::new(Arc::clone(&self.engine))
    }

    /// Ends running computations without finishing their jobs, which the next start resumes.
    pub async fn stop(self) {
        self.engine.stopping.store(true, Ordering::Relaxed);
        self.stop.cancel();
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
        self.engine.tasks.queue.close().await;
    }
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

fn prepare_jobs(
    name: String,
    engine: Arc<Engine>,
    concurrency: usize,
    stop: CancellationToken,
) -> BoxFuture<'static, Result<(), WorkerError>> {
    async fn handle(task: PrepareJob, engine: Data<Arc<Engine>>) -> Result<(), BoxDynError> {
        let _place = engine.tasks.preparing(task.job);
        engine.attend(task.job, || prepare::prepare(&engine, task.job)).await;
        Ok(())
    }
    let tasks = &engine.tasks;
    let backend = tasks.queue.preparations().poll_with_strategy(NotifyStrategy::new(&tasks.new_preparation));
    WorkerBuilder::new(name)
        .backend(backend)
        .concurrency(concurrency)
        .data(engine)
        .build(handle)
        .run_until(stopped(stop))
        .boxed()
}

fn run_speeds(
    name: String,
    engine: Arc<Engine>,
    concurrency: usize,
    stop: CancellationToken,
) -> BoxFuture<'static, Result<(), WorkerError>> {
    async fn handle(task: RunSpeed, engine: Data<Arc<Engine>>) -> Result<(), BoxDynError> {
        let _place = engine.tasks.running(task);
        engine.attend(task.job, || speed::run(&engine, task)).await;
        Ok(())
    }
    let tasks = &engine.tasks;
    let backend = tasks.queue.speeds().poll_with_strategy(NotifyStrategy::new(&tasks.new_speeds));
    WorkerBuilder::new(name)
        .backend(backend)
        .concurrency(concurrency)
        .data(engine)
        .build(handle)
        .run_until(stopped(stop))
        .boxed()
}

async fn stopped(stop: CancellationToken) -> Result<(), WorkerError> {
    stop.cancelled().await;
    Ok(())
}

/// Keeps a worker of `queue` going: one that its backend lets down is replaced, under a name not used before, because
/// `apalis` refuses a name that was seen alive a moment ago.
async fn supervise<F>(queue: &'static str, engine: Arc<Engine>, stop: CancellationToken, worker: F)
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

/// Wakes a worker when it is notified, and now and then without: a notification that arrives while the worker is asking
/// the queue would otherwise be lost.
struct NotifyStrategy {
    notifications: std::pin::Pin<Box<dyn futures::Stream<Item = ()> + Send + Sync>>,
    interval: tokio::time::Interval,
}

impl NotifyStrategy {
    fn new(notify: &Arc<Notify>) -> Self {
        let notifications = futures::stream::unfold(Arc::clone(notify), |notify| async move {
            notify.notified().await;
            Some(((), notify))
        });
        Self { notifications: Box::pin(notifications), interval: tokio::time::interval(IDLE_POLL) }
    }
}

impl PollStrategy for NotifyStrategy {
    /// Only arranges to be woken: the worker asks its queue whenever it is polled.
    fn poll_drive(&mut self, cx: &mut Context<'_>, _: &PollSnapshot) -> Poll<Option<()>> {
        while self.notifications.as_mut().poll_next(cx).is_ready() {}
        while self.interval.poll_tick(cx).is_ready() {}
        Poll::Pending
    }
}
