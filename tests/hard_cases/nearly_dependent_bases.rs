//! Stiffness at the three speeds that differs by ε, from a few per cent down to round-off: the three sets of modes
//! are dependent but for directions of size ε.
//!
//! A direction that is kept although it is a difference of nearly equal vectors becomes one of the stiffest modes of
//! the reduced wheel: the stable step shrinks and the accuracy gains nothing. One that is hardly there carries the
//! round-off of that difference. Guaranteed for every ε: between k and 3k directions, never more as ε shrinks, k where
//! ε is round-off; the step does not shrink below that of the basis of 3k modes the same sector offers at one speed;
//! frequencies no worse than those of the rank-k basis; a sweep with its energy accounted for.

use rubmap::dynamics::modal_wheel::{ModalWheel, natural_frequencies};
use rubmap::dynamics::reduction::{NoCheckpoints, ReductionOptions, reduce};
use rubmap::dynamics::sector::SectorModel;
use serde_json::json;

use crate::fixtures::{TOP_SPEED, WheelRecipe, wheel};
use crate::support::{SCHEMES, assert_sound, reduced, run, sweep};

const MODES: u32 = 8;
const SPEED: f64 = 0.7 * TOP_SPEED;

/// K(Ω) − K(0) of the test wheel times `epsilon`.
fn stiffening_by(epsilon: f64) -> SectorModel {
    let mut sector = wheel(WheelRecipe { nodes: 40, ..Default::default() });
    let rest = sector.stiffness[0].clone();
    for matrix in &mut sector.stiffness {
        let blend = |to: &mut [f64], from: &[f64]| {
            to.iter_mut().zip(from).for_each(|(to, from)| *to = from + epsilon * (*to - from));
        };
        blend(matrix.own.val_mut(), rest.own.val());
        blend(matrix.next.val_mut(), rest.next.val());
    }
    sector
}

#[test]
fn the_kept_directions_are_bounded_and_not_stiff() {
    let of_rest = SectorModel {
        speeds_rad_s: vec![0.0],
        stiffness: vec![stiffening_by(0.0).stiffness[0].clone()],
        ..stiffening_by(0.0)
    };
    let richest = ModalWheel::at(&reduced(&of_rest, 3 * MODES).wheel, SPEED, false).unwrap();
    let mut last = vec![3 * MODES; 6];
    for epsilon in [1.0, 0.1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-8, 1e-10, 1e-12, 1e-14, 1e-16] {
        let sector = stiffening_by(epsilon);
        let found = reduced(&sector, MODES);
        let kept: Vec<u32> = found.report.unknowns.iter().map(|unknowns| unknowns - 9).collect();
        for (kept, last) in kept.iter().zip(&last) {
            assert!((MODES..=*last).contains(kept), "{epsilon:e}: {kept} after {last}");
        }
        if epsilon <= 1e-6 {
            assert!(kept.iter().all(|&kept| kept == MODES), "{epsilon:e}: {kept:?}");
        }
        let modal = ModalWheel::at(&found.wheel, SPEED, true).unwrap();
        let inflation = modal.largest_frequency() / richest.largest_frequency();
        assert!(inflation < 1.5, "{epsilon:e}: the largest frequency is {inflation} of that of 3k modes");
        last = kept;
    }
}

#[test]
fn frequencies_are_no_worse_than_those_of_rank_k() {
    let options = ReductionOptions::new(1000);
    // Relative error of the four lowest frequencies of each nodal diameter against the complete basis.
    let errors = |epsilon: f64| -> Vec<f64> {
        let sector = stiffening_by(epsilon);
        let exact = reduce(&sector, &options, &NoCheckpoints, &|_, _| true).unwrap();
        let found = reduced(&sector, MODES).wheel;
        let both = found.harmonics.iter().zip(&exact.harmonics);
        both.flat_map(|(found, exact)| {
            let frequencies = |harmonic| natural_frequencies(harmonic, SPEED, true).unwrap();
            let pairs = frequencies(found).into_iter().zip(frequencies(exact)).take(4);
            pairs.map(|(found, exact)| found / exact - 1.0).collect::<Vec<_>>()
        })
        .collect()
    };
    let rank_k = errors(0.0);
    for epsilon in [1e-2, 1e-4, 1e-6, 1e-10, 1e-14] {
        for (error, reference) in errors(epsilon).iter().zip(&rank_k) {
            // From above (Rayleigh–Ritz), to round-off; the modes themselves move by ε.
            assert!(*error > -1e-9, "{epsilon:e}: {error:e}");
            assert!(
                *error < reference * (1.0 + 10.0 * epsilon) + 1e-9,
                "{epsilon:e}: {error:e} {reference:e}"
            );
        }
    }
}

#[test]
fn every_sweep_runs_at_the_same_step() {
    for scheme in SCHEMES {
        let mut smallest = Vec::new();
        for epsilon in [0.0, 1e-14, 1e-10, 1e-6, 1e-4, 1e-2] {
            let sector = stiffening_by(epsilon);
            let reduced = reduced(&sector, MODES);
            let request = sweep(&sector, scheme, &[SPEED], json!({"modes_per_speed": MODES}));
            let results = run(&reduced, &request);
            assert_sound(&results[0], 1.0);
            assert!(results[0].point.contact_share > 0.01);
            smallest.push(results[0].point.smallest_stable_steps_per_revolution);
        }
        let (least, most) = (smallest.iter().min().unwrap(), smallest.iter().max().unwrap());
        assert!(2 * most < 3 * least, "{scheme:?}: {smallest:?}");
    }
}
