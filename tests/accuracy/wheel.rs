//! Small impellers with their reductions, and runs on them.

use std::collections::BTreeMap;
use std::sync::Arc;

use rubmap::analysis::monitor::Unwatched;
use rubmap::analysis::resolved::ResolvedSweep;
use rubmap::analysis::run::{
    ModelFacts, ReducedSector, Trial, TrialRequest, prepare, resolve_sweep, run_trial,
};
use rubmap::dynamics::reduction::NoCheckpoints;
use rubmap::dynamics::sector::SectorModel;
use rubmap::impeller::{ImpellerParameters, MeshDensities, generate};
use rubmap::package;
use serde_json::Value;

/// A wheel of coarse mesh, with every reduction made once.
pub(crate) struct Wheel {
    sector: SectorModel,
    pub(crate) facts: ModelFacts,
    reductions: BTreeMap<u32, Arc<ReducedSector>>,
}

impl Wheel {
    /// Of so many sectors, about 500 DOF each.
    pub(crate) fn coarse(sectors: usize) -> Self {
        let mesh = MeshDensities {
            between_contact_nodes: 1,
            blade_height: 4,
            blade_thickness: 1,
            half_passage: 1,
            disk: 1,
        };
        Self::of(&ImpellerParameters { sectors, contact_nodes: 4, mesh, ..ImpellerParameters::default() })
    }

    pub(crate) fn of(parameters: &ImpellerParameters) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("wheel.zip");
        package::write(&generate(parameters).unwrap(), std::fs::File::create(&path).unwrap()).unwrap();
        let sector = package::read(&path, &package::Limits::default()).unwrap().sector;
        let facts = ModelFacts::of(&sector);
        Self { sector, facts, reductions: BTreeMap::new() }
    }

    pub(crate) fn reduced(&mut self, modes_per_speed: u32) -> Arc<ReducedSector> {
        let sector = &self.sector;
        let make = || Arc::new(prepare(sector, modes_per_speed, None, &NoCheckpoints, &Unwatched).unwrap());
        Arc::clone(self.reductions.entry(modes_per_speed).or_insert_with(make))
    }

    pub(crate) fn run(&mut self, request: &TrialRequest) -> Trial {
        let reduced = self.reduced(request.sweep().modes_per_speed());
        run_trial(&reduced, request, &Unwatched).unwrap()
    }

    pub(crate) fn resolved(&self, body: Value) -> ResolvedSweep {
        resolve_sweep(serde_json::from_value(body).unwrap(), &self.facts).unwrap()
    }
}
