//! Reduced sectors on demand: from memory, from the store, or computed, once, for whoever needs them.

use std::collections::{HashMap, VecDeque};
use std::sync::{Arc, Mutex, PoisonError};

use super::computing::Computing;
use super::error::Interruption;
use super::memory::Memory;
use super::patience::patiently;
use super::progress::PhaseMonitor;
use crate::analysis::error::AnalysisError;
use crate::analysis::monitor::Monitor;
use crate::analysis::run::{self, ReducedSector};
use crate::package::{self, Limits};
use crate::store::{Store, StoreError};

/// Reduced sectors kept in memory: tens of megabytes each at most, and jobs come in runs on the same model.
const KEPT: usize = 4;

/// A model and its accuracy dial.
type Key = (String, u32);

/// Reduced sectors on demand.
#[derive(Debug)]
pub(super) struct Reductions {
    store: Store,
    computing: Arc<Computing>,
    memory: Arc<Memory>,
    /// Most recently used last.
    recent: Mutex<VecDeque<(Key, Arc<ReducedSector>)>>,
    /// One lock per reduction that is being obtained: the second job to need it waits for the first.
    flights: Mutex<HashMap<Key, Arc<tokio::sync::Mutex<()>>>>,
}

impl Reductions {
    pub(super) fn new(store: Store, computing: Arc<Computing>, memory: Arc<Memory>) -> Self {
        Self { store, computing, memory, recent: Mutex::default(), flights: Mutex::default() }
    }

    /// The reduction of `model`; computes and stores it if there is none.
    pub(super) async fn get(
        &self,
        model: &str,
        modes_per_speed: u32,
        monitor: PhaseMonitor,
    ) -> Result<Arc<ReducedSector>, Interruption> {
        let key = (model.to_owned(), modes_per_speed);
        if let Some(reduced) = self.recall(&key) {
            return Ok(reduced);
        }
        let flight = {
            let mut flights = self.flights.lock().unwrap_or_else(PoisonError::into_inner);
            Arc::clone(flights.entry(key.clone()).or_default())
        };
        let guard = match flight.try_lock() {
            Ok(guard) => guard,
            Err(_) => {
                monitor.progress(0.0, "waiting for a reduction that is being made");
                flight.lock().await
            }
        };
        let result = self.obtain(&key, monitor).await;
        drop(guard);
        let mut flights = self.flights.lock().unwrap_or_else(PoisonError::into_inner);
        // Two handles are the map's and ours; more mean that somebody waits.
        if Arc::strong_count(&flight) <= 2 {
            flights.remove(&key);
        }
        result
    }

    /// The reduction of `model` if it has been computed.
    pub(super) async fn stored(
        &self,
        model: &str,
        modes_per_speed: u32,
    ) -> Result<Option<Arc<ReducedSector>>, StoreError> {
        let key = (model.to_owned(), modes_per_speed);
        if let Some(reduced) = self.recall(&key) {
            return Ok(Some(reduced));
        }
        let stored = self.store.reduction(model, modes_per_speed).await?;
        Ok(stored.map(|reduced| self.remember(&key, reduced)))
    }

    /// With the flight's lock held.
    async fn obtain(&self, key: &Key, monitor: PhaseMonitor) -> Result<Arc<ReducedSector>, Interruption> {
        if let Some(reduced) = self.recall(key) {
            return Ok(reduced);
        }
        if monitor.is_cancelled() {
            return Err(Interruption::NotWanted);
        }
        let (model, modes_per_speed) = (key.0.as_str(), key.1);
        if let Some(reduced) = self.store.reduction(model, modes_per_speed).await? {
            tracing::info!(model.id = model, modes_per_speed, "read the stored reduction");
            return Ok(self.remember(key, reduced));
        }
        let dofs = self.store.model(model, None).await?.map_or(0, |model| model.facts.own_dofs.into());
        monitor.progress(0.0, "waiting for memory that other jobs hold");
        let mut allowance = self.memory.claim(dofs).await;
        let mut outcome = self.reduce(key, &monitor, allowance.bytes).await?;
        if matches!(outcome, Err(AnalysisError::Memory { .. })) && !allowance.is_most() {
            // More than its size lets expect.
            drop(allowance);
            allowance = self.memory.claim_most().await;
            outcome = self.reduce(key, &monitor, allowance.bytes).await?;
        }
        drop(allowance);
        let reduced = outcome?;
        let job = monitor.watch().job();
        let write = || self.store.insert_reduction(job, model, modes_per_speed, &reduced);
        patiently(monitor.watch(), write).await?;
        self.computing.acquit(job);
        let wall_time_s = reduced.report.wall_time_s;
        tracing::info!(model.id = model, modes_per_speed, wall_time_s, "reduced");
        Ok(self.remember(key, reduced))
    }

    /// Computes a reduction within `memory_bytes`. The package is read anew each time: nobody who waits for memory may hold
    /// a whole sector.
    async fn reduce(
        &self,
        key: &Key,
        monitor: &PhaseMonitor,
        memory_bytes: Option<u64>,
    ) -> Result<Result<ReducedSector, AnalysisError>, Interruption> {
        if monitor.is_cancelled() {
            return Err(Interruption::NotWanted);
        }
        let (model, modes_per_speed) = (key.0.as_str(), key.1);
        tracing::info!(model.id = model, modes_per_speed, memory_bytes, "reducing");
        monitor.progress(0.0, "reading the package");
        let path = self.store.package_path(model);
        let watch = Arc::clone(monitor.watch());
        let (checkpoints, monitor) = (self.store.checkpoints(model, modes_per_speed), monitor.clone());
        let compute = move || {
            let package = package::read(&path, &Limits::default()).map_err(Interruption::stored_package)?;
            monitor.progress(0.0, "reducing");
            Ok(run::prepare(&package.sector, modes_per_speed, memory_bytes, &checkpoints, &monitor))
        };
        self.computing.run_parallel(&watch, compute).await?
    }

    fn recall(&self, key: &Key) -> Option<Arc<ReducedSector>> {
        let mut recent = self.recent.lock().unwrap_or_else(PoisonError::into_inner);
        let position = recent.iter().position(|(known, _)| known == key)?;
        let entry = recent.remove(position)?;
        let reduced = Arc::clone(&entry.1);
        recent.push_back(entry);
        Some(reduced)
    }

    fn remember(&self, key: &Key, reduced: ReducedSector) -> Arc<ReducedSector> {
        let reduced = Arc::new(reduced);
        let mut recent = self.recent.lock().unwrap_or_else(PoisonError::into_inner);
        recent.push_back((key.clone(), Arc::clone(&reduced)));
        if recent.len() > KEPT {
            recent.pop_front();
        }
        reduced
    }
}
