//! Computations of jobs on the threads that compute: each is marked in the store while it runs, so that the next start knows
//! under which jobs this service died; and caution with jobs under which it died before.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use tokio::sync::OwnedMutexGuard;

use super::error::Interruption;
use super::progress::Watch;
use crate::pool::CpuPool;
use crate::store::Store;
use crate::store::jobs::JobId;

/// Deaths of the service while something was being computed for a job, with nothing of it finished in between, after which the job is given up.
pub(super) const MOST_CRASHES: u32 = 12;

/// Deaths of the service under a job from which on the job is suspected: it computes when no other suspect does, and not at once.
const SUSPICIOUS: u32 = 3;

/// Longest time after the start of the service before a suspected job computes.
const LONGEST_PAUSE: Duration = Duration::from_secs(60);

/// Computations of jobs on a pool of threads.
#[derive(Debug)]
pub(super) struct Computing {
    store: Store,
    pool: CpuPool,
    /// Jobs for which something was being computed when the service died, with the number of its deaths.
    crashes: Mutex<HashMap<JobId, u32>>,
    /// Lock held by the suspected job that computes.
    suspects: Arc<tokio::sync::Mutex<()>>,
}

impl Computing {
    pub(super) fn new(store: Store, pool: CpuPool) -> Self {
        Self { store, pool, crashes: Mutex::default(), suspects: Arc::default() }
    }

    /// Number of threads that compute.
    pub(super) fn threads(&self) -> usize {
        self.pool.threads()
    }

    /// Runs `compute` on one thread for the job of `watch`.
    pub(super) async fn run<T, F>(&self, watch: &Arc<Watch>, compute: F) -> Result<T, Interruption>
    where
        T: Send + 'static,
        F: FnOnce() -> T + Send + 'static,
    {
        let alone = self.admit(watch).await?;
        Ok(self.pool.run(self.marked(watch, alone, compute)).await?)
    }

    /// Runs `compute`, which is parallel in itself, for the job of `watch`.
    pub(super) async fn run_parallel<T, F>(&self, watch: &Arc<Watch>, compute: F) -> Result<T, Interruption>
    where
        T: Send + 'static,
        F: FnOnce() -> T + Send + 'static,
    {
        let alone = self.admit(watch).await?;
        Ok(self.pool.run_parallel(self.marked(watch, alone, compute)).await?)
    }

    /// Wraps `compute` with a mark from its beginning to its end: what waits for a thread is not marked. What it holds it
    /// holds to its end as well, whether or not somebody still waits for it.
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

    /// Records that the service died `crashes` times under a job.
    pub(super) fn suspect(&self, job: JobId, crashes: u32) {
        self.lock().insert(job, crashes);
    }

    /// Clears a job of suspicion: something of it is finished, so it is not what the service dies under.
    pub(super) fn acquit(&self, job: JobId) {
        self.lock().remove(&job);
    }

    /// Lets the job of `watch` compute. Suspected jobs compute one at a time, so that the next death tells which of them it is.
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

/// Time after a start that a job waits under which the service died `crashes` times: a suspect waits a second, and twice as
/// long for each further death. A machine that is killed all the time, for reasons of its own, meanwhile gets on with the
/// other jobs, and does not even come to the one that would be blamed.
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
        // A finished part acquits the job: the service does not die under it.
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
