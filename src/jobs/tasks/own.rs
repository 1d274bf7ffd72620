//! Tasks of this process alone, which wait here for their turn.

use std::hash::Hash;

use tokio::sync::Notify;

use super::place::Place;
use crate::jobs::turns::Turns;
use crate::store::jobs::JobId;
use crate::store::tasks::RunSpeed;

/// Number of preparations beyond one per thread.
const WAITING_PREPARATIONS: usize = 16;

/// Preparations of one owner under way at once, with so many threads that compute: those that wait for another job's reduction take no
/// thread, and must not keep others from theirs.
pub(in crate::jobs) fn preparations_at_once(threads: usize) -> usize {
    threads + WAITING_PREPARATIONS
}

/// Tasks of this process.
#[derive(Debug)]
pub(in crate::jobs) struct OwnTasks {
    /// Jobs to be prepared.
    pub(in crate::jobs) preparations: Line<()>,
    /// Speeds to be run.
    pub(in crate::jobs) speeds: Line<u32>,
}

/// Tasks of one kind that wait for their turn.
#[derive(Debug)]
pub(in crate::jobs) struct Line<T> {
    turns: Turns<T>,
    /// Notified when a task was added or has ended: perhaps another can begin.
    turn: Notify,
}

impl OwnTasks {
    /// Tasks for so many threads that compute. All owners together have four times as many preparations under way as one.
    pub(super) fn new(threads: usize) -> Self {
        let preparations = preparations_at_once(threads);
        Self {
            preparations: Line::new(Turns::new(4 * preparations, preparations)),
            speeds: Line::new(Turns::new(threads, threads)),
        }
    }

    pub(super) fn prepare(&self, owner: &str, job: JobId) {
        self.preparations.add(owner, job, [()]);
    }

    pub(super) fn run(&self, owner: &str, job: JobId, speeds: impl IntoIterator<Item = u32>) {
        self.speeds.add(owner, job, speeds);
    }

    pub(super) fn withdraw(&self, job: JobId) {
        self.preparations.turns.withdraw(job);
        self.speeds.turns.withdraw(job);
    }

    pub(super) fn preparing(&self, job: JobId) -> Place<'_, ()> {
        self.preparations.place(job, ())
    }

    pub(super) fn running(&self, RunSpeed { job, speed }: RunSpeed) -> Place<'_, u32> {
        self.speeds.place(job, speed)
    }
}

impl<T: Copy + Eq + Hash> Line<T> {
    fn new(turns: Turns<T>) -> Self {
        Self { turns, turn: Notify::new() }
    }

    fn add(&self, owner: &str, job: JobId, tasks: impl IntoIterator<Item = T>) {
        self.turns.add(owner, job, tasks);
        self.turn.notify_one();
    }

    /// Waits for the next task that may begin. One at a time may wait.
    pub(in crate::jobs) async fn next(&self) -> (JobId, T) {
        loop {
            if let Some(task) = self.turns.next() {
                return task;
            }
            self.turn.notified().await;
        }
    }

    fn place(&self, job: JobId, task: T) -> Place<'_, T> {
        Place { turns: &self.turns, turn: &self.turn, job, task }
    }
}
