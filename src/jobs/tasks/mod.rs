//! Tasks on their way to the workers: those of this process, or of all machines that share a database.

#[cfg(feature = "cluster")]
mod awake;
#[cfg(feature = "cluster")]
mod kind;
mod own;
mod place;
#[cfg(feature = "cluster")]
mod shared;
mod whose;

use self::place::Place;
use crate::store::Store;
use crate::store::jobs::JobId;
use crate::store::tasks::RunSpeed;

#[cfg(feature = "cluster")]
pub(super) use self::kind::Kind;
#[cfg(feature = "cluster")]
pub(super) use self::own::preparations_at_once;
pub(super) use self::own::{Line, OwnTasks};
#[cfg(feature = "cluster")]
pub(super) use self::shared::SharedTasks;
pub(super) use self::whose::Whose;

/// Tasks on their way to the workers.
#[derive(Debug)]
pub(super) enum Tasks {
    /// Tasks of this process alone.
    Own(OwnTasks),
    /// Tasks of all machines that share a database.
    #[cfg(feature = "cluster")]
    Shared(SharedTasks),
}

impl Tasks {
    /// Tasks of this process, with so many threads that compute, unless the store is shared.
    pub(super) fn of(store: &Store, threads: usize) -> Self {
        #[cfg(feature = "cluster")]
        if let Some(queue) = store.shared_queue() {
            return Self::Shared(SharedTasks::new(queue.clone()));
        }
        #[cfg(not(feature = "cluster"))]
        let _ = store;
        Self::Own(OwnTasks::new(threads))
    }

    /// Tasks of this process alone, if they are.
    pub(super) fn own(&self) -> Option<&OwnTasks> {
        match self {
            Self::Own(tasks) => Some(tasks),
            #[cfg(feature = "cluster")]
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
            #[cfg(feature = "cluster")]
            Self::Shared(tasks) => tasks.give_back().await,
        }
    }

    /// Has a job prepared, when it is its turn.
    pub(super) fn prepare(&self, owner: &str, job: JobId) {
        match self {
            Self::Own(tasks) => tasks.prepare(owner, job),
            #[cfg(feature = "cluster")]
            Self::Shared(tasks) => tasks.prepare(job, None),
        }
    }

    /// Queues a job for preparation on a machine with these vectors.
    pub(super) fn prepare_elsewhere(&self, job: JobId, vectors: &str) {
        match self {
            Self::Own(_) => {
                tracing::warn!(job.id = %job, vectors, "of another kind of processor: begins anew at the next start");
            }
            #[cfg(feature = "cluster")]
            Self::Shared(tasks) => tasks.prepare(job, Some(vectors.to_owned())),
        }
    }

    /// Queues speeds of a job to run in this order, in their turn.
    pub(super) fn run(&self, whose: Whose<'_>, speeds: impl IntoIterator<Item = u32>) {
        match self {
            Self::Own(tasks) => tasks.run(whose.owner, whose.job, speeds),
            #[cfg(feature = "cluster")]
            Self::Shared(tasks) => tasks.run(whose, speeds.into_iter().collect()),
        }
    }

    /// Marks the preparation of a job as under way; the guard makes place for the next one when dropped.
    pub(super) fn preparing(&self, job: JobId) -> Option<Place<'_, ()>> {
        match self {
            Self::Own(tasks) => Some(tasks.preparing(job)),
            #[cfg(feature = "cluster")]
            Self::Shared(_) => None,
        }
    }

    /// Marks a speed as under way; the guard makes place for the next one when dropped.
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
