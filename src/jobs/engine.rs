//! State that all tasks of jobs share.

use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use tokio::sync::Notify;

use super::calibration::Calibrated;
use super::computing::Computing;
use super::counters::Counters;
use super::error::{self, Interruption};
use super::patience::{BETWEEN_ATTEMPTS, patiently};
use super::planner::Planner;
use super::progress::{PendingReports, PhaseMonitor, Watch};
use super::reductions::Reductions;
use super::tasks::{Tasks, Whose};
use crate::analysis::kinds::kind::ResolvedJob;
use crate::analysis::monitor::Monitor;
use crate::analysis::result::Chosen;
use crate::import::Importer;
use crate::memory::Memory;
use crate::pool::CpuPool;
use crate::store::jobs::{Failure, FailureCause, Job, JobHead, JobId};
use crate::store::limits::Limits;
use crate::store::status::JobStatus;
use crate::store::{Store, StoreError};

/// Time that a job waits for the package of its model to be put back.
const MISSING_PACKAGE: Duration = Duration::from_secs(600);

/// State that all tasks of jobs share.
#[derive(Debug)]
pub(super) struct Engine {
    pub(super) store: Store,
    pub(super) tasks: Tasks,
    pub(super) computing: Arc<Computing>,
    /// Importer of model packages.
    pub(super) importer: Arc<Importer>,
    /// Threads that make plans, which are wanted at once.
    pub(super) planner: Planner,
    pub(super) reductions: Reductions,
    pub(super) calibrated: Calibrated,
    /// Memory that all computations may take together.
    pub(super) memory: Arc<Memory>,
    pub(super) counters: Counters,
    /// Limits on what one owner may have.
    pub(super) limits: Limits,
    /// Notification that a job was deleted, whose room can be given back.
    pub(super) deleted: Notify,
    /// Flag set when the service stops: computations end, their jobs stay as they are.
    pub(super) stopping: Arc<AtomicBool>,
    live: Mutex<HashMap<JobId, Arc<Live>>>,
    /// Progress of all jobs, to be stored.
    pub(super) reports: Arc<PendingReports>,
}

/// An unfinished job in memory.
#[derive(Debug)]
pub(super) struct Live {
    pub(super) id: JobId,
    pub(super) owner: String,
    pub(super) request: Arc<dyn ResolvedJob>,
    pub(super) speeds: u32,
    /// Speeds of the job in the order in which each starts from the end of the one before; `None` where each is on its own.
    pub(super) chain: Option<Vec<u32>>,
    /// Memory in bytes that a speed holds while it runs, once that is planned.
    pub(super) speed_bytes: AtomicU64,
    pub(super) watch: Arc<Watch>,
}

impl Live {
    /// Owner and id of the job, by which its tasks are queued.
    pub(super) fn whose(&self) -> Whose<'_> {
        Whose { owner: &self.owner, job: self.id, one_kind: self.request.is_of_one_kind() }
    }

    /// Neighbours of `speed` in the chain: the speed before and the one after, where there are such.
    pub(super) fn neighbours(&self, speed: u32) -> (Option<u32>, Option<u32>) {
        let Some(chain) = &self.chain else { return (None, None) };
        let at = |place: Option<usize>| place.and_then(|place| chain.get(place)).copied();
        let place = chain.iter().position(|&link| link == speed);
        (at(place.and_then(|place| place.checked_sub(1))), at(place.map(|place| place + 1)))
    }
}

impl Engine {
    pub(super) fn new(
        store: Store,
        tasks: Tasks,
        pool: CpuPool,
        planner: CpuPool,
        importer: Arc<Importer>,
        memory: Arc<Memory>,
        limits: Limits,
    ) -> Arc<Self> {
        let computing = Arc::new(Computing::new(store.clone(), pool));
        Arc::new(Self {
            reductions: Reductions::new(store.clone(), Arc::clone(&computing), Arc::clone(&memory)),
            calibrated: Calibrated::new(store.clone()),
            memory,
            limits,
            reports: Arc::new(PendingReports::new(store.changes().clone())),
            store,
            tasks,
            computing,
            importer,
            planner: Planner::new(planner),
            deleted: Notify::new(),
            counters: Counters::default(),
            stopping: Arc::default(),
            live: Mutex::default(),
        })
    }

