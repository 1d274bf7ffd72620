//! The step loop allocates nothing: a run six times as long takes no more allocations.

use allocation_counter::measure;
use faer::{Mat, c64};
use rubmap_wheel::dynamics::bending::{Bending, BladeBending};
use rubmap_wheel::dynamics::casing::{Casing, Lobes};
use rubmap_wheel::dynamics::clearance_change::ClearanceChange;
use rubmap_wheel::dynamics::clearance_drift::ClearanceDrift;
use rubmap_wheel::dynamics::contact::coating::{Coating, CoatingMaterial};
use rubmap_wheel::dynamics::contact::disc::disc_directions;
use rubmap_wheel::dynamics::contact::friction::sliding_directions;
use rubmap_wheel::dynamics::direction::Direction;
use rubmap_wheel::dynamics::effects::{Effects, Friction, FrictionLaw};
use rubmap_wheel::dynamics::euler::{EulerForce, SpeedRate, StraightRate};
use rubmap_wheel::dynamics::excitation::EngineOrderExcitation;
use rubmap_wheel::dynamics::flexible_casing::{CasingWave, FlexibleCasing};
use rubmap_wheel::dynamics::integrate::{Outcome, Revolutions, SensorRow, Simulation};
use rubmap_wheel::dynamics::modal_wheel::{ModalHarmonic, ModalWheel};
use rubmap_wheel::dynamics::orbit::Orbit;
use rubmap_wheel::dynamics::oscillators::ModalDamping;
use rubmap_wheel::dynamics::schemes::Scheme;
use rubmap_wheel::dynamics::sector::ContactNode;

const SECTORS: usize = 5;
const NODES: usize = 3;
const MODES: usize = 11;

fn wheel(coriolis: bool) -> ModalWheel {
    let harmonic = |harmonic: usize| {
        let shape = |row: usize, mode: usize| {
            // Without structure: rows must not depend on each other.
            let number = |part: usize| {
                let seed = (1 + row * MODES + mode + 40 * harmonic + 200 * part) as f64;
                100.0 * (2.0 * (1e4 * (12.9898 * seed).sin()).fract().abs() - 1.0)
            };
            c64::new(number(0), if harmonic == 0 { 0.0 } else { number(1) })
        };
        // Skew-symmetric.
        let turned = |i: usize, j: usize| c64::from(0.3 * (j as f64 - i as f64).clamp(-1.0, 1.0));
        ModalHarmonic {
            harmonic,
            single: harmonic == 0,
            omega: (0..MODES).map(|mode| 4000.0 * (1 + mode) as f64 + 500.0 * harmonic as f64).collect(),
            contact: Mat::from_fn(3 * NODES, MODES, shape),
            gyroscopic: coriolis.then(|| Mat::from_fn(MODES, MODES, turned)),
        }
    };
    let harmonics = (0..=SECTORS / 2).map(harmonic).collect();
    ModalWheel { speed_rad_s: 1000.0, sectors: SECTORS, repeats: 1, harmonics }
}

fn contact_nodes() -> Vec<ContactNode> {
    let node = |k: usize| ContactNode {
        id: k as u64,
        position: [100.0, 0.03 * k as f64, 4.0 * k as f64],
        normal: [0.8, 0.0, 0.6],
        dofs: [3 * k, 3 * k + 1, 3 * k + 2],
    };
    (0..NODES).map(node).collect()
}

/// Allocations of a run of `revolutions` in contact.
fn allocations(scheme: Scheme, coriolis: bool, effects: Effects<'_>, revolutions: usize) -> u64 {
    let (wheel, contact_nodes) = (wheel(coriolis), contact_nodes());
    let casing = Casing {
        clearance: vec![0.25, 0.3, 0.35],
        restriction: Some(Lobes { count: 2, amplitude: 0.5, width_rad: 0.4, phase_rad: 0.1 }.into()),
        ramp_revolutions: 0.5,
    };
    let damping = ModalDamping { modal_ratio: 0.01, family_ratios: vec![0.005], ranks: Vec::new() };
    let sensors = [SensorRow { direction: Direction { node: 0, components: [1.0, 0.0, 0.0] }, sector: 3 }];
    let simulation = Simulation {
        wheel: &wheel,
        contact_nodes: &contact_nodes,
        damping: Some(&damping),
        casing: Some(&casing),
        effects,
        initial: &[],
        sensors: &sensors,
        scheme,
        steps_per_revolution: 600,
        samples_per_revolution: 120,
        revolutions,
        window_revolutions: 1,
        repeats: None,
        detail: None,
        states: Some(Revolutions::Last(1)),
    };
    let mut run = None;
    let counted = measure(|| run = Some(simulation.run(&|_| true)));
    let run = run.unwrap();
    assert!(matches!(run.outcome, Outcome::Completed(_)), "{:?}", run.outcome);
    assert!(run.statistics.contact_impulse > 0.0, "nothing touched");
    assert!(counted.count_total > 0, "setting up allocates");
    counted.count_total
}

