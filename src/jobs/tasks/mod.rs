//! Tasks on their way to the workers: those of this process, or of all machines that share a database.

pub(super) mod own;
mod place;
mod whose;

use self::place::Place;
use crate::jobs::cluster::tasks::SharedTasks;
use crate::store::Store;
use crate::store::jobs::JobId;
use crate::store::tasks::RunSpeed;

pub(super) use self::own::{Line, OwnTasks};
pub(super) use self::whose::Whose;

/// Tasks on their way to the workers.
#[derive(Debug)]
pub(super) enum Tasks {
    /// Tasks of this process alone.
    Own(Box<OwnTasks>),
    /// Tasks of all machines that share a database.
    Shared(SharedTasks),
}

impl Tasks {
    /// Tasks of this process, with so many threads that compute, unless the store is shared.
    pub(super) fn of(store: &Store, threads: usize) -> Self {
        SharedTasks::of(store).map_or_else(|| Self::Own(Box::new(OwnTasks::new(threads))), Self::Shared)
    }

    /// Tasks of this process alone, if they are.
    pub(super) fn own(&self) -> Option<&OwnTasks> {
        match self {
            Self::Own(tasks) => Some(tasks),
            Self::Shared(_) => None,
        }
    }

    /// Whether other processes have tasks of the same jobs.
    pub(super) fn are_shared(&self) -> bool {
        !matches!(self, Self::Own(_))
    }

    /// Gives others what this process has of tasks that are shared.
    pub(super) async fn give_back(&self) {
        match self {
            Self::Own(_) => {}
            Self::Shared(tasks) => tasks.give_back().await,
        }
    }

    /// Has a job prepared, when it is its turn.
    pub(super) fn prepare(&self, owner: &str, job: JobId) {
        match self {
            Self::Own(tasks) => tasks.prepare(owner, job),
            Self::Shared(tasks) => tasks.prepare(job, None),
        }
    }

    /// Queues a job for preparation on a machine with these vectors.
    pub(super) fn prepare_elsewhere(&self, job: JobId, vectors: &str) {
        match self {
            Self::Own(_) => {
                tracing::warn!(job.id = %job, vectors, "of another kind of processor: begins anew at the next start");
            }
            Self::Shared(tasks) => tasks.prepare(job, Some(vectors.to_owned())),
        }
    }

    /// Queues speeds of a job to run in this order, in their turn.
    pub(super) fn run(&self, whose: Whose<'_>, speeds: impl IntoIterator<Item = u32>) {
        match self {
            Self::Own(tasks) => tasks.run(whose.owner, whose.job, speeds),
            Self::Shared(tasks) => tasks.run(whose.job, whose.one_kind, speeds.into_iter().collect()),
        }
    }

    /// Marks the preparation of a job as under way; the guard makes place for the next one when dropped.
    pub(super) fn preparing(&self, job: JobId) -> Option<Place<'_, ()>> {
        match self {
            Self::Own(tasks) => Some(tasks.preparing(job)),
            Self::Shared(_) => None,
        }
    }

    /// Marks a speed as under way; the guard makes place for the next one when dropped.
    pub(super) fn running(&self, task: RunSpeed) -> Option<Place<'_, u32>> {
        match self {
            Self::Own(tasks) => Some(tasks.running(task)),
            Self::Shared(_) => None,
        }
    }

    /// Drops the waiting tasks of a job.
    pub(super) fn withdraw(&self, job: JobId) {
        match self {
            Self::Own(tasks) => tasks.withdraw(job),
            Self::Shared(tasks) => tasks.withdraw(job),
        }
    }
}
