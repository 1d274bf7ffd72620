//! Where a task of this process is out.

use std::hash::Hash;

use tokio::sync::Notify;

use crate::jobs::turns::Turns;
use crate::store::jobs::JobId;

/// The place of a task that is out.
pub(in crate::jobs) struct Place<'a, T: Copy + Eq + Hash> {
    pub(super) turns: &'a Turns<T>,
    pub(super) turn: &'a Notify,
    pub(super) job: JobId,
    pub(super) task: T,
}

impl<T: Copy + Eq + Hash> Drop for Place<'_, T> {
    fn drop(&mut self) {
        self.turns.done(self.job, self.task);
        self.turn.notify_one();
    }
}
