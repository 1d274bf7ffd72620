//! Tasks of all machines that share a database. Owners take turns there, too: [`SharedQueue`] puts them in order.

use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use apalis::prelude::{BackendExt, PollWith};
use apalis_postgres::PostgresStorage;
use tokio::sync::Notify;

use super::awake::Awake;
use super::kind::Kind;
use crate::analysis::run::vectors;
use crate::jobs::patience::{BETWEEN_ATTEMPTS, LONGEST_WRITE, in_time};
use crate::store::cluster::machines::WorkerProcess;
use crate::store::cluster::queue::SharedQueue;
use crate::store::jobs::JobId;
use crate::store::tasks::{PrepareJob, RunSpeed};
use crate::store::{Store, StoreError};

/// Time after which a queue is asked for tasks without having been notified.
const IDLE_POLL: Duration = Duration::from_secs(2);

/// Longest time to give tasks back: a process that is told to stop has little.
const GIVING_BACK: Duration = Duration::from_secs(1);

/// Tasks of all machines, as one process sees them.
#[derive(Debug)]
pub(in crate::jobs) struct SharedTasks {
    queue: SharedQueue,
    /// Name of this process, which no other process has.
    process: String,
    /// Names of the workers of this process, those that ended as well.
    workers: Mutex<Vec<String>>,
    /// Notification, by [`Kind`], that there may be something new to prepare.
    new_preparation: [Arc<Notify>; 2],
    /// Notification that there may be new speeds.
    new_speeds: [Arc<Notify>; 2],
}

impl SharedTasks {
    /// Tasks that the processes of a store share, if its tables are on a server.
    pub(in crate::jobs) fn of(store: &Store) -> Option<Self> {
        store.shared_queue().cloned().map(Self::new)
    }

    fn new(queue: SharedQueue) -> Self {
        let process = uuid::Uuid::now_v7().simple().to_string();
        Self {
            queue,
            process,
            workers: Mutex::default(),
            new_preparation: Default::default(),
            new_speeds: Default::default(),
        }
    }

    /// Shared queue itself.
    pub(super) fn queue(&self) -> &SharedQueue {
        &self.queue
    }

    /// Makes a name for a worker of this process that no other worker has.
    pub(super) fn name(&self, worker: &str) -> String {
        let name = format!("{}-{worker}", self.process);
        self.workers.lock().unwrap_or_else(PoisonError::into_inner).push(name.clone());
        name
    }

    /// Announces which machine this process computes on.
    pub(super) async fn announce(&self, worker: &WorkerProcess) -> Result<(), StoreError> {
        self.queue.announce(&self.process, worker).await
    }

    /// Gives others what the workers of this process have not done, once they have ended.
    pub(in crate::jobs) async fn give_back(&self) {
        let workers = self.workers.lock().unwrap_or_else(PoisonError::into_inner).clone();
        let given = async {
            self.queue.give_back(&workers).await?;
            self.queue.leave(&self.process).await
        };
        let silent = "others take the tasks of this process when it has been silent for a while";
        match tokio::time::timeout(GIVING_BACK, given).await {
            Ok(Ok(())) => {}
            Ok(Err(error)) => tracing::warn!(%error, "could not give tasks back: {silent}"),
            Err(_) => tracing::warn!("could not give tasks back in time: {silent}"),
        }
    }

    /// Source from which a worker takes jobs to be prepared.
    pub(super) fn preparations(&self, of: Kind) -> PollWith<PostgresStorage<PrepareJob>, Awake> {
        self.queue
            .preparations(of.vectors().as_deref())
            .poll_with_strategy(Awake::by(&self.new_preparation[of as usize], IDLE_POLL))
    }

    /// Source from which a worker takes speeds.
    pub(super) fn speeds(&self, of: Kind) -> PollWith<PostgresStorage<RunSpeed>, Awake> {
        self.queue
            .speeds(of.vectors().as_deref())
            .poll_with_strategy(Awake::by(&self.new_speeds[of as usize], IDLE_POLL))
    }

    /// Wakes the workers: there may be new tasks.
    pub(super) fn wake(&self) {
        for new in self.new_preparation.iter().chain(&self.new_speeds) {
            new.notify_one();
        }
    }

    pub(in crate::jobs) fn prepare(&self, job: JobId, vectors: Option<String>) {
        let queue = self.queue.clone();
        // The queue tells all machines of it, this one among them.
        tokio::spawn(async move { until_taken(|| queue.push_preparation(job, vectors.as_deref())).await });
    }

    pub(in crate::jobs) fn run(&self, job: JobId, one_kind: bool, speeds: Vec<u32>) {
        let (queue, vectors) = (self.queue.clone(), one_kind.then(vectors));
        tokio::spawn(
            async move { until_taken(|| queue.push_speeds(job, vectors.as_deref(), &speeds)).await },
        );
    }

    pub(in crate::jobs) fn withdraw(&self, job: JobId) {
        let queue = self.queue.clone();
        // A task that is not withdrawn finds that its job has ended.
        tokio::spawn(async move {
            if let Err(error) = queue.withdraw(job).await {
                tracing::debug!(job.id = %job, %error, "could not withdraw the tasks of a job");
            }
        });
    }
}

/// Pushes a task until the queue takes it, which it does at once unless memory is short.
async fn until_taken<P: Future<Output = Result<(), StoreError>>>(push: impl Fn() -> P) {
    while let Err(error) = in_time(LONGEST_WRITE, push()).await {
        tracing::error!(%error, "the queue failed");
        tokio::time::sleep(BETWEEN_ATTEMPTS).await;
    }
}
