//! What all tasks share.

use std::collections::HashMap;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use tokio::sync::Notify;

use super::error::Halt;
use super::memory::Memory;
use super::plans::Calibrated;
use super::pool::CpuPool;
use super::progress::{News, Watch};
use super::reductions::Reductions;
use super::room::once_there_is_room;
use super::work::Counters;
use crate::store::Store;
use crate::store::jobs::{Chosen, Failure, FailureCause, Job, JobId, JobRequest};
use crate::store::queue::QueueFile;
use crate::store::status::JobStatus;

/// What all tasks share.
#[derive(Debug)]
pub(super) struct Engine {
    pub(super) store: Store,
    pub(super) queue: QueueFile,
    pub(super) pool: CpuPool,
    /// Reads uploads, so that they do not wait behind speeds.
    pub(super) importer: CpuPool,
    /// Plans, which are wanted at once.
    pub(super) planner: CpuPool,
    pub(super) reductions: Reductions,
    pub(super) calibrated: Calibrated,
    /// What reductions and generations may take together.
    pub(super) memory: Arc<Memory>,
    pub(super) counters: Counters,
    /// Rung when there is something new to prepare.
    pub(super) new_preparation: Arc<Notify>,
    /// Rung when there are new speeds to run.
    pub(super) new_speeds: Arc<Notify>,
    /// Set when the service stops: computations end, their jobs stay as they are.
    pub(super) stopping: Arc<AtomicBool>,
    live: Mutex<HashMap<JobId, Arc<Live>>>,
    /// Progress of all jobs, to be written down.
    pub(super) news: Arc<News>,
}

/// An unfinished job in memory.
#[derive(Debug)]
pub(super) struct Live {
    pub(super) id: JobId,
    pub(super) request: JobRequest,
    pub(super) speeds: u32,
    /// Its speeds in the order in which each starts from the end of the one before; none where each is on its own.
    pub(super) chain: Option<Vec<u32>>,
    pub(super) watch: Arc<Watch>,
}

impl Live {
    /// The speeds before and after `speed` in the chain, if there are such.
    pub(super) fn neighbours(&self, speed: u32) -> (Option<u32>, Option<u32>) {
        let Some(chain) = &self.chain else { return (None, None) };
        let at = |place: Option<usize>| place.and_then(|place| chain.get(place)).copied();
        let place = chain.iter().position(|&link| link == speed);
        (at(place.and_then(|place| place.checked_sub(1))), at(place.map(|place| place + 1)))
    }
}

/// The chain of a sweep up or down.
fn chain(request: &JobRequest) -> Option<Vec<u32>> {
    match request {
        // Resolved when it was accepted.
        JobRequest::Sweep(sweep) => sweep.sweep.chain(&sweep.speeds.resolve().ok()?),
        JobRequest::ModalAnalysis(_) | JobRequest::ModelGeneration(_) | JobRequest::Study(_) => None,
    }
}

impl Engine {
    pub(super) fn new(
        store: Store,
        queue: QueueFile,
        (pool, importer, planner): (CpuPool, CpuPool, CpuPool),
        memory: Memory,
    ) -> Arc<Self> {
        let memory = Arc::new(memory);
        Arc::new(Self {
            reductions: Reductions::new(store.clone(), pool.clone(), Arc::clone(&memory)),
            calibrated: Calibrated::new(store.clone()),
            memory,
            store,
            queue,
            pool,
            importer,
            planner,
            counters: Counters::default(),
            new_preparation: Arc::default(),
            new_speeds: Arc::default(),
            stopping: Arc::default(),
            live: Mutex::default(),
            news: Arc::default(),
        })
    }

