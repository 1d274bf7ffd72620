//! Reduced sectors on demand: from memory, from the store, or computed, once, for whoever needs them.

use std::collections::{HashMap, VecDeque};
use std::sync::{Arc, Mutex, PoisonError};

use super::bending;
use super::computing::Computing;
use super::error::Interruption;
use super::euler_load;
use super::patience::{BETWEEN_ATTEMPTS, patiently, until_written};
use super::progress::PhaseMonitor;
use super::static_wheel::{self, StaticWheelError};
use super::stress::Making;
use crate::analysis::error::AnalysisError;
use crate::analysis::kinds::kind::Reduction;
use crate::analysis::monitor::Monitor;
use crate::analysis::resolved::ResolvedSweep;
use crate::analysis::run::{self, ReducedSector};
use crate::analysis::tip_growth::TipGrowth;
use crate::dynamics::kept_rows::KeptRows;
use crate::dynamics::node_rows::NodeRows;
use crate::dynamics::nodes::SectorNode;
use crate::memory::Memory;
use crate::package::{self, Limits};
use crate::store::checkpoints::CheckpointFolder;
use crate::store::cluster::claims::Claim;
use crate::store::cluster::queue::SharedQueue;
use crate::store::{Store, StoreError};

/// Reduced sectors kept in memory: tens of megabytes each at most, and jobs come in runs on the same model.
const KEPT: usize = 4;

/// Id of a model and its modes per speed, the accuracy dial.
type Key = (String, u32);

/// Data wanted beside a reduction.
#[derive(Debug, Default)]
struct Beside {
    /// Ids of the nodes to be read.
    nodes: Vec<u64>,
    /// Radius about the contact nodes outside which stress is wanted.
    stress_outside: Option<f64>,
    /// Whether the growth of the tips is wanted.
    growth: bool,
    /// Whether the Euler force is wanted.
    euler_force: bool,
    /// Number of coordinates in which second-order bending is wanted.
    bending: Option<u32>,
    /// Whether rows of the basis at all nodes are wanted: they must be there, must not, or, with `None`, are stored if it reduces.
    fields: Option<bool>,
}

impl Beside {
    /// Whether the basis itself must be there.
    fn needs_basis(&self) -> bool {
        self.fields == Some(true) || self.bending.is_some()
    }

    /// Whether `reduced` has all that is wanted.
    fn is_of(&self, reduced: &ReducedSector) -> bool {
        let tells = self.stress_outside.is_none_or(|radius| reduced.tells_stress(radius));
        let grows = reduced.growth.is_some() || !self.growth;
        let pushes = reduced.euler_load.is_some() || !self.euler_force;
        let bends = self.bending.is_none_or(|coordinates| reduced.bends_in(coordinates));
        tells
            && grows
            && pushes
            && bends
            && reduced.reads(&self.nodes)
            && (reduced.has_basis || !self.needs_basis())
    }
}

/// Reduced sectors on demand.
#[derive(Debug)]
pub(super) struct Reductions {
    store: Store,
    computing: Arc<Computing>,
    memory: Arc<Memory>,
    /// Reductions in memory, the most recently used last.
    recent: Mutex<VecDeque<(Key, Arc<ReducedSector>)>>,
    /// Locks, one for each reduction that is being obtained: the second job to need it waits for the first.
    flights: Mutex<HashMap<Key, Arc<tokio::sync::Mutex<()>>>>,
}

impl Reductions {
    pub(super) fn new(store: Store, computing: Arc<Computing>, memory: Arc<Memory>) -> Self {
        Self { store, computing, memory, recent: Mutex::default(), flights: Mutex::default() }
    }

    /// Reduction of `model`, computed and stored if there is none. `fields` are rows of its basis: they must be beside it, must not,
    /// or are stored if it is computed.
    pub(super) async fn get(
        &self,
        (model, modes_per_speed): (&str, u32),
        fields: Option<bool>,
        monitor: PhaseMonitor,
    ) -> Result<Arc<ReducedSector>, Interruption> {
        self.reading(model, modes_per_speed, &Beside { fields, ..Beside::default() }, monitor).await
    }

