//! Small generated wheel with frequencies by the program's own reduction, which the fit does not use.

use std::f64::consts::TAU;
use std::sync::Mutex;

use rubmap_fit::{Evaluation, FitRequest, Keeper, Target, Unit};
use rubmap_model::impeller::{ImpellerRequest, generate};
use rubmap_model::package::to_sector;
use rubmap_wheel::dynamics::families::FamilyWalk;
use rubmap_wheel::dynamics::reduction::{NoCheckpoints, ReductionOptions, reduce};
use serde_json::{Value, json};

/// Coarse wheel with some parameters changed.
pub(crate) fn wheel(changes: &Value) -> ImpellerRequest {
    let mut wheel = json!({
        "sectors": 6,
        "contact_nodes": 4,
        "mesh": {"between_contact_nodes": 1, "blade_height": 2, "blade_thickness": 1, "half_passage": 1, "disk": 2},
    });
    for (name, value) in changes.as_object().unwrap() {
        wheel[name] = value.clone();
    }
    serde_json::from_value(wheel).unwrap()
}

/// Modes of the targets of [`targets`]: nodal diameter and family.
const MODES: [(usize, usize); 5] = [(0, 1), (1, 1), (1, 2), (2, 1), (3, 1)];

/// Frequencies of a wheel in Hz at speeds in rpm, by its reduction.
pub(crate) fn targets(wheel: &ImpellerRequest, speeds_rpm: &[f64]) -> Vec<Target> {
    let sector = to_sector(generate(&wheel.resolve().unwrap()).unwrap()).unwrap();
    let reduced = reduce(&sector, &ReductionOptions::new(60), &NoCheckpoints, &|_, _| true).unwrap();
    let mut targets = Vec::new();
    for &speed in speeds_rpm {
        for (nodal_diameter, family) in MODES {
            let modes =
                FamilyWalk::new(&reduced, nodal_diameter, true).unwrap().at(speed * TAU / 60.0).unwrap();
            let frequency = modes.omega[modes.ranks[family - 1]] / TAU;
            targets.push(Target { nodal_diameter, family, speed, frequency, error: 0.01 });
        }
    }
    targets
}

/// Request for targets, in Hz and rpm.
pub(crate) fn request(wheel: ImpellerRequest, vary: Value, targets: Vec<Target>) -> FitRequest {
    FitRequest {
        wheel,
        vary: serde_json::from_value(vary).unwrap(),
        unit: Unit::HzAndRpm,
        targets,
        starts: 1,
        candidates: 1,
        seed: 0,
        iterations: 50,
        tolerance: None,
    }
}

/// Keeper of all evaluations in the order in which they come.
#[derive(Default)]
pub(crate) struct Kept(pub(crate) Mutex<Vec<Evaluation>>);

impl Keeper for Kept {
    fn evaluated(&self, evaluation: &Evaluation) {
        self.0.lock().unwrap().push(evaluation.clone());
    }

    fn ended(&self, _start: usize, _weighted_rms: f64) {}
}
