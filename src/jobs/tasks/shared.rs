//! Tasks of all machines that share a database. Owners take turns there, too: [`SharedQueue`] puts them in order.

use std::sync::{Arc, Mutex, PoisonError};

use apalis::prelude::{BackendExt, PollWith};
use apalis_postgres::PostgresStorage;
use tokio::sync::Notify;

use super::awake::Awake;
use crate::jobs::patience::until_taken;
use crate::store::jobs::JobId;
use crate::store::queue::{PrepareJob, RunSpeed};
use crate::store::shared_queue::SharedQueue;

/// Tasks of all machines, as one process sees them.
#[derive(Debug)]
pub(in crate::jobs) struct SharedTasks {
    queue: SharedQueue,
    /// What no other process is called.
    process: String,
    /// What its workers are called, those that ended as well.
    workers: Mutex<Vec<String>>,
    /// Notified when there may be something new to prepare.
    new_preparation: Arc<Notify>,
    /// Notified when there may be new speeds.
    new_speeds: Arc<Notify>,
}

impl SharedTasks {
    pub(in crate::jobs) fn new(queue: SharedQueue) -> Self {
        let process = uuid::Uuid::now_v7().simple().to_string();
        Self {
            queue,
            process,
            workers: Mutex::default(),
            new_preparation: Arc::default(),
            new_speeds: Arc::default(),
        }
    }

    /// The queue itself.
    pub(in crate::jobs) fn queue(&self) -> &SharedQueue {
        &self.queue
    }

    /// A name for a worker of this process that no other worker has.
    pub(in crate::jobs) fn name(&self, worker: &str) -> String {
        let name = format!("{}-{worker}", self.process);
        self.workers.lock().unwrap_or_else(PoisonError::into_inner).push(name.clone());
        name
    }

    /// Gives others what the workers of this process have not done, once they have ended.
    pub(in crate::jobs) async fn give_back(&self) {
        let workers = self.workers.lock().unwrap_or_else(PoisonError::into_inner).clone();
        if let Err(error) = self.queue.give_back(&workers).await {
            tracing::warn!(%error, "could not give tasks back; others take them when this process has been silent for a while");
        }
    }

    /// Where a worker takes jobs to be prepared from.
    pub(in crate::jobs) fn preparations(&self) -> PollWith<PostgresStorage<PrepareJob>, Awake> {
        self.queue.preparations().poll_with_strategy(Awake::by(&self.new_preparation))
    }

    /// Where a worker takes speeds from.
    pub(in crate::jobs) fn speeds(&self) -> PollWith<PostgresStorage<RunSpeed>, Awake> {
        self.queue.speeds().poll_with_strategy(Awake::by(&self.new_speeds))
    }

    /// There may be new tasks.
    pub(in crate::jobs) fn wake(&self) {
        self.new_preparation.notify_one();
        self.new_speeds.notify_one();
    }

    pub(super) fn prepare(&self, job: JobId) {
        let (queue, wake) = (self.queue.clone(), Arc::clone(&self.new_preparation));
        tokio::spawn(async move {
            until_taken(|| queue.push_preparation(job)).await;
            wake.notify_one();
        });
    }

    pub(super) fn run(&self, job: JobId, speeds: Vec<u32>) {
        let (queue, wake) = (self.queue.clone(), Arc::clone(&self.new_speeds));
        tokio::spawn(async move {
            until_taken(|| queue.push_speeds(job, &speeds)).await;
            wake.notify_one();
        });
    }

    pub(super) fn withdraw(&self, job: JobId) {
        let queue = self.queue.clone();
        // What is not withdrawn finds that its job has ended.
        tokio::spawn(async move {
            if let Err(error) = queue.withdraw(job).await {
                tracing::debug!(job.id = %job, %error, "could not withdraw the tasks of a job");
            }
        });
    }
}
