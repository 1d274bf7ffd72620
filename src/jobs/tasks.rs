//! Tasks on their way to the workers of this process.

use std::hash::Hash;
use std::sync::Arc;

use tokio::sync::Notify;

use super::patience::BETWEEN_ATTEMPTS;
use super::turns::Turns;
use crate::store::StoreError;
use crate::store::jobs::JobId;
use crate::store::queue::{Queue, RunSpeed};

/// Preparations of one owner under way at once, beyond one per thread: those that wait for another job's reduction take no
/// thread, and must not keep others from theirs. All owners together have four times as many.
const WAITING_PREPARATIONS: usize = 16;

/// Tasks that wait for their turn, and the queue that has those whose turn it is.
#[derive(Debug)]
pub(super) struct Tasks {
    pub(super) queue: Queue,
    /// Jobs to be prepared.
    pub(super) preparations: Turns<()>,
    /// Speeds to be run.
    pub(super) speeds: Turns<u32>,
    /// Notified when a task was added or has ended: perhaps one can be handed out.
    turn: Notify,
    /// Notified when there is something new to prepare in the queue.
    pub(super) new_preparation: Arc<Notify>,
    /// Notified when there are new speeds in the queue.
    pub(super) new_speeds: Arc<Notify>,
}

impl Tasks {
    /// For so many threads that compute.
    pub(super) fn new(queue: Queue, threads: usize) -> Self {
        let preparations = threads + WAITING_PREPARATIONS;
        Self {
            queue,
            preparations: Turns::new(4 * preparations, preparations),
            // One for each thread to take as soon as it is done with another.
            speeds: Turns::new(2 * threads, 2 * threads),
            turn: Notify::new(),
            new_preparation: Arc::default(),
            new_speeds: Arc::default(),
        }
    }

    /// Has a job prepared, when it is its turn.
    pub(super) fn prepare(&self, owner: &str, job: JobId) {
        self.preparations.add(owner, job, [()]);
        self.turn.notify_one();
    }

    /// Has speeds of a job run in this order, when it is their turn.
    pub(super) fn run(&self, owner: &str, job: JobId, speeds: impl IntoIterator<Item = u32>) {
        self.speeds.add(owner, job, speeds);
        self.turn.notify_one();
    }

    /// Drops the waiting tasks of a job.
    pub(super) fn withdraw(&self, job: JobId) {
        self.preparations.withdraw(job);
        self.speeds.withdraw(job);
    }

    /// Makes place for the next preparation when what this returns is dropped.
    pub(super) fn preparing(&self, job: JobId) -> Place<'_, ()> {
        Place { turns: &self.preparations, turn: &self.turn, job, task: () }
    }

    /// The same of a speed.
    pub(super) fn running(&self, RunSpeed { job, speed }: RunSpeed) -> Place<'_, u32> {
        Place { turns: &self.speeds, turn: &self.turn, job, task: speed }
    }

    /// Hands out tasks, one after the other ends.
    pub(super) async fn hand_out(&self) {
        loop {
            while let Some((job, ())) = self.preparations.next() {
                until_taken(|| self.queue.push_preparation(job)).await;
                self.new_preparation.notify_one();
            }
            while let Some((job, speed)) = self.speeds.next() {
                until_taken(|| self.queue.push_speed(RunSpeed { job, speed })).await;
                self.new_speeds.notify_one();
            }
            self.turn.notified().await;
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