    /// Job in memory, if it still wants work.
    pub(super) async fn live(&self, id: JobId) -> Result<Option<Arc<Live>>, Interruption> {
        if self.stopping.load(Ordering::Relaxed) {
            return Err(Interruption::NotWanted);
        }
        let known = self.lock_live().get(&id).cloned();
        // Where others work on the job, they may have given it other settings or more speeds.
        if known.is_some() && !self.tasks.are_shared() {
            return Ok(known);
        }
        let Some(Job { head, request, plan, .. }) = self.store.job(id).await? else {
            self.forget(id);
            return Ok(None);
        };
        let JobHead { owner, status, speeds, .. } = head;
        if !status.wants_work() {
            self.forget(id);
            return Ok(None);
        }
        // A job that was paused since and goes on has another watch.
        let watch = known.map(|live| Arc::clone(&live.watch)).filter(|watch| !watch.is_cancelled());
        let watch = watch.unwrap_or_else(|| {
            Watch::new(id, speeds.total, Arc::clone(&self.stopping), Arc::clone(&self.reports))
        });
        watch.expect_speeds(speeds.total);
        let chain = request.chain();
        let speed_bytes = AtomicU64::new(plan.map_or(0, |plan| plan.speed_memory_bytes));
        let live = Live { id, owner, request, speeds: speeds.total, chain, speed_bytes, watch };
        let live = self.keep(live);
        // A dismissal or a pause between the two lines above found nobody to tell.
        if self.store.job_head(id).await?.is_none_or(|job| !job.status.wants_work()) {
            self.forget(id);
            return Ok(None);
        }
        Ok(Some(live))
    }

    /// Keeps a job in memory, unless another task was faster; a newer job takes the place of one that other processes may have changed.
    fn keep(&self, live: Live) -> Arc<Live> {
        let mut all = self.lock_live();
        let kept = all.entry(live.id);
        let live = match &kept {
            Entry::Occupied(known) if !self.tasks.are_shared() => return Arc::clone(known.get()),
            // The watch tells running tasks that they have the older job.
            Entry::Occupied(known) if !known.get().watch.is_cancelled() => {
                Live { watch: Arc::clone(&known.get().watch), ..live }
            }
            Entry::Occupied(_) => live,
            Entry::Vacant(_) => live,
        };
        let kept = kept.insert_entry(Arc::new(live));
        Arc::clone(kept.get())
    }

    /// Gives a running job another request with so many `speeds`, at once in the store and in memory: tasks that begin from
    /// here on find it. What has begun goes on with the request it has, so both must mean the same for every speed that
    /// may be under way. Harmless to repeat.
    ///
    /// # Errors
    /// [`Interruption::NotWanted`] if the job has ended, or has been given more speeds since.
    pub(super) async fn revise(
        &self,
        job: &Live,
        request: Arc<dyn ResolvedJob>,
        speeds: u32,
    ) -> Result<Arc<Live>, Interruption> {
        let write = || self.store.revise_request(job.id, &*request, speeds);
        if !patiently(&job.watch, write).await? {
            return Err(Interruption::NotWanted);
        }
        let chain = request.chain();
        let mut all = self.lock_live();
        let current = all.get_mut(&job.id).filter(|current| current.speeds <= speeds);
        let Some(current) = current else { return Err(Interruption::NotWanted) };
        let owner = job.owner.clone();
        let speed_bytes = AtomicU64::new(current.speed_bytes.load(Ordering::Relaxed));
        let watch = Arc::clone(&current.watch);
        let revised = Live { id: job.id, owner, request, speeds, chain, speed_bytes, watch };
        *current = Arc::new(revised);
        current.watch.expect_speeds(speeds);
        Ok(Arc::clone(current))
    }

    /// Stores the settings that were chosen for a job and goes on with the request that has them.
    pub(super) async fn choose(
        &self,
        job: &Live,
        request: Arc<dyn ResolvedJob>,
        choice: Chosen,
    ) -> Result<Arc<Live>, Interruption> {
        patiently(&job.watch, || self.store.record_choice(job.id, &choice)).await?;
        self.revise(job, request, job.speeds).await
    }

