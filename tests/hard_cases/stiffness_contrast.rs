//! Stiffness that differs by ten decades inside one sector: a rigid tip on a soft blade, a soft tip on a rigid hub.
//!
//! The soft spring is a difference in the tenth digit of the stiff one. Codes that drop small pivots, shift by a share of
//! the largest entry, or judge a rigid-body mode by it lose the mode that matters. Guaranteed: frequencies to what the
//! matrix entries themselves can hold (round-off times contrast for soft modes, round-off for stiff ones), a refusal
//! where they hold nothing, and a sweep with its energy accounted for.

use std::f64::consts::PI;

use faer::sparse::{SparseColMat, Triplet};
use rubmap::analysis::error::AnalysisError;
use rubmap::analysis::monitor::Unwatched;
use rubmap::analysis::run::prepare;
use rubmap::dynamics::modal_wheel::{ModalWheel, RotationEffects};
use rubmap::dynamics::reduction::NoCheckpoints;
use rubmap::dynamics::sector::{ContactNode, CyclicMatrix, SectorModel, SectorParts, Units};
use serde_json::json;

use crate::support::{SCHEMES, assert_sound, reduced, run, sweep};

const SECTORS: usize = 5;
const MASS: [f64; 2] = [3e-6, 1e-6];
/// Softest spring in r, θ and z, and of the coupling to the next sector: few binary digits, so that sums are exact.
const SOFT: [f64; 3] = [6.0, 8.0, 11.0];
const COUPLING: f64 = 1.5;
/// Ratio of the stiffest spring to the softest, 1.7e10.
const CONTRAST: f64 = (1u64 << 34) as f64;

/// Sector, in each direction: ground – `hub` – root mass – `tip` – contact mass, root masses of neighbours joined by COUPLING.
fn sector(hub: [f64; 3], tip: [f64; 3]) -> SectorModel {
    let (mut own, mut next, mut mass) = (Vec::new(), Vec::new(), Vec::new());
    for d in 0..3 {
        own.push(Triplet::new(d, d, hub[d] + 2.0 * COUPLING + tip[d]));
        own.push(Triplet::new(3 + d, 3 + d, tip[d]));
        own.push(Triplet::new(d, 3 + d, -tip[d]));
        own.push(Triplet::new(3 + d, d, -tip[d]));
        next.push(Triplet::new(d, d, -COUPLING));
        mass.extend([Triplet::new(d, d, MASS[0]), Triplet::new(3 + d, 3 + d, MASS[1])]);
    }
    let sparse =
        |entries: &[Triplet<usize, usize, f64>]| SparseColMat::try_new_from_triplets(6, 6, entries).unwrap();
    let parts = SectorParts {
        name: "contrast".into(),
        sectors: SECTORS,
        units: Units { length: "mm".into(), force: "N".into(), time: "s".into(), mass: "t".into() },
        mass: CyclicMatrix { own: sparse(&mass), next: sparse(&[]) },
        stiffness: vec![CyclicMatrix { own: sparse(&own), next: sparse(&next) }],
        gyroscopic: None,
        speeds_rad_s: vec![0.0],
        contact: vec![ContactNode {
            id: 1,
            position: [50.0, 0.0, 0.0],
            normal: [0.8, 0.0, -0.6],
            dofs: [3, 4, 5],
        }],
        axis: Vec::new(),
        node_of_dof: vec![0, 0, 0, 1, 1, 1],
    };
    SectorModel::new(parts).unwrap()
}

/// Closed form of ω² of two masses on two springs, (low, high): roots of m₁m₂λ² − (k₂(m₁ + m₂) + k₁m₂)λ + k₁k₂, free of cancellation.
fn closed_form(hub: f64, tip: f64) -> [f64; 2] {
    let [m1, m2] = MASS;
    let a = m1 * m2;
    let b = tip * (m1 + m2) + hub * m2;
    // This is b² − 4ac with c = k₁k₂, as a sum of squares: (k₂(m₁ + m₂) − k₁m₂)² + 4k₁k₂m₂².
    let root = ((tip * (m1 + m2) - hub * m2).powi(2) + 4.0 * hub * tip * m2 * m2).sqrt();
    let high = (b + root) / (2.0 * a);
    [hub * tip / (a * high), high]
}

