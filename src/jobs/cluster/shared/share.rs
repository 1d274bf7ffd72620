//! Duties of a process, beside its tasks, where others share the database: it hears of what they do, ends what is not wanted any
//! more, and makes tasks again that were lost.

use std::sync::Arc;
use std::time::Duration;

use tokio::task::JoinHandle;

use super::tasks::SharedTasks;
use crate::jobs::computing::MOST_CRASHES;
use crate::jobs::engine::Engine;
use crate::jobs::error::{self, Interruption};
use crate::jobs::machine;
use crate::jobs::tasks::Tasks;
use crate::store::StoreError;
use crate::store::cluster::machines::WorkerProcess;
use crate::store::cluster::queue::Told;
use crate::store::jobs::{JobId, Unfinished};

/// Time between two looks for news that may not have been heard.
const BETWEEN_LOOKS: Duration = Duration::from_secs(2);

/// Looks after which lost tasks are made again and ended ones forgotten: every process does it, and one would be enough.
const LOOKS_BETWEEN_REPAIRS: u32 = 5;

/// Time between two announcements that this process computes.
const BETWEEN_ANNOUNCEMENTS: Duration = Duration::from_secs(10);

/// Starts hearing of news and looking for what was missed; if this process computes, announces it, too.
pub(super) fn start(engine: &Arc<Engine>, computes: bool) -> Vec<JoinHandle<()>> {
    let mut helpers = vec![tokio::spawn(hear(Arc::clone(engine))), tokio::spawn(look(Arc::clone(engine)))];
    if computes {
        helpers.push(tokio::spawn(announce(Arc::clone(engine))));
    }
    helpers
}

impl Engine {
    /// Jobs in memory.
    fn live_jobs(&self) -> Vec<JobId> {
        self.lock_live().keys().copied().collect()
    }

    /// Ends the computations of a job in memory that has ended or was paused elsewhere.
    async fn look_at(&self, id: JobId) {
        if !self.lock_live().contains_key(&id) {
            return;
        }
        if let Ok(found) = self.store.job_head(id).await
            && found.is_none_or(|job| !job.status.wants_work())
        {
            self.retire(id);
        }
    }
}

fn shared(engine: &Engine) -> Option<&SharedTasks> {
    match &engine.tasks {
        Tasks::Shared(tasks) => Some(tasks),
        Tasks::Own(_) => None,
    }
}

/// Hears of new tasks and of jobs that have changed, as long as the database can be reached, and again when it can.
async fn hear(engine: Arc<Engine>) {
    let Some(tasks) = shared(&engine) else { return };
    loop {
        if let Err(error) = hear_once(&engine, tasks).await {
            tracing::warn!(%error, "hears nothing of other processes; looking every {} s", BETWEEN_LOOKS.as_secs());
        }
        tokio::time::sleep(BETWEEN_LOOKS).await;
    }
}

async fn hear_once(engine: &Engine, tasks: &SharedTasks) -> Result<(), StoreError> {
    let mut news = tasks.queue().listen().await?;
    // News before this moment was not heard.
    tasks.wake();
    engine.store.changes().tell_all();
    while let Some(told) = news.next().await? {
        match told {
            Told::Tasks => tasks.wake(),
            Told::Job(job) => {
                engine.store.changes().tell(job);
                engine.look_at(job).await;
            }
        }
    }
    Ok(())
}

/// Announces to other processes which machine this process computes on.
async fn announce(engine: Arc<Engine>) {
    let Some(tasks) = shared(&engine) else { return };
    let mut interval = tokio::time::interval(BETWEEN_ANNOUNCEMENTS);
    interval.set_missed_tick_behavior(tokio::time::MissedTickBehavior::Delay);
    loop {
        interval.tick().await;
        let announced = async {
            let costs = engine.calibrated.get::<Interruption>(engine.planner.pool()).await?;
            let threads = engine.computing.threads() as u32;
            let worker = WorkerProcess { machine: machine::here(), costs: (*costs).clone(), threads };
            Ok::<_, Interruption>(tasks.announce(&worker).await?)
        };
        if let Err(error) = announced.await {
            tracing::debug!(?error, "could not say what this process computes on; trying again later");
        }
    }
}

/// Looks, now and then, for changes of jobs and lost tasks that were not announced.
async fn look(engine: Arc<Engine>) {
    let Some(tasks) = shared(&engine) else { return };
    let mut interval = tokio::time::interval(BETWEEN_LOOKS);
    interval.set_missed_tick_behavior(tokio::time::MissedTickBehavior::Delay);
    for look in 0u32.. {
        interval.tick().await;
        for job in engine.live_jobs() {
            engine.look_at(job).await;
        }
        if look % LOOKS_BETWEEN_REPAIRS == 0
            && let Err(error) = repair(&engine, tasks).await
        {
            tracing::warn!(%error, "could not look for lost tasks; trying again later");
        }
    }
}

async fn repair(engine: &Engine, tasks: &SharedTasks) -> Result<(), StoreError> {
    if !tasks.queue().has_other_revisions().await? {
        engine.store.restart_outdated().await?;
    }
    for Unfinished { id, crashes, .. } in engine.store.unfinished_jobs().await? {
        if crashes >= MOST_CRASHES {
            // Other jobs may have to be given up, too.
            let _ = engine.fail(id, &error::crashed(crashes)).await;
        }
    }
    for (id, owner) in tasks.queue().jobs_without_tasks().await? {
        if let Some(job) = JobId::parse(&id) {
            engine.tasks.prepare(&owner, job);
        }
    }
    tasks.queue().tell_who_waits().await?;
    tasks.queue().tidy().await
}