    /// Reduction that a job of one computation rests on, with the bending of second order where that is wanted.
    pub(super) async fn of_once(
        &self,
        wanted: Reduction<'_>,
        monitor: PhaseMonitor,
    ) -> Result<Arc<ReducedSector>, Interruption> {
        let Reduction { model, modes_per_speed, fields, bending } = wanted;
        self.reading(model, modes_per_speed, &Beside { fields, bending, ..Beside::default() }, monitor).await
    }

    /// Reduction that `sweep` runs on, with rows of its basis at the nodes of its sensors and the stress that it records.
    pub(super) async fn of_sweep(
        &self,
        sweep: &ResolvedSweep,
        monitor: PhaseMonitor,
    ) -> Result<Arc<ReducedSector>, Interruption> {
        self.of_case(sweep, sweep.fields(), monitor).await
    }

    /// Reduction that `sweep` runs on, with other wishes for rows of its basis.
    pub(super) async fn of_case(
        &self,
        sweep: &ResolvedSweep,
        fields: Option<bool>,
        monitor: PhaseMonitor,
    ) -> Result<Arc<ReducedSector>, Interruption> {
        self.with_beside(sweep, Beside { fields, ..Beside::default() }, monitor).await
    }

    /// Reduction that legs are computed on, whose scene is a `sweep`; with the Euler force where that acts.
    pub(super) async fn of_legs(
        &self,
        sweep: &ResolvedSweep,
        euler_force: bool,
        monitor: PhaseMonitor,
    ) -> Result<Arc<ReducedSector>, Interruption> {
        let beside = Beside { fields: sweep.fields(), euler_force, ..Beside::default() };
        self.with_beside(sweep, beside, monitor).await
    }

    /// Reduction with the data `beside` it and all that `sweep` itself wants, too.
    async fn with_beside(
        &self,
        sweep: &ResolvedSweep,
        beside: Beside,
        monitor: PhaseMonitor,
    ) -> Result<Arc<ReducedSector>, Interruption> {
        let beside = Beside {
            nodes: sweep.sensor_nodes(),
            stress_outside: sweep.stress_outside(),
            growth: sweep.has_cold_clearances(),
            bending: sweep.bending_coordinates(),
            ..beside
        };
        self.reading(sweep.model(), sweep.modes_per_speed(), &beside, monitor).await
    }

