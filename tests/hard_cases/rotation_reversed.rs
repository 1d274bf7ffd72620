//! Rotation reversed: a wheel turning the other way.
//!
//! Signs of sines, the order of sectors and the side on which a Fourier pair lags are easily wrong twice, so that tests
//! in one direction of rotation pass. Seen from the other end of the axis (θ → −θ, z → −z, sectors numbered
//! backwards, the coupling to the next sector transposed) a wheel that turns backwards turns forwards. Guaranteed:
//! production on the wheel so described gives what the literal dense scheme gives for the original wheel in a casing
//! that passes it the other way, to round-off.

use std::f64::consts::TAU;

use faer::sparse::{SparseColMat, Triplet};
use rubmap::dynamics::casing::{Casing, Lobes};
use rubmap::dynamics::direction::Direction;
use rubmap::dynamics::effects::Effects;
use rubmap::dynamics::integrate::{Outcome, SensorRow, Simulation};
use rubmap::dynamics::modal_wheel::{ModalWheel, RotationEffects};
use rubmap::dynamics::oscillators::ModalDamping;
use rubmap::dynamics::reduction::{NoCheckpoints, ReducedWheel, ReductionOptions, reduce};
use rubmap::dynamics::schemes::Scheme;
use rubmap::dynamics::schemes::central_differences::smallest_stable_steps;
use rubmap::dynamics::sector::{CyclicMatrix, SectorModel, SectorParts};

use crate::fixtures::{TOP_SPEED, WheelRecipe, wheel};
use crate::oracle::schemes::Literal;
use crate::oracle::{free_gaps, gauss_seidel};
use crate::support::LIBRARY_SCHEMES;

const SPEED: f64 = 0.6 * TOP_SPEED;
const DAMPING: f64 = 0.02;

/// Signs of the components: θ and z change sign, r does not.
const SIGNS: [f64; 3] = [1.0, -1.0, -1.0];

/// Sector in the frame turned about its x axis by half a turn.
fn seen_from_behind(sector: &SectorModel) -> SectorModel {
    let sign = |dof: usize| SIGNS[dof % 3];
    let turned = |matrix: &SparseColMat<usize, f64>, transposed: bool| {
        let entries: Vec<_> = matrix
            .triplet_iter()
            .map(|entry| {
                let value = *entry.val * sign(entry.row) * sign(entry.col);
                let (row, column) = if transposed { (entry.col, entry.row) } else { (entry.row, entry.col) };
                Triplet::new(row, column, value)
            })
            .collect();
        SparseColMat::try_new_from_triplets(matrix.nrows(), matrix.ncols(), &entries).unwrap()
    };
    let flip = |matrix: &CyclicMatrix| CyclicMatrix {
        own: turned(&matrix.own, false),
        next: turned(&matrix.next, true),
    };
    let mut turned = SectorParts {
        mass: flip(&sector.mass),
        stiffness: sector.stiffness.iter().map(flip).collect(),
        ..sector.clone().into_parts()
    };
    for node in &mut turned.contact {
        node.normal = std::array::from_fn(|d| SIGNS[d] * node.normal[d]);
        node.position[1] *= -1.0;
        node.position[2] *= -1.0;
    }
    SectorModel::new(turned).unwrap()
}

fn casing(contact_nodes: usize, phase_rad: f64) -> Casing {
    Casing {
        clearance: (0..contact_nodes).map(|k| 0.30 - 0.02 * k as f64).collect(),
        restriction: Some(Lobes { count: 2, amplitude: 0.425, width_rad: 0.35, phase_rad }.into()),
        ramp_revolutions: 0.5,
    }
}

