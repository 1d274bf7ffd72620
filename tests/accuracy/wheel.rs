//! Small impellers with their reductions, and runs on them.

use std::collections::BTreeMap;
use std::convert::Infallible;
use std::sync::{Arc, Mutex};

use rubmap::analysis::monitor::Unwatched;
use rubmap::analysis::resolved::ResolvedSweep;
use rubmap::analysis::run::{
    ModelFacts, ReducedSector, Trial, TrialRequest, prepare, resolve_sweep, run_trial,
};
use rubmap::analysis::stress::{HarmonicStress, ReducedStress, StressMaker};
use rubmap::dynamics::nodes::SectorNode;
use rubmap::dynamics::reduction::{BasisRows, Checkpoints, NoCheckpoints, ReducedWheel};
use rubmap::dynamics::sector::SectorModel;
use rubmap::impeller::{ImpellerParameters, MeshDensities, generate};
use rubmap::package;
use rubmap::solid::mesh::SectorMesh;
use serde_json::Value;

/// Wheel of coarse mesh, with every reduction made once.
pub(crate) struct Wheel {
    sector: SectorModel,
    pub(crate) facts: ModelFacts,
    reductions: BTreeMap<u32, Arc<ReducedSector>>,
    /// Elements and nodes, where stress is wanted.
    elements: Option<(SectorMesh, Vec<SectorNode>)>,
}

/// Checkpoints that keep whole bases in memory.
#[derive(Default)]
struct Bases(Mutex<BTreeMap<usize, Vec<Vec<f64>>>>);

impl Checkpoints for Bases {
    fn load(&self, _part: &str) -> Option<Vec<u8>> {
        None
    }

    fn save(&self, _part: &str, _bytes: Vec<u8>) {}

    fn keep_basis(&self, rows: &BasisRows<'_>) {
        let whole = (0..rows.dofs()).map(|dof| rows.row(dof).collect()).collect();
        self.0.lock().unwrap().insert(rows.harmonic(), whole);
    }
}

impl Wheel {
    /// Parameters of a coarse mesh: about 500 DOF a sector.
    pub(crate) fn coarse_parameters(sectors: usize) -> ImpellerParameters {
        let mesh = MeshDensities {
            between_contact_nodes: 1,
            blade_height: 4,
            blade_thickness: 1,
            half_passage: 1,
            disk: 1,
        };
        ImpellerParameters { sectors, contact_nodes: 4, mesh, ..ImpellerParameters::default() }
    }

    pub(crate) fn coarse(sectors: usize) -> Self {
        Self::of(&Self::coarse_parameters(sectors))
    }

    pub(crate) fn of(parameters: &ImpellerParameters) -> Self {
        Self { elements: None, ..Self::with_stress(parameters) }
    }

    /// Makes a wheel with stress beside its reductions.
    pub(crate) fn with_stress(parameters: &ImpellerParameters) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("wheel.zip");
        package::write(&generate(parameters).unwrap(), std::fs::File::create(&path).unwrap()).unwrap();
        let limits = package::Limits::default();
        let read = package::read(&path, &limits).unwrap();
        let facts = ModelFacts::of_package(&read.sector, read.mesh.as_ref(), &read.findings);
        let nodes = package::read_nodes(&path, &limits).unwrap();
        let elements = read.mesh.map(|mesh| (mesh, nodes));
        Self { sector: read.sector, facts, reductions: BTreeMap::new(), elements }
    }

    pub(crate) fn reduced(&mut self, modes_per_speed: u32) -> Arc<ReducedSector> {
        let (sector, elements) = (&self.sector, &self.elements);
        let spacing = self.facts.contact_spacing.unwrap_or(0.0);
        let make = || match elements {
            None => Arc::new(prepare(sector, modes_per_speed, None, &NoCheckpoints, &Unwatched).unwrap()),
            Some((mesh, nodes)) => {
                let bases = Bases::default();
                let reduced = prepare(sector, modes_per_speed, None, &bases, &Unwatched).unwrap();
                let bases = bases.0.into_inner().unwrap();
                let stress = stress(sector, (mesh, nodes), &reduced.wheel, &bases, spacing);
                Arc::new(ReducedSector { stress: Some(Arc::new(stress)), ..reduced })
            }
        };
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

fn stress(
    sector: &SectorModel,
    (mesh, nodes): (&SectorMesh, &[SectorNode]),
    wheel: &ReducedWheel,
    bases: &BTreeMap<usize, Vec<Vec<f64>>>,
    excluded_radius: f64,
) -> ReducedStress {
    let maker = StressMaker::new(mesh, nodes);
    let fixed = maker.fixed(sector, &|_, _| true).unwrap().stress;
    let of = |reduced| {
        let mut row = |harmonic: usize, dof: usize| Ok::<_, Infallible>(bases[&harmonic][dof].clone());
        let Ok(made) = maker.harmonic(reduced, sector.own_dofs(), &mut row);
        made
    };
    let made: Vec<HarmonicStress> = wheel.harmonics.iter().map(of).collect();
    let load = |harmonic: usize, kept: &[usize]| {
        let made: &HarmonicStress = &made[harmonic];
        HarmonicStress::gather(made.unknowns(), kept.len(), |slot, numbers| {
            numbers.iter_mut().zip(made.of_place(kept[slot])).for_each(|(into, number)| *into = number);
            Ok::<_, Infallible>(())
        })
    };
    let Ok(stress) = ReducedStress::load(mesh, maker.operator(), wheel, excluded_radius, fixed, load);
    stress
}
