//! Guards of tasks of this process that are out.

use std::hash::Hash;

use tokio::sync::Notify;

use crate::jobs::turns::Turns;
use crate::store::jobs::JobId;

/// Guard of a task that is out; when dropped, it makes place for the next.
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