/// Displacements by the literal dense scheme, `[sector][node][component][step]`, the wheel turning by `direction` = ±1.
fn dense(
    scheme: Scheme,
    reduced: &ReducedWheel,
    casing: &Casing,
    steps: usize,
    direction: f64,
) -> Vec<Vec<f64>> {
    let mut literal = Literal::new(scheme, reduced, SPEED, DAMPING, TAU / (SPEED * steps as f64));
    let mut history = vec![Vec::with_capacity(steps); 3 * reduced.sectors * reduced.contact.len()];
    for q in 0..steps {
        let revolutions = direction * (q + 1) as f64 / steps as f64;
        literal.step(&free_gaps(casing, reduced, revolutions), gauss_seidel);
        for (line, (s, k, d)) in history.iter_mut().zip(places(reduced)) {
            line.push(literal.displacement(s, k, d));
        }
    }
    history
}

/// Sector, node and component of every contact DOF.
fn places(reduced: &ReducedWheel) -> impl Iterator<Item = (usize, usize, usize)> + use<> {
    let nodes = reduced.contact.len();
    (0..reduced.sectors).flat_map(move |s| (0..nodes).flat_map(move |k| (0..3).map(move |d| (s, k, d))))
}

#[test]
fn a_wheel_that_turns_backwards() {
    for scheme in LIBRARY_SCHEMES {
        for sectors in [1, 2, 5, 10] {
            turns_backwards(scheme, sectors);
        }
    }
}

fn turns_backwards(scheme: Scheme, sectors: usize) {
    let contact_nodes = 3;
    let sector = wheel(WheelRecipe { sectors, contact_nodes, ..Default::default() });
    let reduce = |sector: &SectorModel| {
        reduce(sector, &ReductionOptions::new(6), &NoCheckpoints, &|_, _| true).unwrap()
    };
    let (original, turned) = (reduce(&sector), reduce(&seen_from_behind(&sector)));
    let modal = ModalWheel::at(&turned, SPEED, RotationEffects::stiffening(true)).unwrap();
    let steps = 2 * smallest_stable_steps(modal.largest_frequency(), SPEED) as usize;

    let backwards = dense(scheme, &original, &casing(contact_nodes, 0.1), steps, -1.0);
    let forwards = dense(scheme, &original, &casing(contact_nodes, 0.1), steps, 1.0);
    let largest = backwards.iter().flatten().fold(0.0f64, |m, u| m.max(u.abs()));
    let both = backwards.iter().flatten().zip(forwards.iter().flatten());
    let handed = both.fold(0.0f64, |m, (a, b)| m.max((a - b).abs()));
    assert!(handed > 1e-2 * largest, "a wheel to which the direction does not matter tests nothing");

    // Sector s of the original is sector −s here.
    let sensors: Vec<_> = places(&original)
        .map(|(s, node, d)| {
            let mut components = [0.0; 3];
            components[d] = SIGNS[d];
            SensorRow { direction: Direction { node, components }, sector: (sectors - s) % sectors }
        })
        .collect();
    let damping = ModalDamping { modal_ratio: DAMPING, family_ratios: Vec::new(), ranks: Vec::new() };
    let run = Simulation {
        wheel: &modal,
        contact_nodes: &turned.contact,
        damping: Some(&damping),
        casing: Some(&casing(contact_nodes, -0.1)),
        effects: Effects::default(),
        initial: &[],
        scheme,
        sensors: &sensors,
        steps_per_revolution: steps,
        samples_per_revolution: steps,
        revolutions: 1,
        window_revolutions: 1,
        repeats: None,
        detail: None,
        states: None,
    }
    .run(&|_| true);
    let Outcome::Completed(history) = run.outcome else { panic!("{:?}", run.outcome) };
    assert!(run.statistics.contact_share() > 0.02);
    assert!(run.energy.residual() < 1e-9);
    let both = history.displacement.iter().flatten().zip(backwards.iter().flatten());
    let worst = both.fold(0.0f64, |m, (a, b)| m.max((a - b).abs()));
    // Round-off of two reductions, grown over a revolution of contact.
    assert!(worst < 1e-8 * largest, "{scheme:?}, {sectors} sectors: {worst:e} of {largest}");
}
