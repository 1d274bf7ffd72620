//! Changes of jobs, for clients that follow them.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, Weak};

use tokio::sync::Notify;

use super::jobs::job::JobId;

/// Notifies the followers of a job of any change: in the database, or in its live state beside it. Followers look up the change themselves.
#[derive(Debug, Clone, Default)]
pub struct Changes {
    followed: Arc<Mutex<HashMap<JobId, Weak<Notify>>>>,
}

impl Changes {
    /// Notification of changes of job `id`; several changes that nobody waited for count as one.
    pub fn of(&self, id: JobId) -> Arc<Notify> {
        let mut followed = self.lock();
        // Notifications of jobs that nobody follows any more are dropped.
        followed.retain(|_, change| change.strong_count() > 0);
        if let Some(change) = followed.get(&id).and_then(Weak::upgrade) {
            return change;
        }
        let change = Arc::default();
        followed.insert(id, Arc::downgrade(&change));
        change
    }

    /// Notifies the followers of job `id` of a change.
    pub fn tell(&self, id: JobId) {
        if let Some(change) = self.lock().get(&id).and_then(Weak::upgrade) {
            change.notify_one();
        }
    }

    /// Notifies the followers of all jobs: any of them may have changed.
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