/// Expected ω² of nodal diameter `i`, all six, ascending.
fn expected(hub: [f64; 3], tip: [f64; 3], i: usize) -> Vec<f64> {
    let sine = (PI * i as f64 / SECTORS as f64).sin();
    let mut all: Vec<f64> =
        (0..3).flat_map(|d| closed_form(hub[d] + 4.0 * COUPLING * sine * sine, tip[d])).collect();
    all.sort_by(f64::total_cmp);
    all
}

/// Largest relative error of the (lowest, highest) three frequencies of each nodal diameter.
fn errors(hub: [f64; 3], tip: [f64; 3]) -> Result<[f64; 2], AnalysisError> {
    let reduced = prepare(&sector(hub, tip), 3, None, &NoCheckpoints, &Unwatched)?;
    let modal = ModalWheel::at(&reduced.wheel, 100.0, RotationEffects::stiffening(false))?;
    let mut worst = [0.0f64; 2];
    for harmonic in &modal.harmonics {
        let all = expected(hub, tip, harmonic.harmonic);
        for (m, (omega, square)) in harmonic.omega.iter().zip(all).enumerate() {
            worst[m / 3] = worst[m / 3].max((omega / square.sqrt() - 1.0).abs());
        }
    }
    Ok(worst)
}

#[test]
fn frequencies_are_as_good_as_the_matrix_entries() {
    for contrast in [1024.0, 8_388_608.0, CONTRAST] {
        let stiff = SOFT.map(|k| k * contrast);
        for (hub, tip) in [(SOFT, stiff), (stiff, SOFT)] {
            let [low, high] = errors(hub, tip).unwrap();
            assert!(low < 4.0 * f64::EPSILON * contrast, "{contrast:e}, hub {hub:?}: {low:e}");
            assert!(high < 1e-14, "{contrast:e}, hub {hub:?}: {high:e}");
        }
    }
}

/// Contrasts from those that cost half the digits to those that leave none: the same bound, or a refusal.
#[test]
fn beyond_double_precision_frequencies_are_right_or_refused() {
    for exponent in [36, 38, 40, 44, 48, 50, 52, 53, 56, 64, 100, 300] {
        let contrast = f64::from(exponent).exp2();
        let stiff = SOFT.map(|k| k * contrast);
        for (hub, tip) in [(SOFT, stiff), (stiff, SOFT)] {
            match errors(hub, tip) {
                Ok([low, high]) => {
                    assert!(low < 4.0 * f64::EPSILON * contrast && low < 1e-3, "2^{exponent}: {low:e}");
                    assert!(high < 1e-14, "2^{exponent}: {high:e}");
                }
                Err(error) => assert!(matches!(error, AnalysisError::Model(_)), "{error:?}"),
            }
        }
    }
}

#[test]
fn the_sweep_runs() {
    let stiff = SOFT.map(|k| k * CONTRAST);
    for scheme in SCHEMES {
        for (hub, tip) in [(SOFT, stiff), (stiff, SOFT)] {
            let sector = sector(hub, tip);
            let reduced = reduced(&sector, 3);
            let lowest = expected(hub, tip, 0)[0].sqrt();
            let changes = json!({"integration": {"revolutions": 3, "window_revolutions": 1}, "scene": {"casing": {"lobes": {"width_rad": 0.8}}}});
            let request = sweep(&sector, scheme, &[0.4 * lowest], changes);
            for result in run(&reduced, &request) {
                assert_sound(&result, 1.0);
                assert!(result.point.contact_share > 0.0);
            }
        }
    }
}
