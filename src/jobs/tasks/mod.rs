//! Tasks on their way to the workers: those of this process, or of all machines that share a database.

mod awake;
mod kind;
mod own;
mod place;
#[cfg(feature = "cluster")]
mod shared;

use self::place::Place;
use crate::store::jobs::JobId;
use crate::store::queue::{Queue, RunSpeed};
use crate::store::{Store, StoreError};

pub(super) use self::kind::{Kind, Whose};
pub(super) use self::own::{OwnTasks, preparations_at_once};
#[cfg(feature = "cluster")]
pub(super) use self::shared::SharedTasks;

/// Tasks on their way to the workers.
#[derive(Debug)]
pub(super) enum Tasks {
    /// Of this process alone.
    Own(OwnTasks),
    /// Of all machines that share a database.
    #[cfg(feature = "cluster")]
    Shared(SharedTasks),
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

    /// Kinds of tasks there are, each with workers of its own.
    pub(super) fn kinds(&self) -> &'static [Kind] {
        match self {
            Self::Own(_) => &[Kind::Any],
            #[cfg(feature = "cluster")]
            Self::Shared(_) => &[Kind::Any, Kind::OfThisProcessor],
        }
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

    /// Gives others what this process has of tasks that are shared.
    pub(super) async fn give_back(&self) {
        match self {
            Self::Own(_) => {}
            #[cfg(feature = "cluster")]
            Self::Shared(tasks) => tasks.give_back().await,
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
            Self::Shared(tasks) => tasks.prepare(job, None),
        }
    }

    /// Has a job prepared on a machine with these vectors.
    pub(super) fn prepare_elsewhere(&self, job: JobId, vectors: &str) {
        match self {
            Self::Own(_) => {
                tracing::warn!(job.id = %job, vectors, "of another kind of processor: begins anew at the next start");
            }
            #[cfg(feature = "cluster")]
            Self::Shared(tasks) => tasks.prepare(job, Some(vectors.to_owned())),
        }
    }

    /// Has speeds of a job run in this order, when it is their turn.
    pub(super) fn run(&self, whose: Whose<'_>, speeds: impl IntoIterator<Item = u32>) {
        match self {
            Self::Own(tasks) => tasks.run(whose.owner, whose.job, speeds),
            #[cfg(feature = "cluster")]
            Self::Shared(tasks) => tasks.run(whose, speeds.into_iter().collect()),
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