fn long_runs_take_no_more(scheme: Scheme, coriolis: bool, effects: Effects<'_>) {
    let of = |revolutions: usize| allocations(scheme, coriolis, effects, revolutions);
    // What is made once for all runs is made.
    of(2);
    assert_eq!(of(12), of(2), "{scheme:?}");
}

#[test]
fn without_effects_and_with_coriolis_forces() {
    for scheme in [Scheme::CentralDifferences, Scheme::ExactModal, Scheme::MasslessBoundary { kept_modes: 5 }]
    {
        for coriolis in [false, true] {
            long_runs_take_no_more(scheme, coriolis, Effects::default());
        }
    }
}

#[test]
fn with_each_effect_and_with_all() {
    let nodes = contact_nodes();
    let directions = sliding_directions(&nodes, 0.05).unwrap();
    let material = CoatingMaterial { modulus: 50.0, yield_stress: 1.0, hardening: 5.0 };
    let coating = Coating::new(material, 0.5, 60, &nodes, SECTORS).unwrap();
    let waves = vec![CasingWave { nodal_diameter: 2, omega: 9000.0, modal_mass: 1e-3 }];
    let flexible_casing = FlexibleCasing { waves, damping_ratio: 0.01 };
    let direction = Direction { node: 1, components: [0.0, 0.0, 1.0] };
    let excitation = [EngineOrderExcitation {
        order: 3,
        directions: vec![direction],
        amplitude: 1e-3,
        phase_rad: 0.2,
        ramp_revolutions: 0.5,
    }];
    let friction = Effects {
        friction: Some(Friction { coefficient: 0.05, law: FrictionLaw::Sliding, directions: &directions }),
        ..Effects::default()
    };
    let disc = disc_directions(&nodes).unwrap();
    let disc = Effects {
        friction: Some(Friction { coefficient: 0.05, law: FrictionLaw::Disc, directions: &disc }),
        ..Effects::default()
    };
    let coating = Effects { coating: Some(&coating), ..Effects::default() };
    let casing = Effects { flexible_casing: Some(&flexible_casing), ..Effects::default() };
    let orbit = Orbit { radius: 0.02, whirl_ratio: 0.5, phase_rad: 0.1 };
    let orbit = Effects { orbit: Some(orbit), ..Effects::default() };
    let mistuning = Effects { mistuning: Some(&[0.01, -0.02, 0.0, 0.015, -0.005]), ..Effects::default() };
    let excitation = Effects { excitation: &excitation, ..Effects::default() };
    let change = ClearanceChange { course: vec![(0.5, 0.01), (1.0, -0.01)], along_chord: None };
    let drift = ClearanceDrift {
        revolutions: [0.0, 4.0],
        without: vec![0.0; NODES],
        first: vec![0.01; NODES],
        last: vec![-0.01; NODES],
    };
    let euler = EulerForce {
        rate: SpeedRate(vec![StraightRate { revolutions: [0.0, 4.0], rad_s2: [1e3, -1e3] }]),
        load: vec![1e-3; MODES],
    };
    // Coordinates are the displacements of contact node 0.
    let blade = BladeBending::alike(3, NODES, Vec::new(), 1e-4);
    let bending = Bending { blade: &blade, first: 0, stiffens: true };
    let bending = Effects { bending: Some(bending), ..Effects::default() };
    let all = Effects {
        friction: friction.friction,
        flexible_casing: casing.flexible_casing,
        orbit: orbit.orbit,
        clearance_change: Some(&change),
        clearance_drift: Some(&drift),
        mistuning: mistuning.mistuning,
        excitation: excitation.excitation,
        euler_force: Some(&euler),
        coating: None,
        bending: None,
        energies: false,
    };
    let whole = Effects { friction: disc.friction, ..all };
    let coated = Effects { coating: coating.coating, ..bending };
    let bent = [bending, coated];
    let effects = [friction, disc, coating, casing, orbit, mistuning, excitation, all, whole];
    for effects in effects.into_iter().chain(bent) {
        for coriolis in [false, true] {
            long_runs_take_no_more(Scheme::ExactModal, coriolis, effects);
        }
    }
}