    /// The job, if it still wants work.
    pub(super) async fn live(&self, id: JobId) -> Result<Option<Arc<Live>>, Halt> {
        if self.stopping.load(Ordering::Relaxed) {
            return Err(Halt::NotWanted);
        }
        if let Some(live) = self.lock_live().get(&id) {
            return Ok(Some(Arc::clone(live)));
        }
        let Some(Job { request, status, speeds, .. }) = self.store.job(id).await? else { return Ok(None) };
        if status.is_final() {
            return Ok(None);
        }
        let watch = Watch::new(id, speeds.total, Arc::clone(&self.stopping), Arc::clone(&self.news));
        let chain = chain(&request);
        let live = Live { id, request, speeds: speeds.total, chain, watch };
        let live = Arc::clone(self.lock_live().entry(id).or_insert_with(|| Arc::new(live)));
        // A dismissal between the two lines above found nobody to tell.
        if self.store.job(id).await?.is_none_or(|job| job.status.is_final()) {
            self.forget(id);
            return Ok(None);
        }
        Ok(Some(live))
    }

    /// Gives a running job another request with so many `speeds`, at once in the store and in memory: tasks that begin from
    /// here on find it. What has begun goes on with the request it has, so both must mean the same for every speed that
    /// may be under way. Harmless to repeat.
    ///
    /// # Errors
    /// [`Halt::NotWanted`] if the job has ended, or has been given more speeds since.
    pub(super) async fn revise(
        &self,
        job: &Live,
        request: JobRequest,
        speeds: u32,
    ) -> Result<Arc<Live>, Halt> {
        let write = || self.store.revise_request(job.id, &request, speeds);
        if !once_there_is_room(&job.watch, write).await? {
            return Err(Halt::NotWanted);
        }
        let chain = chain(&request);
        let mut all = self.lock_live();
        let current = all.get_mut(&job.id).filter(|current| current.speeds <= speeds);
        let Some(current) = current else { return Err(Halt::NotWanted) };
        let revised = Live { id: job.id, request, speeds, chain, watch: Arc::clone(&current.watch) };
        *current = Arc::new(revised);
        current.watch.expect_speeds(speeds);
        Ok(Arc::clone(current))
    }

    /// Keeps the settings that were chosen for a job and goes on with the request that has them.
    pub(super) async fn choose(
        &self,
        job: &Live,
        request: JobRequest,
        choice: Chosen,
    ) -> Result<Arc<Live>, Halt> {
        once_there_is_room(&job.watch, || self.store.record_choice(job.id, &choice)).await?;
        self.revise(job, request, job.speeds).await
    }

    /// Stops all computations of a job that has become final and takes its waiting tasks out of the queue.
    pub(super) async fn retire(&self, id: JobId) {
        self.forget(id);
        if let Err(error) = self.queue.withdraw_speeds(id).await {
            // The tasks will find that their job is final.
            tracing::warn!(job.id = %id, %error, "could not withdraw the speeds of a job");
        }
    }

    /// Drops the job from memory and tells whoever still computes for it to stop.
    pub(super) fn forget(&self, id: JobId) {
        if let Some(live) = self.lock_live().remove(&id) {
            live.watch.dismiss();
        }
    }

    /// Records how a task of job `id` ended, if that matters.
    pub(super) async fn settle(&self, id: JobId, outcome: Result<(), Halt>) {
        let failure = match outcome {
            Ok(()) | Err(Halt::NotWanted) => return,
            Err(Halt::Failed(failure)) => failure,
            Err(Halt::Store(error)) if self.stopping.load(Ordering::Relaxed) => {
                // Connections end in any order now; the next start takes the job up again.
                tracing::warn!(job.id = %id, %error, "store failed while stopping");
                return;
            }
            Err(Halt::Store(error)) => Failure {
                cause: FailureCause::Storage,
                message: format!("the data folder failed: {error}"),
                violations: Vec::new(),
            },
        };
        if failure.cause == FailureCause::Refused {
            tracing::info!(job.id = %id, "refused: {}", failure.message);
        } else {
            tracing::error!(job.id = %id, cause = ?failure.cause, "job failed: {}", failure.message);
        }
        if let Err(error) = self.store.advance_job(id, JobStatus::Failed, Some(&failure)).await {
            // It stays unfinished and is tried again at the next start.
            tracing::error!(job.id = %id, %error, "could not record the failure of a job");
        }
        self.retire(id).await;
    }

    fn lock_live(&self) -> std::sync::MutexGuard<'_, HashMap<JobId, Arc<Live>>> {
        self.live.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