    async fn reading(
        &self,
        model: &str,
        modes_per_speed: u32,
        beside: &Beside,
        monitor: PhaseMonitor,
    ) -> Result<Arc<ReducedSector>, Interruption> {
        let key = (model.to_owned(), modes_per_speed);
        if let Some(reduced) = self.recall(&key, beside) {
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
        let result = self.alone(&key, beside, monitor).await;
        drop(guard);
        let mut flights = self.flights.lock().unwrap_or_else(PoisonError::into_inner);
        // Two handles are the map's and ours; more mean that another job waits.
        if Arc::strong_count(&flight) <= 2 {
            flights.remove(&key);
        }
        result
    }

    /// Reduction of `model`, if it has been computed.
    pub(super) async fn stored(
        &self,
        model: &str,
        modes_per_speed: u32,
    ) -> Result<Option<Arc<ReducedSector>>, StoreError> {
        let key = (model.to_owned(), modes_per_speed);
        if let Some(reduced) = self.recall(&key, &Beside::default()) {
            return Ok(Some(reduced));
        }
        let stored = self.read(&key).await?;
        Ok(stored.map(|reduced| self.remember(&key, reduced)))
    }

    /// Drops a reduction from memory whose basis could not be read, so that whoever needs it reads it again.
    pub(super) fn forget(&self, model: &str, modes_per_speed: u32) {
        let mut recent = self.recent.lock().unwrap_or_else(PoisonError::into_inner);
        recent.retain(|((of, modes), _)| of != model || *modes != modes_per_speed);
    }

    /// Reads the stored reduction, with the tip thickness of the model.
    async fn read(&self, key: &Key) -> Result<Option<ReducedSector>, StoreError> {
        let Some(mut reduced) = self.store.reduction(&key.0, key.1).await? else { return Ok(None) };
        reduced.tip_thickness = self.tip_thickness(&key.0).await?;
        Ok(Some(reduced))
    }

    async fn tip_thickness(&self, model: &str) -> Result<Option<f64>, StoreError> {
        let model = self.store.model(model, None).await?;
        Ok(model.and_then(|model| model.facts.mesh?.tip_thickness))
    }

    /// Obtains a reduction with the flight's lock held. A reduction that is not there yet is made by one process at a time.
    async fn alone(
        &self,
        key: &Key,
        beside: &Beside,
        monitor: PhaseMonitor,
    ) -> Result<Arc<ReducedSector>, Interruption> {
        let _claim = match self.store.shared_queue() {
            Some(queue) => self.claim(queue, key, &monitor).await?,
            None => None,
        };
        self.obtain(key, beside, monitor).await
    }

    /// Claims the right to make a reduction, once no other process does; `None` where it has been made meanwhile.
    async fn claim(
        &self,
        queue: &SharedQueue,
        (model, modes_per_speed): &Key,
        monitor: &PhaseMonitor,
    ) -> Result<Option<Claim>, Interruption> {
        let name = format!("reduction {model} {modes_per_speed}");
        while !self.store.has_reduction(model, *modes_per_speed).await? {
            if let Some(claim) = queue.claim(&name).await? {
                return Ok(Some(claim));
            }
            if monitor.is_cancelled() {
                return Err(Interruption::NotWanted);
            }
            monitor.progress(0.0, "waiting for a reduction that is being made");
            tokio::time::sleep(BETWEEN_ATTEMPTS).await;
        }
        Ok(None)
    }

    /// Obtains a reduction with the flight's lock held: from memory, from the store, or computed.
    async fn obtain(
        &self,
        key: &Key,
        beside: &Beside,
        monitor: PhaseMonitor,
    ) -> Result<Arc<ReducedSector>, Interruption> {
        if let Some(reduced) = self.recall(key, beside) {
            return Ok(reduced);
        }
        if monitor.is_cancelled() {
            return Err(Interruption::NotWanted);
        }
        let (model, modes_per_speed) = (key.0.as_str(), key.1);
        let nodes = self.nodes(model, &beside.nodes, &monitor).await?;
        let known = match self.recall(key, &Beside::default()) {
            Some(reduced) => Some(ReducedSector::clone(&reduced)),
            None => self.read(key).await?,
        };
        if let Some(mut reduced) = known {
            tracing::info!(model.id = model, modes_per_speed, "read the stored reduction");
            match self.beside(key, &mut reduced, &nodes, beside, &monitor).await? {
                Ok(()) => return Ok(self.remember(key, reduced)),
                // Reducing again would not help.
                Err(error) if StoreError::may_pass_of(&error) => {
                    return Err(StoreError::File(error).into());
                }
                Err(error) => {
                    tracing::warn!(model.id = model, modes_per_speed, %error, "the basis of the stored reduction cannot be read; reducing again");
                }
            }
        }
        // Stress of other jobs is read again, if they go on; a reduction wants its memory.
        self.let_stress_go();
        let facts = self.store.model(model, None).await?.map(|model| model.facts);
        let needs_basis = beside.needs_basis() || beside.stress_outside.is_some() || beside.euler_force;
        if let Some(facts) = facts.as_ref().filter(|_| needs_basis) {
            // Checked before hours of computing end in nothing that can be used.
            let room = run::most_basis_bytes(facts, modes_per_speed);
            self.store.basis(model, modes_per_speed).expect_room(room).map_err(StoreError::File)?;
        }
        let dofs = facts.map_or(0, |facts| facts.own_dofs.into());
        monitor.progress(0.0, "waiting for memory that other jobs hold");
        let mut allowance = self.memory.claim(dofs).await;
        let mut checkpoints = self.store.checkpoints(model, modes_per_speed);
        if beside.fields == Some(false) {
            checkpoints = checkpoints.without_basis();
        }
        let parts = (&checkpoints, &nodes);
        let mut outcome = self.reduce(key, parts, &monitor, allowance.bytes).await?;
        if matches!(outcome, Err(AnalysisError::Memory { .. })) && !allowance.is_most() {
            // The reduction needs more memory than its size lets expect.
            drop(allowance);
            allowance = self.memory.claim_most().await;
            outcome = self.reduce(key, parts, &monitor, allowance.bytes).await?;
        }
        drop(allowance);
        let mut reduced = outcome?;
        reduced.tip_thickness = self.tip_thickness(model).await?;
        let job = monitor.watch().job();
        let share = || self.store.share_basis(model, modes_per_speed, &reduced.wheel);
        until_written(monitor.watch(), share).await?;
        let write = || self.store.insert_reduction(job, model, modes_per_speed, &reduced);
        patiently(monitor.watch(), write).await?;
        self.computing.acquit(job);
        let wall_time_s = reduced.report.wall_time_s;
        tracing::info!(model.id = model, modes_per_speed, wall_time_s, "reduced");
        match checkpoints.kept_basis() {
            Ok(kept) => reduced.has_basis = kept,
            Err(error) if needs_basis => return Err(StoreError::File(error).into()),
            Err(_) => {}
        }
        if beside.stress_outside.is_some() {
            let made = self.stress(key, &mut reduced, beside, &monitor).await?;
            made.map_err(|error| Interruption::Store(StoreError::File(error)))?;
        }
        self.growth(key, &mut reduced, beside, &monitor).await?;
        let pushed = self.euler_load(key, &mut reduced, beside, &monitor).await?;
        pushed.map_err(|error| Interruption::Store(StoreError::File(error)))?;
        let bent = self.bending(key, &mut reduced, beside, &monitor).await?;
        bent.map_err(|error| Interruption::Store(StoreError::File(error)))?;
        Ok(self.remember(key, reduced))
    }

    /// Adds to `reduced` what is wanted beside it, from the files of its basis.
    async fn beside(
        &self,
        key: &Key,
        reduced: &mut ReducedSector,
        nodes: &Arc<[SectorNode]>,
        beside: &Beside,
        monitor: &PhaseMonitor,
    ) -> Result<std::io::Result<()>, Interruption> {
        if !reduced.reads(&beside.nodes) {
            match self.rows(key, reduced, nodes, monitor).await? {
                Ok(rows) => reduced.nodes = rows,
                Err(error) => return Ok(Err(error)),
            }
        }
        if beside.needs_basis() && !reduced.has_basis {
            let (basis, wheel) = (self.store.basis(&key.0, key.1), Arc::clone(&reduced.wheel));
            if let Err(error) = self.computing.run(monitor.watch(), move || basis.check(&wheel)).await? {
                return Ok(Err(error));
            }
            reduced.has_basis = true;
        }
        if let Err(error) = self.euler_load(key, reduced, beside, monitor).await? {
            return Ok(Err(error));
        }
        if let Err(error) = self.bending(key, reduced, beside, monitor).await? {
            return Ok(Err(error));
        }
        let stress = self.stress(key, reduced, beside, monitor).await?;
        if stress.is_ok() {
            self.growth(key, reduced, beside, monitor).await?;
        }
        Ok(stress)
    }

    /// Adds to `reduced` the growth of its tips, if that is wanted; solves for it if it is not there.
    async fn growth(
        &self,
        (model, modes_per_speed): &Key,
        reduced: &mut ReducedSector,
        beside: &Beside,
        monitor: &PhaseMonitor,
    ) -> Result<(), Interruption> {
        if !beside.growth || reduced.growth.is_some() {
            return Ok(());
        }
        let dofs = self.store.model(model, None).await?.map_or(0, |model| model.facts.own_dofs.into());
        monitor.progress(0.0, "waiting for memory that other jobs hold");
        let _memory = self.memory.claim(dofs).await;
        let package = self.store.package(model).await?;
        let basis = self.store.basis(model, *modes_per_speed);
        let (wheel, watched) = (Arc::clone(&reduced.wheel), monitor.clone());
        let solve = move || {
            let watch = |share: f64, phase: &str| {
                watched.progress(share, phase);
                !watched.is_cancelled()
            };
            let fixed = static_wheel::from_package(&package, (&basis, &wheel), &watch)?;
            Ok::<_, StaticWheelError>(fixed.map(|fixed| TipGrowth::of(&fixed, &wheel.contact)))
        };
        let growth = self.computing.run_parallel(monitor.watch(), solve).await??;
        reduced.growth = growth.map(Arc::new);
        Ok(())
    }

    /// Adds to `reduced` the Euler force, if that is wanted, from its mesh and the basis of nodal diameter 0.
    async fn euler_load(
        &self,
        (model, modes_per_speed): &Key,
        reduced: &mut ReducedSector,
        beside: &Beside,
        monitor: &PhaseMonitor,
    ) -> Result<std::io::Result<()>, Interruption> {
        if !beside.euler_force || reduced.euler_load.is_some() {
            return Ok(Ok(()));
        }
        monitor.progress(0.0, "Euler force of the mesh");
        let package = self.store.package(model).await?;
        let basis = self.store.basis(model, *modes_per_speed);
        let wheel = Arc::clone(&reduced.wheel);
        let read = move || euler_load::from_package(&package, (&basis, &wheel));
        let read = self.computing.run(monitor.watch(), read).await??;
        Ok(read.map(|load| reduced.euler_load = Some(Arc::new(load))))
    }

    /// Adds to `reduced` the bending of second order, if it is wanted; makes it from the mesh and the basis.
    async fn bending(
        &self,
        (model, modes_per_speed): &Key,
        reduced: &mut ReducedSector,
        beside: &Beside,
        monitor: &PhaseMonitor,
    ) -> Result<std::io::Result<()>, Interruption> {
        let Some(coordinates) = beside.bending.filter(|&wanted| !reduced.bends_in(wanted)) else {
            return Ok(Ok(()));
        };
        let making = bending::Making {
            package: self.store.package(model).await?,
            basis: self.store.basis(model, *modes_per_speed),
            wheel: Arc::clone(&reduced.wheel),
            coordinates: coordinates as usize,
            memory: Arc::clone(&self.memory),
            monitor: monitor.clone(),
        };
        let made = bending::make(&self.computing, making).await?;
        Ok(made.map(|made| reduced.bending = Some(Arc::new(made))))
    }

    /// Adds to `reduced` the stress that is wanted, if any is; makes it if it is not there.
    async fn stress(
        &self,
        key: &Key,
        reduced: &mut ReducedSector,
        beside: &Beside,
        monitor: &PhaseMonitor,
    ) -> Result<std::io::Result<()>, Interruption> {
        let Some(radius) = beside.stress_outside.filter(|&radius| !reduced.tells_stress(radius)) else {
            return Ok(Ok(()));
        };
        let (model, modes_per_speed) = (key.0.as_str(), key.1);
        let dofs = self.store.model(model, None).await?.map_or(0, |model| model.facts.own_dofs.into());
        self.let_stress_go();
        monitor.progress(0.0, "waiting for memory that other jobs hold");
        let _memory = self.memory.claim(dofs).await;
        let making = Making {
            package: self.store.package(model).await?,
            basis: self.store.basis(model, modes_per_speed),
            wheel: Arc::clone(&reduced.wheel),
            excluded_radius: radius,
            monitor: monitor.clone(),
        };
        let made = self.computing.run_parallel(monitor.watch(), move || making.stress()).await??;
        Ok(made.map(|stress| reduced.stress = Some(Arc::new(stress))))
    }

    /// Drops reductions with stress from memory: it takes much.
    fn let_stress_go(&self) {
        let mut recent = self.recent.lock().unwrap_or_else(PoisonError::into_inner);
        recent.retain(|(_, reduced)| reduced.stress.is_none());
    }

    /// Nodes of `model` with these ids, without contact nodes, which every reduction reads.
    async fn nodes(
        &self,
        model: &str,
        ids: &[u64],
        monitor: &PhaseMonitor,
    ) -> Result<Arc<[SectorNode]>, Interruption> {
        if ids.is_empty() {
            return Ok(Arc::default());
        }
        let (path, ids) = (self.store.package(model).await?, ids.to_vec());
        let read = move || package::read_nodes(&path, &Limits::default());
        let mut nodes =
            self.computing.run(monitor.watch(), read).await?.map_err(Interruption::stored_package)?;
        nodes.retain(|node| node.contact.is_none() && ids.binary_search(&node.id).is_ok());
        Ok(nodes.into())
    }

    /// Rows of the basis that is stored beside a reduction.
    async fn rows(
        &self,
        key: &Key,
        reduced: &ReducedSector,
        nodes: &Arc<[SectorNode]>,
        monitor: &PhaseMonitor,
    ) -> Result<std::io::Result<NodeRows>, Interruption> {
        let basis = self.store.basis(&key.0, key.1);
        let (wheel, nodes) = (Arc::clone(&reduced.wheel), Arc::clone(nodes));
        self.computing.run(monitor.watch(), move || basis.rows(&wheel, &nodes)).await
    }

    /// Computes a reduction with its rows at `nodes` within `memory_bytes`. The package is read anew each time: nobody who waits for memory may hold
    /// a whole sector.
    async fn reduce(
        &self,
        key: &Key,
        (checkpoints, nodes): (&CheckpointFolder, &Arc<[SectorNode]>),
        monitor: &PhaseMonitor,
        memory_bytes: Option<u64>,
    ) -> Result<Result<ReducedSector, AnalysisError>, Interruption> {
        if monitor.is_cancelled() {
            return Err(Interruption::NotWanted);
        }
        let (model, modes_per_speed) = (key.0.as_str(), key.1);
        tracing::info!(model.id = model, modes_per_speed, memory_bytes, "reducing");
        monitor.progress(0.0, "reading the package");
        let path = self.store.package(model).await?;
        let watch = Arc::clone(monitor.watch());
        let (checkpoints, nodes, monitor) = (checkpoints.clone(), Arc::clone(nodes), monitor.clone());
        let compute = move || {
            let package = package::read(&path, &Limits::default()).map_err(Interruption::stored_package)?;
            monitor.progress(0.0, "reducing");
            // Rows come from where they are, not from the disk, which may be full.
            let kept = KeptRows::new(&checkpoints, &nodes);
            let reduced = run::prepare(&package.sector, modes_per_speed, memory_bytes, &kept, &monitor);
            if let (Err(AnalysisError::Model(error)), Some(digits)) = (&reduced, &package.findings.digits)
                && !digits.has_all_digits
                && error.may_come_of_few_digits()
            {
                return Err(Interruption::few_digits(error, digits));
            }
            Ok(reduced.map(|reduced| {
                let reduced = reduced.with_findings(&package.findings);
                ReducedSector { nodes: kept.of(&reduced.wheel), ..reduced }
            }))
        };
        self.computing.run_parallel(&watch, compute).await?
    }

    /// Finds in memory the latest reduction that has what is wanted.
    fn recall(&self, key: &Key, beside: &Beside) -> Option<Arc<ReducedSector>> {
        let mut recent = self.recent.lock().unwrap_or_else(PoisonError::into_inner);
        let serves = |(known, reduced): &(Key, Arc<ReducedSector>)| known == key && beside.is_of(reduced);
        let position = recent.iter().rposition(serves)?;
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
