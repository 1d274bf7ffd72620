//! Tasks on their way to the workers: those of this process, or of all machines that share a database.

mod own;
#[cfg(feature = "cluster")]
mod shared;

use std::hash::Hash;
use std::pin::Pin;
use std::sync::Arc;
use std::task::{Context, Poll};
use std::time::Duration;

use apalis::prelude::{PollSnapshot, PollStrategy};
use tokio::sync::Notify;

use super::patience::BETWEEN_ATTEMPTS;
use super::turns::Turns;
use crate::store::jobs::JobId;
use crate::store::queue::{Queue, RunSpeed};
use crate::store::{Store, StoreError};

pub(super) use own::OwnTasks;
#[cfg(feature = "cluster")]
pub(super) use shared::SharedTasks;

/// Preparations beyond one per thread.
const WAITING_PREPARATIONS: usize = 16;

/// How often a queue is asked for tasks without having been notified.
const IDLE_POLL: Duration = Duration::from_millis(500);

/// Tasks on their way to the workers.
#[derive(Debug)]
pub(super) enum Tasks {
    /// Of this process alone.
    Own(OwnTasks),
    /// Of all machines that share a database.
    #[cfg(feature = "cluster")]
    Shared(SharedTasks),
}

/// Preparations of one owner under way at once, with so many threads that compute: those that wait for another job's reduction take no
/// thread, and must not keep others from theirs.
pub(super) fn preparations_at_once(threads: usize) -> usize {
    threads + WAITING_PREPARATIONS
}

impl Tasks {
    /// Those of this process, with so many threads that compute, unless the store is shared.
    pub(super) async fn of(store: &Store, threads: usize) -> Result<Self, StoreError> {
        #[cfg(feature = "cluster")]
        if let Some(queue) = store.shared_queue() {
            return Ok(Self::Shared(SharedTasks::new(queue.clone())));
        }
        #[cfg(not(feature = "cluster"))]
        let _ = store;
        Ok(Self::Own(OwnTasks::new(Queue::create().await?, threads)))
    }

    /// Whether other processes have tasks of the same jobs.
    pub(super) fn are_shared(&self) -> bool {
        !matches!(self, Self::Own(_))
    }

    /// Hands out tasks, one after the other ends; of shared ones that is done where they are.
    pub(super) async fn hand_out(&self) {
        match self {
            Self::Own(tasks) => tasks.hand_out().await,
            #[cfg(feature = "cluster")]
            Self::Shared(_) => {}
        }
    }

    /// Ends it: this process takes no more tasks, and others get those that it has.
    pub(super) async fn close(&self) {
        match self {
            Self::Own(tasks) => tasks.close().await,
            #[cfg(feature = "cluster")]
            Self::Shared(tasks) => tasks.give_back().await,
        }
    }

    /// Has a job prepared, when it is its turn.
    pub(super) fn prepare(&self, owner: &str, job: JobId) {
        match self {
            Self::Own(tasks) => tasks.prepare(owner, job),
            #[cfg(feature = "cluster")]
            Self::Shared(tasks) => tasks.prepare(job),
        }
    }

    /// Has speeds of a job run in this order, when it is their turn.
    pub(super) fn run(&self, owner: &str, job: JobId, speeds: impl IntoIterator<Item = u32>) {
        match self {
            Self::Own(tasks) => tasks.run(owner, job, speeds),
            #[cfg(feature = "cluster")]
            Self::Shared(tasks) => tasks.run(job, speeds.into_iter().collect()),
        }
    }

    /// Makes place for the next preparation when what this returns is dropped.
    pub(super) fn preparing(&self, job: JobId) -> Option<Place<'_, ()>> {
        match self {
            Self::Own(tasks) => Some(tasks.preparing(job)),
            #[cfg(feature = "cluster")]
            Self::Shared(_) => None,
        }
    }

    /// The same of a speed.
    pub(super) fn running(&self, task: RunSpeed) -> Option<Place<'_, u32>> {
        match self {
            Self::Own(tasks) => Some(tasks.running(task)),
            #[cfg(feature = "cluster")]
            Self::Shared(_) => None,
        }
    }

    /// Drops the waiting tasks of a job.
    pub(super) fn withdraw(&self, job: JobId) {
        match self {
            Self::Own(tasks) => tasks.withdraw(job),
            #[cfg(feature = "cluster")]
            Self::Shared(tasks) => tasks.withdraw(job),
        }
    }
}

/// The place of a task that is out.
pub(super) struct Place<'a, T: Copy + Eq + Hash> {
    turns: &'a Turns<T>,
    turn: &'a Notify,
    job: JobId,
    task: T,
}

impl<T: Copy + Eq + Hash> Drop for Place<'_, T> {
    fn drop(&mut self) {
        self.turns.done(self.job, self.task);
        self.turn.notify_one();
    }
}

/// Pushes a task until the queue takes it, which it does at once unless memory is short.
async fn until_taken<P: Future<Output = Result<(), StoreError>>>(push: impl Fn() -> P) {
    while let Err(error) = push().await {
        tracing::error!(%error, "the queue failed");
        tokio::time::sleep(BETWEEN_ATTEMPTS).await;
    }
}

/// Wakes a worker when it is notified, and now and then without: a notification that arrives while the worker is asking
/// the queue would otherwise be lost.
pub(super) struct Awake {
    notifications: Pin<Box<dyn futures::Stream<Item = ()> + Send + Sync>>,
    interval: tokio::time::Interval,
}

impl Awake {
    fn by(notify: &Arc<Notify>) -> Self {
        let notifications = futures::stream::unfold(Arc::clone(notify), |notify| async move {
            notify.notified().await;
            Some(((), notify))
        });
        Self { notifications: Box::pin(notifications), interval: tokio::time::interval(IDLE_POLL) }
    }
}

impl PollStrategy for Awake {
    /// Only arranges to be woken: the worker asks its queue whenever it is polled.
    fn poll_drive(&mut self, cx: &mut Context<'_>, _: &PollSnapshot) -> Poll<Option<()>> {
        while self.notifications.as_mut().poll_next(cx).is_ready() {}
        while self.interval.poll_tick(cx).is_ready() {}
        Poll::Pending
    }
}
