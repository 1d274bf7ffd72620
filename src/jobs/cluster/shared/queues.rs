//! Workers that take tasks from the queues that machines share.

use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::Duration;

use apalis::prelude::{BoxDynError, Data, WorkerBuilder, WorkerBuilderExt, WorkerError};
use futures::FutureExt;
use futures::future::{self, BoxFuture};
use tokio::task::JoinHandle;
use tokio_util::sync::CancellationToken;

use super::kind::Kind;
use crate::jobs::engine::Engine;
use crate::jobs::perform::{prepare_job, run_speed};
use crate::jobs::tasks::Tasks;
use crate::jobs::tasks::own::preparations_at_once;
use crate::store::tasks::{PrepareJob, RunSpeed};

/// Starts a worker for each queue and kind of tasks, with so many threads.
pub(super) fn start(engine: &Arc<Engine>, threads: usize, stop: &CancellationToken) -> Vec<JoinHandle<()>> {
    let mut workers = Vec::new();
    for (queue, work) in [("prepare", prepare_jobs as StartWorker), ("speeds", run_speeds)] {
        for kind in Kind::ALL {
            let start = {
                let (engine, stop) = (Arc::clone(engine), stop.clone());
                move |name| work((name, kind), Arc::clone(&engine), threads, stop.clone())
            };
            engine.counters.queues.fetch_add(1, Ordering::Relaxed);
            let queue = format!("{queue}-{kind:?}");
            workers.push(tokio::spawn(supervise(queue, Arc::clone(engine), stop.clone(), start)));
        }
    }
    workers
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
        outliving(prepare_job(Arc::clone(&engine), task.job, ())).await
    }
    let most = preparations_at_once(threads);
    match &Arc::clone(&engine).tasks {
        Tasks::Own(_) => future::ready(Ok(())).boxed(),
        Tasks::Shared(tasks) => {
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
        outliving(run_speed(Arc::clone(&engine), task.job, task.speed)).await
    }
    match &Arc::clone(&engine).tasks {
        Tasks::Own(_) => future::ready(Ok(())).boxed(),
        Tasks::Shared(tasks) => {
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
