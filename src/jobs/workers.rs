//! The workers that take tasks from the queues, from start to stop.

use std::path::PathBuf;
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
use tokio_util::sync::CancellationToken;

use super::engine::Engine;
use super::error::Halt;
use super::handle::Jobs;
use super::memory::Memory;
use super::pool::CpuPool;
use super::progress::{News, Report};
use super::{prepare, speed};
use crate::store::queue::{PrepareJob, QueueFile, RunSpeed};
use crate::store::{Store, StoreError};

/// Preparations under way at once, beyond one per thread: those that wait for another job's reduction take no thread,
/// and must not keep others from theirs.
const WAITING_PREPARATIONS: usize = 16;

/// Times the service may die under a job, with nothing of it finished in between, before the job is given up.
const MOST_CRASHES: u32 = 5;

/// How often a queue is asked for tasks without having been rung.
const IDLE_POLL: Duration = Duration::from_millis(500);

/// Time between two writes of a job's progress. Each is a flush of the disk, and nobody looks more often.
const BETWEEN_PROGRESS: Duration = Duration::from_secs(1);

/// How the runner is set up.
#[derive(Debug, Clone)]
pub struct Settings {
    /// Folder for the queue's file.
    pub data: PathBuf,
    /// Threads that compute.
    pub workers: usize,
    /// Memory that reductions and generations may take together; `None` for no limit.
    pub memory_bytes: Option<u64>,
}

/// The running workers.
#[derive(Debug)]
pub struct Runner {
    engine: Arc<Engine>,
    stop: CancellationToken,
    workers: Vec<JoinHandle<()>>,
    recorder: JoinHandle<()>,
}

impl Runner {
    /// Starts the workers and queues all unfinished jobs of the store. Only one runner may run on a data folder.
    pub async fn start(store: Store, settings: Settings) -> Result<Self, StoreError> {
        let queue = QueueFile::create(&settings.data).await?;
        let pool = |name, threads| CpuPool::start(name, threads, settings.workers);
        let pools = (pool("compute", settings.workers)?, pool("import", 1)?, pool("plan", 1)?);
        let memory = Memory::new(settings.memory_bytes);
        let engine = Engine::new(store.clone(), queue, pools, memory);
        for (job, crashes) in store.take_up_jobs().await? {
            if crashes >= MOST_CRASHES {
                engine.settle(job, Err(Halt::crashed(crashes))).await;
                continue;
            }
            tracing::info!(job.id = %job, crashes, "resuming");
            engine.queue.push_preparation(job).await?;
        }
        let stop = CancellationToken::new();
        let workers = vec![
            tokio::spawn(supervise("prepare", Arc::clone(&engine), stop.clone(), {
                let (engine, stop) = (Arc::clone(&engine), stop.clone());
                let concurrency = settings.workers + WAITING_PREPARATIONS;
                move |name| preparations(name, Arc::clone(&engine), concurrency, stop.clone())
            })),
            tokio::spawn(supervise("speeds", Arc::clone(&engine), stop.clone(), {
                let (engine, stop) = (Arc::clone(&engine), stop.clone());
                move |name| speeds(name, Arc::clone(&engine), settings.workers, stop.clone())
            })),
        ];
        let recorder = tokio::spawn(record_progress(store, Arc::clone(&engine.news)));
        Ok(Self { engine, stop, workers, recorder })
    }

    /// The handle for `http`.
    pub fn jobs(&self) -> Jobs {
        Jobs::new(Arc::clone(&self.engine))
    }

    /// Ends running computations without finishing their jobs, which the next start resumes.
    pub async fn stop(self) {
        self.engine.stopping.store(true, Ordering::Relaxed);
        self.stop.cancel();
        // At once: who stops the service may not have the patience for the last computations to notice.
        if let Err(error) = self.engine.store.lay_down_jobs().await {
            tracing::warn!(%error, "could not lay down the running jobs; the next start takes this for a crash");
        }
        for worker in self.workers {
            if let Err(error) = worker.await {
                tracing::error!(%error, "a worker ended badly");
            }
        }
        self.recorder.abort();
        self.engine.queue.close().await;
    }
}

fn preparations(
    name: String,
    engine: Arc<Engine>,
    concurrency: usize,
    stop: CancellationToken,
) -> BoxFuture<'static, Result<(), WorkerError>> {
    async fn handle(task: PrepareJob, engine: Data<Arc<Engine>>) -> Result<(), BoxDynError> {
        let outcome = prepare::prepare(&engine, task.job).await;
        engine.settle(task.job, outcome).await;
        Ok(())
    }
    let backend = engine.queue.preparations().poll_with_strategy(Bell::new(&engine.new_preparation));
    WorkerBuilder::new(name)
        .backend(backend)
        .concurrency(concurrency)
        .data(engine)
        .build(handle)
        .run_until(stopped(stop))
        .boxed()
}

fn speeds(
    name: String,
    engine: Arc<Engine>,
    concurrency: usize,
    stop: CancellationToken,
) -> BoxFuture<'static, Result<(), WorkerError>> {
    async fn handle(task: RunSpeed, engine: Data<Arc<Engine>>) -> Result<(), BoxDynError> {
        let outcome = speed::run(&engine, task).await;
        engine.settle(task.job, outcome).await;
        Ok(())
    }
    let backend = engine.queue.speeds().poll_with_strategy(Bell::new(&engine.new_speeds));
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
async fn record_progress(store: Store, news: Arc<News>) {
    let mut interval = tokio::time::interval(BETWEEN_PROGRESS);
    loop {
        interval.tick().await;
        for (job, Report { percent, phase }) in news.take() {
            if let Err(error) = store.record_progress(job, percent, &phase).await {
                tracing::warn!(job.id = %job, %error, "could not record progress");
            }
        }
    }
}

/// Wakes a worker when its bell rings, and now and then without: a ring that arrives while the worker is asking the
/// queue would otherwise be lost.
struct Bell {
    ring: std::pin::Pin<Box<dyn futures::Stream<Item = ()> + Send + Sync>>,
    interval: tokio::time::Interval,
}

impl Bell {
    fn new(notify: &Arc<Notify>) -> Self {
        let ring = futures::stream::unfold(Arc::clone(notify), |notify| async move {
            notify.notified().await;
            Some(((), notify))
        });
        Self { ring: Box::pin(ring), interval: tokio::time::interval(IDLE_POLL) }
    }
}

impl PollStrategy for Bell {
    /// Only arranges to be woken: the worker asks its queue whenever it is polled.
    fn poll_drive(&mut self, cx: &mut Context<'_>, _: &PollSnapshot) -> Poll<Option<()>> {
        while self.ring.as_mut().poll_next(cx).is_ready() {}
        while self.interval.poll_tick(cx).is_ready() {}
        Poll::Pending
    }
}
