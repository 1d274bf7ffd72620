//! Stiffness at the three speeds that differs by ε, from a few per cent down to round-off: the three sets of modes
//! are dependent but for directions of size ε.
//!
//! A direction that is kept although it is a difference of nearly equal vectors becomes one of the stiffest modes of
//! the reduced wheel: the stable step shrinks and the accuracy gains nothing. One that is hardly there is the round-off
//! of that difference: with a tolerance of 1e-8 the impeller below has 15 times the largest frequency, and steps, of
//! the same impeller at rest. Guaranteed for every ε: between k and 3k directions, never more as ε shrinks, k where
//! ε is round-off; largest frequency and step within the third that more modes would cost anyway; frequencies no worse than
//! those of the rank-k basis; a sweep with its energy accounted for.

use rubmap::dynamics::modal_wheel::{ModalWheel, RotationEffects, natural_frequencies};
use rubmap::dynamics::reduction::{NoCheckpoints, ReductionOptions, reduce};
use rubmap::dynamics::sector::SectorModel;
use rubmap::package::to_sector;
use serde_json::json;

use crate::fixtures::{WheelRecipe, small_impeller, wheel};
use crate::support::{SCHEMES, assert_sound, reduced, run, sweep};

const MODES: u32 = 8;

fn impeller() -> SectorModel {
    to_sector(small_impeller(4)).unwrap()
}

fn masses_and_springs() -> SectorModel {
    wheel(WheelRecipe { nodes: 40, ..Default::default() })
}

/// Speed between the given speeds.
fn speed_of(sector: &SectorModel) -> f64 {
    0.7 * sector.speeds_rad_s[2]
}

/// Sector with K(Ω) − K(0) of `sector` times `epsilon`.
fn stiffening_by(epsilon: f64, sector: SectorModel) -> SectorModel {
    let mut sector = sector.into_parts();
    let rest = sector.stiffness[0].clone();
    for matrix in &mut sector.stiffness {
        let blend = |to: &mut [f64], from: &[f64]| {
            to.iter_mut().zip(from).for_each(|(to, from)| *to = from + epsilon * (*to - from));
        };
        blend(matrix.own.val_mut(), rest.own.val());
        blend(matrix.next.val_mut(), rest.next.val());
    }
    SectorModel::new(sector).unwrap()
}

#[test]
fn the_kept_directions_are_bounded_and_not_stiff() {
    for whole in [impeller(), masses_and_springs()] {
        let speed = speed_of(&whole);
        let boundary = 3 * whole.contact.len() as u32;
        let largest = |sector: &SectorModel| {
            let found = reduced(sector, MODES);
            let frequency = ModalWheel::at(&found.wheel, speed, RotationEffects::stiffening(true))
                .unwrap()
                .largest_frequency();
            let kept = found.report.unknowns.iter().map(|unknowns| unknowns - boundary).collect::<Vec<_>>();
            (frequency, kept)
        };
        let (of_rank_k, mut last) = largest(&stiffening_by(0.0, whole.clone()));
        assert!(last.iter().all(|&kept| kept == MODES), "{last:?}");
        for epsilon in [1e-16, 1e-14, 1e-12, 1e-10, 1e-8, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 0.1, 1.0] {
            let (frequency, kept) = largest(&stiffening_by(epsilon, whole.clone()));
            for (kept, last) in kept.iter().zip(&last) {
                assert!((*last..=3 * MODES).contains(kept), "{epsilon:e}: {kept} after {last}");
            }
            assert!(epsilon > 1e-6 || kept.iter().all(|&kept| kept == MODES), "{epsilon:e}: {kept:?}");
            let inflation = frequency / of_rank_k;
            assert!(inflation < 4.0 / 3.0, "{epsilon:e}: {inflation}");
            last = kept;
        }
    }
}

#[test]
fn frequencies_are_no_worse_than_those_of_rank_k() {
    let options = ReductionOptions::new(1000);
    // Relative error of the four lowest frequencies of each nodal diameter against the complete basis.
    let errors = |epsilon: f64| -> Vec<f64> {
        let sector = stiffening_by(epsilon, masses_and_springs());
        let speed = speed_of(&sector);
        let exact = reduce(&sector, &options, &NoCheckpoints, &|_, _| true).unwrap();
        let found = reduced(&sector, MODES).wheel;
        let both = found.harmonics.iter().zip(&exact.harmonics);
        both.flat_map(|(found, exact)| {
            let frequencies = |harmonic| natural_frequencies(harmonic, speed, true).unwrap();
            let pairs = frequencies(found).into_iter().zip(frequencies(exact)).take(4);
            pairs.map(|(found, exact)| found / exact - 1.0).collect::<Vec<_>>()
        })
        .collect()
    };
    let rank_k = errors(0.0);
    for epsilon in [1e-2, 1e-4, 1e-6, 1e-10, 1e-14] {
        for (error, reference) in errors(epsilon).iter().zip(&rank_k) {
            // Errors are from above (Rayleigh–Ritz), to round-off; the modes themselves move by ε.
            assert!(*error > -1e-9, "{epsilon:e}: {error:e}");
            assert!(
                *error < reference * (1.0 + 10.0 * epsilon) + 1e-9,
                "{epsilon:e}: {error:e} {reference:e}"
            );
        }
    }
}

#[test]
fn every_sweep_runs_at_nearly_the_same_step() {
    for scheme in SCHEMES {
        let mut bounds = Vec::new();
        for epsilon in [0.0, 1e-14, 1e-10, 1e-6, 1e-4, 1e-2, 1.0] {
            let sector = stiffening_by(epsilon, impeller());
            let reduced = reduced(&sector, MODES);
            let request = sweep(&sector, scheme, &[speed_of(&sector)], json!({"modes_per_speed": MODES}));
            let results = run(&reduced, &request);
            assert_sound(&results[0], 1.0);
            assert!(results[0].point.contact_share > 0.01);
            // A boundary without mass keeps what its step carries, so there the step itself is compared.
            let point = &results[0].point;
            bounds.push(match scheme {
                "massless_boundary" => point.steps_per_revolution,
                _ => point.smallest_stable_steps_per_revolution,
            });
        }
        let (least, most) = (bounds.iter().min().unwrap(), bounds.iter().max().unwrap());
        assert!(3 * most <= 4 * least, "{scheme}: {bounds:?}");
    }
}
