//! Production step against its literal dense form, scheme by scheme: the same displacements over the first revolution.

use std::f64::consts::TAU;

use rubmap::dynamics::casing::{Casing, Lobe, Lobes, Measured, Part, PeriodicSpline, Profile, Restriction};
use rubmap::dynamics::direction::Direction;
use rubmap::dynamics::effects::Effects;
use rubmap::dynamics::integrate::{Outcome, SensorRow, Simulation};
use rubmap::dynamics::modal_wheel::{ModalWheel, RotationEffects};
use rubmap::dynamics::oscillators::ModalDamping;
use rubmap::dynamics::reduction::{NoCheckpoints, ReductionOptions, reduce};
use rubmap::dynamics::schemes::Scheme;
use rubmap::dynamics::schemes::central_differences::smallest_stable_steps;

use crate::fixtures::{TOP_SPEED, WheelRecipe, wheel};
use crate::oracle::schemes::Literal;
use crate::oracle::{free_gaps, gauss_seidel};

const SCHEMES: [Scheme; 3] =
    [Scheme::CentralDifferences, Scheme::ExactModal, Scheme::MasslessBoundary { kept_modes: 7 }];

fn lobes(count: u32) -> Restriction {
    Lobes { count, amplitude: 0.425, width_rad: 0.35, phase_rad: 0.1 }.into()
}

fn agree(recipe: WheelRecipe, damping_ratio: f64, restriction: Restriction, steps_factor: f64) {
    for scheme in SCHEMES {
        agree_by(scheme, recipe, damping_ratio, restriction.clone(), steps_factor);
    }
}

