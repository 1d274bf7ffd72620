//! Trial runs that a job compares: each from the store, or run and stored.

use std::collections::HashMap;
use std::sync::Arc;

use futures::{StreamExt, TryStreamExt, stream};

use super::engine::{Engine, Live};
use super::error::Interruption;
use super::patience::patiently;
use super::progress::PhaseMonitor;
use crate::analysis::run::{self, Trial, TrialRequest};
use crate::store::StoreError;
use crate::store::trials::key;

/// Trials at hand, by key.
#[derive(Debug, Default)]
pub(super) struct Trials(HashMap<String, Trial>);

impl Trials {
    /// Trial of `request`, if it is at hand.
    pub(super) fn get(&self, request: &TrialRequest) -> Option<&Trial> {
        self.0.get(&key(request).ok()?)
    }

    /// Takes those of `requests` that are stored; returns false if one is not.
    pub(super) async fn recall(
        &mut self,
        engine: &Engine,
        requests: &[TrialRequest],
    ) -> Result<bool, StoreError> {
        for request in requests {
            let key = key(request)?;
            match engine.store.trial(&key).await? {
                Some(trial) => self.0.insert(key, trial),
                None => return Ok(false),
            };
        }
        Ok(true)
    }

    /// Takes `requests` for `job`; those not stored run side by side. `done` hears how many are there. No more of them are out than
    /// there are threads: other jobs get their turn in between.
    pub(super) async fn obtain(
        &mut self,
        engine: &Engine,
        job: &Live,
        requests: Vec<TrialRequest>,
        done: impl Fn(usize),
    ) -> Result<(), Interruption> {
        let mut running = stream::iter(requests)
            .map(|request| obtain(engine, job, request))
            .buffer_unordered(engine.computing.threads());
        let mut count = 0;
        while let Some((key, trial)) = running.try_next().await? {
            self.0.insert(key, trial);
            count += 1;
            done(count);
        }
        Ok(())
    }
}

async fn obtain(engine: &Engine, job: &Live, request: TrialRequest) -> Result<(String, Trial), Interruption> {
    let key = key(&request)?;
    if let Some(trial) = engine.store.trial(&key).await? {
        return Ok((key, trial));
    }
    let (model, modes) = (request.sweep().model().to_owned(), request.sweep().modes_per_speed());
    let monitor = PhaseMonitor::uncounted(job.watch.clone());
    let reduced = engine.reductions.of_sweep(request.sweep(), monitor.clone()).await?;
    let asked = (Arc::clone(&reduced), request.clone());
    let bytes = engine.computing.run(&job.watch, move || run::trial_memory(&asked.0, &asked.1)).await?;
    let memory = engine.memory.hold(bytes).await.map_err(Interruption::speed_memory)?;
    let compute = move || {
        let _memory = memory;
        run::run_trial(&reduced, &request, &monitor)
    };
    let trial = engine.computing.run(&job.watch, compute).await??;
    patiently(&job.watch, || engine.store.insert_trial(job.id, &key, &model, &trial)).await?;
    engine.computing.acquit(job.id);
    tracing::debug!(job.id = %job.id, modes, steps = trial.point.steps, status = ?trial.point.status, "trial run");
    Ok((key, trial))
}