    /// Stops all computations of a job that has ended or is paused, and drops its waiting tasks.
    pub(super) fn retire(&self, id: JobId) {
        self.tasks.withdraw(id);
        self.computing.acquit(id);
        self.forget(id);
    }

    /// Drops the job from memory and tells whoever still computes for it to stop.
    pub(super) fn forget(&self, id: JobId) {
        if let Some(live) = self.lock_live().remove(&id) {
            live.watch.dismiss();
        }
    }

    /// Works on a task of job `id` to its end, and records its failure. While the store fails for a time, the task is
    /// begun again and again; what it has finished before, it finds stored. Returns whether the task was wanted to the
    /// end.
    pub(super) async fn attend<T>(&self, id: JobId, mut task: impl FnMut() -> T) -> bool
    where
        T: Future<Output = Result<(), Interruption>>,
    {
        let mut missing_since = None;
        let mut warned = false;
        loop {
            let outcome = match task().await {
                Ok(()) => return true,
                Err(Interruption::NotWanted) => return false,
                Err(Interruption::Failed(failure)) => Ok(failure),
                Err(Interruption::Store(error))
                    if error.is_missing_package()
                        && missing_since.get_or_insert_with(Instant::now).elapsed() > MISSING_PACKAGE =>
                {
                    Ok(error::lost_package())
                }
                Err(Interruption::Store(error)) if error.may_pass() => Err(error),
                Err(Interruption::Store(error)) => {
                    tracing::error!(job.id = %id, %error, "the store failed");
                    Ok(error::unreadable())
                }
            };
            let outcome = match outcome {
                Ok(failure) => self.fail(id, &failure).await,
                Err(error) => Err(error),
            };
            let Err(error) = outcome else { return true };
            if self.stopping.load(Ordering::Relaxed) {
                // The next start takes the job up again.
                return true;
            }
            if !warned {
                tracing::error!(job.id = %id, %error, "a job waits until the storage works again");
                warned = true;
            }
            self.tell(id, error::waiting_for(&error));
            tokio::time::sleep(BETWEEN_ATTEMPTS).await;
        }
    }

    /// Prepares a job again that wants work though its computations were just told to stop: a job that was paused and goes on drops
    /// what is under way, and what was under way is not begun a second time. Shared tasks are missed by those who look for jobs without
    /// any.
    pub(super) async fn take_up_again(&self, id: JobId) {
        if self.tasks.are_shared() || self.stopping.load(Ordering::Relaxed) {
            return;
        }
        match self.store.job_head(id).await {
            Ok(Some(job)) if job.status.wants_work() => self.tasks.prepare(&job.owner, id),
            Ok(_) => {}
            Err(error) => tracing::warn!(job.id = %id, %error, "could not see whether the job goes on"),
        }
    }

    /// Phase of a job: what it does or waits for now, if it has reported that.
    pub(super) fn phase(&self, id: JobId) -> Option<String> {
        let live = self.lock_live().get(&id).cloned()?;
        live.watch.phase()
    }

    /// Shows what a job waits for.
    fn tell(&self, id: JobId, phase: &str) {
        if let Some(live) = self.lock_live().get(&id) {
            PhaseMonitor::uncounted(Arc::clone(&live.watch)).progress(0.0, phase);
        }
    }

    /// Records that a job has failed.
    pub(super) async fn fail(&self, id: JobId, failure: &Failure) -> Result<(), StoreError> {
        if failure.cause == FailureCause::Refused {
            tracing::info!(job.id = %id, "refused: {}", failure.message);
        } else {
            tracing::error!(job.id = %id, cause = ?failure.cause, "job failed: {}", failure.message);
        }
        self.store.advance_job(id, JobStatus::Failed, Some(failure)).await?;
        self.retire(id);
        // The job may have been paused before, and go on.
        self.take_up_again(id).await;
        Ok(())
    }

    pub(super) fn lock_live(&self) -> std::sync::MutexGuard<'_, HashMap<JobId, Arc<Live>>> {
        self.live.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
