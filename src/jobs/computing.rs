//! Computations of jobs on the threads that compute: each is marked in the store while it runs, so that the next start knows
//! what this service died under; and caution with jobs it died under before.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use tokio::sync::OwnedMutexGuard;

use super::error::Interruption;
use super::pool::CpuPool;
use super::progress::Watch;
use crate::store::Store;
use crate::store::jobs::JobId;

/// Deaths of the service while something was being computed for a job, with nothing of it finished in between, after which
/// the job is given up.
pub(super) const MOST_CRASHES: u32 = 12;

/// Such deaths from which on a job is suspected: it computes when no other suspect does, and not at once.
const SUSPICIOUS: u32 = 3;

/// Longest time after the start before a suspect computes.
const LONGEST_PAUSE: Duration = Duration::from_secs(60);

/// Computations of jobs.
#[derive(Debug)]
pub(super) struct Computing {
    store: Store,
    pool: CpuPool,
    /// Jobs that something was being computed for when the service died, and how often.
    crashes: Mutex<HashMap<JobId, u32>>,
    /// Held by the suspect that computes.
    suspects: Arc<tokio::sync::Mutex<()>>,
}

impl Computing {
    pub(super) fn new(store: Store, pool: CpuPool) -> Self {
        Self { store, pool, crashes: Mutex::default(), suspects: Arc::default() }
    }

    /// Threads that compute.
    pub(super) fn threads(&self) -> usize {
        self.pool.threads()
    }

    /// Computes on one thread for the job of `watch`.
    pub(super) async fn run<T, F>(&self, watch: &Arc<Watch>, compute: F) -> Result<T, Interruption>
    where
        T: Send + 'static,
        F: FnOnce() -> T + Send + 'static,
    {
        let alone = self.admit(watch).await?;
        Ok(self.pool.run(self.marked(watch, alone, compute)).await?)
    }

    /// The same for work that is parallel in itself.
    pub(super) async fn run_parallel<T, F>(&self, watch: &Arc<Watch>, compute: F) -> Result<T, Interruption>
    where
        T: Send + 'static,
        F: FnOnce() -> T + Send + 'static,
    {
        let alone = self.admit(watch).await?;
        Ok(self.pool.run_parallel(self.marked(watch, alone, compute)).await?)
    }

    /// `compute` with a mark from its beginning to its end: what waits for a thread is not marked. What it holds it holds to
    /// its end as well, whether or not somebody still waits for it.
    fn marked<T, F: FnOnce() -> T>(
        &self,
        watch: &Watch,
        alone: Option<OwnedMutexGuard<()>>,
        compute: F,
    ) -> impl FnOnce() -> T + use<T, F> {
        let (store, job) = (self.store.clone(), watch.job());
        move || {
            let _alone = alone;
            let _mark = store.mark_computing(job);
            compute()
        }
    }

    /// The service died so often under a job.
    pub(super) fn suspect(&self, job: JobId, crashes: u32) {
        self.lock().insert(job, crashes);
    }

    /// Something of the job is finished: it is not what the service dies under.
    pub(super) fn acquit(&self, job: JobId) {
        self.lock().remove(&job);
    }

    /// Lets the job of `watch` compute. Of suspects one computes at a time, so that the next death tells which of them it is.
    async fn admit(&self, watch: &Arc<Watch>) -> Result<Option<OwnedMutexGuard<()>>, Interruption> {
        let crashes = self.lock().get(&watch.job()).copied().unwrap_or(0);
        let mut alone = None;
        if crashes >= SUSPICIOUS {
            alone = Some(Arc::clone(&self.suspects).lock_owned().await);
        }
        if watch.is_cancelled() { Err(Interruption::NotWanted) } else { Ok(alone) }
    }

    fn lock(&self) -> std::sync::MutexGuard<'_, HashMap<JobId, u32>> {
        self.crashes.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// How long after a start a job waits that the service died under so often: a suspect a second, and twice as long each time. A
/// machine that is killed all the time, for reasons of its own, gets on with the others meanwhile, and does not even come to
/// what would be blamed for it.
pub(super) fn pause(crashes: u32) -> Duration {
    if crashes < SUSPICIOUS {
        return Duration::ZERO;
    }
    let doublings = crashes.saturating_sub(SUSPICIOUS).min(10);
    Duration::from_secs(1 << doublings).min(LONGEST_PAUSE)
}

#[cfg(test)]
mod tests {
    use futures::FutureExt;

    use super::*;

    #[tokio::test]
    async fn suspects_compute_one_at_a_time_and_others_beside_them() {
        let folder = tempfile::tempdir().unwrap();
        let store = Store::open(folder.path()).await.unwrap();
        let pool = CpuPool::start("test", 1, 1).unwrap();
        let computing = Computing::new(store, pool);
        let watch = |job| Watch::new(job, 1, Arc::default(), Arc::default());
        let [one, two, innocent] = [(); 3].map(|()| watch(JobId::new()));
        for (watch, crashes) in [(&one, SUSPICIOUS), (&two, MOST_CRASHES), (&innocent, SUSPICIOUS - 1)] {
            computing.suspect(watch.job(), crashes);
        }
        let alone = computing.admit(&one).await.unwrap();
        assert!(alone.is_some());
        assert!(computing.admit(&two).now_or_never().is_none());
        assert!(matches!(computing.admit(&innocent).now_or_never(), Some(Ok(None))));
        // Something of it is finished: it is not what the service dies under.
        computing.acquit(two.job());
        assert!(matches!(computing.admit(&two).now_or_never(), Some(Ok(None))));
        two.dismiss();
        assert!(matches!(computing.run(&two, || ()).await, Err(Interruption::NotWanted)));
    }

    #[tokio::test]
    async fn what_computes_is_marked_and_what_waits_for_a_thread_is_not() {
        let folder = tempfile::tempdir().unwrap();
        let store = Store::open(folder.path()).await.unwrap();
        let computing = Computing::new(store, CpuPool::start("test", 1, 1).unwrap());
        let watch = || Watch::new(JobId::new(), 1, Arc::default(), Arc::default());
        let (computes, waits) = (watch(), watch());
        let (begun, begin) = std::sync::mpsc::channel();
        let (release, released) = std::sync::mpsc::channel::<()>();
        let marks = || {
            let files = std::fs::read_dir(folder.path().join("computing")).unwrap();
            files.map(|file| file.unwrap().file_name().into_string().unwrap()).collect::<Vec<_>>()
        };
        let mut first = Box::pin(computing.run(&computes, move || {
            begun.send(()).unwrap();
            released.recv().unwrap();
        }));
        assert!((&mut first).now_or_never().is_none());
        let mut second = Box::pin(computing.run(&waits, || ()));
        assert!((&mut second).now_or_never().is_none());
        begin.recv().unwrap();
        assert_eq!(marks(), [computes.job().to_string()]);
        release.send(()).unwrap();
        first.await.unwrap();
        second.await.unwrap();
        assert!(marks().is_empty());
    }

    #[test]
    fn the_pause_doubles_and_ends() {
        let pauses = [0, 2, 3, 4, 8, 9, MOST_CRASHES].map(|crashes| pause(crashes).as_secs());
        assert_eq!(pauses, [0, 0, 1, 2, 32, 60, 60]);
    }
}
