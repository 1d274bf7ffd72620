//! Jobs that change while somebody follows them.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, Weak};

use tokio::sync::Notify;

use super::jobs::job::JobId;

/// Tells those who follow a job that something of it has changed: in the database, or of what it says of itself beside it. What it is
/// they look up themselves.
#[derive(Debug, Clone, Default)]
pub struct Changes {
    followed: Arc<Mutex<HashMap<JobId, Weak<Notify>>>>,
}

impl Changes {
    /// Notified after a change of job `id`; several changes that nobody waited for are one.
    pub fn of(&self, id: JobId) -> Arc<Notify> {
        let mut followed = self.lock();
        // Those of jobs that changed after nobody followed them any more are gone already.
        followed.retain(|_, change| change.strong_count() > 0);
        if let Some(change) = followed.get(&id).and_then(Weak::upgrade) {
            return change;
        }
        let change = Arc::default();
        followed.insert(id, Arc::downgrade(&change));
        change
    }

    /// Job `id` has changed.
    pub fn tell(&self, id: JobId) {
        if let Some(change) = self.lock().get(&id).and_then(Weak::upgrade) {
            change.notify_one();
        }
    }

    /// Any job may have changed.
    pub fn tell_all(&self) {
        self.lock().values().filter_map(Weak::upgrade).for_each(|change| change.notify_one());
    }

    fn lock(&self) -> MutexGuard<'_, HashMap<JobId, Weak<Notify>>> {
        self.followed.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use futures::FutureExt;

    use super::*;

    #[tokio::test]
    async fn changes_reach_who_follows_that_job_once_he_looks() {
        let changes = Changes::default();
        let [job, other] = [JobId::new(), JobId::new()];
        let (mine, theirs) = (changes.of(job), changes.of(other));
        changes.tell(job);
        changes.tell(job);
        assert!(mine.notified().now_or_never().is_some());
        assert!(mine.notified().now_or_never().is_none(), "two changes that nobody waited for are one");
        assert!(theirs.notified().now_or_never().is_none());
        changes.tell_all();
        assert!(mine.notified().now_or_never().is_some() && theirs.notified().now_or_never().is_some());
        drop(mine);
        changes.tell(job);
        drop(changes.of(JobId::new()));
        assert_eq!(changes.lock().len(), 2, "what nobody follows is forgotten: {changes:?}");
    }
}
