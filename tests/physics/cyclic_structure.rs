//! Nodal diameters and reduction against the explicitly assembled wheel.

use rubmap::dynamics::modal_wheel::{ModalWheel, natural_frequencies};
use rubmap::dynamics::reduction::{ReductionOptions, reduce};

use crate::fixtures::{TOP_SPEED, WheelRecipe, assembled_wheel, eigenvalues, wheel};

/// All ω² of the wheel's nodal diameters, pairs twice, ascending.
fn squares(wheel: &ModalWheel) -> Vec<f64> {
    let mut all: Vec<f64> = wheel
        .harmonics
        .iter()
        .flat_map(|h| {
            let copies = if h.single { 1 } else { 2 };
            h.omega.iter().flat_map(move |w| vec![w * w; copies])
        })
        .collect();
    all.sort_by(f64::total_cmp);
    all
}

/// With every fixed-interface mode kept the reduction is a change of basis: each nodal diameter's frequencies are
/// those of the assembled wheel, at rest, at the given speeds and between them.
#[test]
fn complete_basis_reproduces_the_assembled_wheel() {
    for (sectors, stiffening) in
        [(1, true), (2, false), (3, true), (4, true), (7, true), (10, true), (10, false)]
    {
        let sector = wheel(WheelRecipe { sectors, stiffening, ..Default::default() });
        let reduced = reduce(&sector, &ReductionOptions::new(1000), &|_, _| true).unwrap();
        let mass = assembled_wheel(&sector.mass, sectors);
        for share in [0.0, 0.3, 0.5, 0.8, 1.0] {
            let speed = share * TOP_SPEED;
            let found = squares(&ModalWheel::at(&reduced, speed, stiffening).unwrap());
            // The fixture's K is linear in Ω².
            let blend = |matrices: &[nalgebra::DMatrix<f64>]| {
                if stiffening {
                    &matrices[0] + (&matrices[2] - &matrices[0]) * share.powi(2)
                } else {
                    matrices[0].clone()
                }
            };
            let given: Vec<_> = sector.stiffness.iter().map(|k| assembled_wheel(k, sectors)).collect();
            let expected = eigenvalues(&blend(&given), &mass);
            assert_eq!(found.len(), expected.len(), "{sectors} sectors");
            for (a, b) in found.iter().zip(&expected) {
                assert!((a / b - 1.0).abs() < 1e-9, "{sectors} sectors at {speed}: {a} {b}");
            }
        }
    }
}

/// A truncated basis bounds every frequency from above (Rayleigh–Ritz) and converges with the modes kept.
#[test]
fn truncated_basis_converges_from_above() {
    let sector = wheel(WheelRecipe { nodes: 40, ..Default::default() });
    let exact = reduce(&sector, &ReductionOptions::new(1000), &|_, _| true).unwrap();
    let mut last = f64::INFINITY;
    for modes in [1, 4, 16] {
        let reduced = reduce(&sector, &ReductionOptions::new(modes), &|_, _| true).unwrap();
        let mut worst: f64 = 0.0;
        for (a, b) in reduced.harmonics.iter().zip(&exact.harmonics) {
            for speed in [0.0, 0.37 * TOP_SPEED, TOP_SPEED] {
                let (a, b) = (
                    natural_frequencies(a, speed, true).unwrap(),
                    natural_frequencies(b, speed, true).unwrap(),
                );
                for (a, b) in a.iter().zip(&b).take(4) {
                    assert!(a / b > 1.0 - 1e-9, "{a} {b}");
                    worst = worst.max(a / b - 1.0);
                }
            }
        }
        assert!(worst < last, "{modes} modes: {worst} after {last}");
        last = worst;
    }
    // Sixteen of 111 internal modes per speed hold the first four frequencies within the paper's 1 %.
    assert!(last < 0.01, "{last}");
}

/// Equal stiffness at the three speeds: the joint basis has rank k, and nothing breaks.
#[test]
fn equal_stiffness_matrices_leave_a_basis_of_rank_k() {
    let mut sector = wheel(WheelRecipe { nodes: 40, ..Default::default() });
    let rest = sector.stiffness[0].clone();
    sector.stiffness = vec![rest.clone(), rest.clone(), rest];
    let reduced = reduce(&sector, &ReductionOptions::new(8), &|_, _| true).unwrap();
    for harmonic in &reduced.harmonics {
        assert_eq!(harmonic.mass.nrows(), 9 + 8);
    }
}

/// A free rotor has no K_ii⁻¹; the refusal names the nodal diameter and asks about the hub.
#[test]
fn a_sector_that_hangs_on_nothing_is_refused() {
    let mut sector = wheel(WheelRecipe::default());
    for value in sector.stiffness[0].own.val_mut() {
        *value = -*value;
    }
    let error = reduce(&sector, &ReductionOptions::new(5), &|_, _| true).unwrap_err().to_string();
    assert!(error.contains("nodal diameter 0") && error.contains("hub"), "{error}");
}
