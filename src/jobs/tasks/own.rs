//! Tasks of this process alone: they wait here for their turn, and the queue has those whose turn it is.

use std::sync::Arc;
use std::time::Duration;

use apalis::prelude::{BackendExt, PollWith};
use apalis_sqlite::SqliteStorage;
use tokio::sync::Notify;

use super::awake::Awake;
use super::place::Place;
use crate::jobs::patience::until_taken;
use crate::jobs::turns::Turns;
use crate::store::jobs::JobId;
use crate::store::queue::{PrepareJob, Queue, RunSpeed};

/// How often a queue is asked for tasks without having been notified.
const IDLE_POLL: Duration = Duration::from_millis(500);

/// Preparations beyond one per thread.
const WAITING_PREPARATIONS: usize = 16;

/// Preparations of one owner under way at once, with so many threads that compute: those that wait for another job's reduction take no
/// thread, and must not keep others from theirs.
pub(in crate::jobs) fn preparations_at_once(threads: usize) -> usize {
    threads + WAITING_PREPARATIONS
}

/// Tasks that wait for their turn, and the queue that has those whose turn it is.
#[derive(Debug)]
pub(in crate::jobs) struct OwnTasks {
    queue: Queue,
    /// Jobs to be prepared.
    preparations: Turns<()>,
    /// Speeds to be run.
    speeds: Turns<u32>,
    /// Notified when a task was added or has ended: perhaps one can be handed out.
    turn: Notify,
    /// Notified when there is something new to prepare in the queue.
    new_preparation: Arc<Notify>,
    /// Notified when there are new speeds in the queue.
    new_speeds: Arc<Notify>,
}

impl OwnTasks {
    /// For so many threads that compute. All owners together have four times as many preparations under way as one.
    pub(super) fn new(queue: Queue, threads: usize) -> Self {
        let preparations = preparations_at_once(threads);
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

    /// Where a worker takes jobs to be prepared from.
    pub(in crate::jobs) fn preparations(&self) -> PollWith<SqliteStorage<PrepareJob>, Awake> {
        self.queue.preparations().poll_with_strategy(Awake::by(&self.new_preparation, IDLE_POLL))
    }

    /// Where a worker takes speeds from.
    pub(in crate::jobs) fn speeds(&self) -> PollWith<SqliteStorage<RunSpeed>, Awake> {
        self.queue.speeds().poll_with_strategy(Awake::by(&self.new_speeds, IDLE_POLL))
    }

    pub(super) async fn close(&self) {
        self.queue.close().await;
    }

    pub(super) fn prepare(&self, owner: &str, job: JobId) {
        self.preparations.add(owner, job, [()]);
        self.turn.notify_one();
    }

    pub(super) fn run(&self, owner: &str, job: JobId, speeds: impl IntoIterator<Item = u32>) {
        self.speeds.add(owner, job, speeds);
        self.turn.notify_one();
    }

    pub(super) fn withdraw(&self, job: JobId) {
        self.preparations.withdraw(job);
        self.speeds.withdraw(job);
    }

    pub(super) fn preparing(&self, job: JobId) -> Place<'_, ()> {
        Place { turns: &self.preparations, turn: &self.turn, job, task: () }
    }

    pub(super) fn running(&self, RunSpeed { job, speed }: RunSpeed) -> Place<'_, u32> {
        Place { turns: &self.speeds, turn: &self.turn, job, task: speed }
    }

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