/// Asserts agreement of a scheme; `steps_factor` is in units of the smallest stable number of central differences' steps.
fn agree_by(
    scheme: Scheme,
    recipe: WheelRecipe,
    damping_ratio: f64,
    restriction: Restriction,
    steps_factor: f64,
) {
    let sector = wheel(recipe);
    let reduced = reduce(&sector, &ReductionOptions::new(6), &NoCheckpoints, &|_, _| true).unwrap();
    let speed = 0.6 * TOP_SPEED;
    let modal = ModalWheel::at(&reduced, speed, RotationEffects::stiffening(recipe.stiffening)).unwrap();
    let casing = Casing {
        clearance: (0..recipe.contact_nodes).map(|k| 0.30 - 0.02 * k as f64).collect(),
        restriction: Some(restriction),
        ramp_revolutions: 0.5,
    };
    let steps =
        (steps_factor * smallest_stable_steps(modal.largest_frequency(), speed) as f64).ceil() as usize;
    let damping = ModalDamping { modal_ratio: damping_ratio, family_ratios: Vec::new(), ranks: Vec::new() };
    let watched: Vec<(usize, usize, usize)> = (0..recipe.sectors)
        .flat_map(|s| (0..recipe.contact_nodes).flat_map(move |k| (0..3).map(move |d| (s, k, d))))
        .collect();
    let sensors: Vec<_> = watched
        .iter()
        .map(|&(sector, node, d)| {
            let mut components = [0.0; 3];
            components[d] = 1.0;
            SensorRow { direction: Direction { node, components }, sector }
        })
        .collect();
    let run = Simulation {
        wheel: &modal,
        contact_nodes: &reduced.contact,
        damping: (damping_ratio > 0.0).then_some(&damping),
        casing: Some(&casing),
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

    let h = TAU / (speed * steps as f64);
    let mut literal = Literal::new(scheme, &reduced, speed, damping_ratio, h);
    let (mut worst, mut largest) = (0.0f64, 0.0f64);
    for q in 0..steps {
        literal.step(&free_gaps(&casing, &reduced, (q + 1) as f64 / steps as f64), gauss_seidel);
        for (sensor, &(s, k, d)) in watched.iter().enumerate() {
            let truth = literal.displacement(s, k, d);
            worst = worst.max((history.displacement[sensor][q] - truth).abs());
            largest = largest.max(truth.abs());
        }
    }
    let contact_steps = literal.contact_steps();
    assert!(contact_steps >= 3, "{scheme:?} {recipe:?}: {contact_steps} contact steps");
    assert_eq!(contact_steps, run.statistics.contact_steps, "{scheme:?} {recipe:?}");
    assert!(worst < 1e-9 * largest, "{scheme:?} {recipe:?}: {worst:e} of {largest}");
    // With warm starts hardly any contact problem needs more than a second or third candidate set.
    let pivots = run.statistics.pivots;
    assert!(
        pivots.problems > 0 && pivots.candidates < 3 * pivots.problems,
        "{scheme:?} {recipe:?}: {pivots:?}"
    );
    let residual = run.energy.residual();
    assert!(residual < 1e-9, "{scheme:?} {recipe:?}: energy residual {residual:e}");
}

#[test]
fn ten_sectors_two_lobes() {
    agree(WheelRecipe::default(), 0.005, lobes(2), 1.3);
}

#[test]
fn without_damping_and_stiffening() {
    agree(WheelRecipe { stiffening: false, seed: 4, ..Default::default() }, 0.0, lobes(3), 1.3);
}

#[test]
fn odd_sector_count_with_lobes_that_do_not_divide_it() {
    agree(WheelRecipe { sectors: 7, contact_nodes: 4, seed: 2, ..Default::default() }, 0.02, lobes(3), 2.1);
}

#[test]
fn one_blade_on_a_rigid_disk() {
    agree(WheelRecipe { sectors: 1, face_nodes: 0, seed: 3, ..Default::default() }, 0.005, lobes(1), 20.0);
}

#[test]
fn a_sector_that_closes_on_itself() {
    agree(WheelRecipe { sectors: 1, seed: 5, ..Default::default() }, 0.005, lobes(2), 1.1);
}

#[test]
fn two_sectors() {
    agree(WheelRecipe { sectors: 2, contact_nodes: 1, seed: 6, ..Default::default() }, 0.001, lobes(1), 3.0);
}

/// Modes that follow statically: steps so long that the upper half of the modes does.
#[test]
fn modes_that_follow_statically() {
    for damping_ratio in [0.0, 0.01] {
        agree_by(
            Scheme::ExactModal,
            WheelRecipe { seed: 7, ..Default::default() },
            damping_ratio,
            lobes(2),
            0.55,
        );
    }
}

/// Numbers of kept modes from one mode with mass to nearly all of them.
#[test]
fn any_number_of_kept_modes() {
    for (kept_modes, steps_factor) in [(1, 1.0), (4, 1.5), (12, 2.5)] {
        let recipe = WheelRecipe { sectors: 5, contact_nodes: 2, seed: 8, ..Default::default() };
        agree_by(Scheme::MasslessBoundary { kept_modes }, recipe, 0.005, lobes(2), steps_factor);
    }
}

/// Casing of a Fourier series of three orders, that of the third less high towards the trailing edge.
#[test]
fn fourier_casing() {
    let wave = |order, amplitude, phase_rad, along_chord| Part {
        profile: Profile::Wave { order, amplitude, phase_rad },
        along_chord,
    };
    let parts = vec![
        wave(2, 0.25, 0.1, None),
        wave(3, 0.12, -1.0, Some(vec![1.0, 0.7, 0.2])),
        wave(11, 0.03, 2.0, None),
    ];
    agree(WheelRecipe { seed: 8, ..Default::default() }, 0.005, Restriction { parts }, 1.3);
}

/// Lobes of their own height, width and angle, a hollow among them, on a tilted wave.
#[test]
fn lobes_of_their_own() {
    let lobe = |amplitude, width_rad, angle_rad| Lobe { amplitude, width_rad, angle_rad };
    let lobes = vec![lobe(0.45, 0.3, 0.2), lobe(0.38, 0.15, 2.9), lobe(-0.2, 0.5, -1.2)];
    let along_chord = Some(vec![0.02, 0.05, 0.08]);
    let parts = vec![
        Part { profile: Profile::Each(lobes), along_chord: None },
        Part { profile: Profile::Wave { order: 1, amplitude: 1.0, phase_rad: 0.4 }, along_chord },
    ];
    agree(WheelRecipe { sectors: 7, seed: 9, ..Default::default() }, 0.005, Restriction { parts }, 1.3);
}

/// Points of two curves at uneven angles, and nodes on and between them.
#[test]
fn measured_casing() {
    let angles: Vec<f64> = (0..90).map(|i| TAU / 90.0 * (f64::from(i) + 0.3 * f64::from(i).sin())).collect();
    let curve = |node: usize| {
        let shape = lobes(2 + node as u32);
        let heights: Vec<f64> = angles.iter().map(|&angle| shape.height(angle, 0)).collect();
        PeriodicSpline::new(&angles, &heights)
    };
    // Two lines, and nodes before, between and behind them.
    let nodes = vec![(0, 0, 0.0), (0, 1, 0.3), (1, 1, 0.0)];
    let measured = Measured { curves: (0..2).map(curve).collect(), nodes };
    let parts = vec![Part { profile: Profile::Measured(measured), along_chord: None }];
    agree(WheelRecipe { seed: 10, ..Default::default() }, 0.005, Restriction { parts }, 1.3);
}
