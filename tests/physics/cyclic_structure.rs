//! Nodal diameters and reduction against the explicitly assembled wheel.

use rubmap::dynamics::error::ModelError;
use rubmap::dynamics::modal_wheel::{ModalWheel, RotationEffects, natural_frequencies};
use rubmap::dynamics::reduction::{NoCheckpoints, ReductionError, ReductionOptions, reduce};
use rubmap::dynamics::sector::SectorModel;

use crate::fixtures::{TOP_SPEED, WheelRecipe, assembled_wheel, eigenvalues, wheel};

/// Squares ω² of the wheel's nodal diameters, pairs twice, ascending.
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

/// Complete basis: with every fixed-interface mode kept the reduction is a change of basis, and each nodal diameter's
/// frequencies are those of the assembled wheel, at rest, at the given speeds and between them.
#[test]
fn complete_basis_reproduces_the_assembled_wheel() {
    for (sectors, stiffening) in
        [(1, true), (2, false), (3, true), (4, true), (7, true), (10, true), (10, false)]
    {
        let sector = wheel(WheelRecipe { sectors, stiffening, ..Default::default() });
        let reduced = reduce(&sector, &ReductionOptions::new(1000), &NoCheckpoints, &|_, _| true).unwrap();
        let mass = assembled_wheel(&sector.mass, sectors);
        for share in [0.0, 0.3, 0.5, 0.8, 1.0] {
            let speed = share * TOP_SPEED;
            let found =
                squares(&ModalWheel::at(&reduced, speed, RotationEffects::stiffening(stiffening)).unwrap());
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

/// Truncated basis: it bounds every frequency from above (Rayleigh–Ritz) and converges with the modes kept.
#[test]
fn truncated_basis_converges_from_above() {
    let sector = wheel(WheelRecipe { nodes: 40, ..Default::default() });
    let exact = reduce(&sector, &ReductionOptions::new(1000), &NoCheckpoints, &|_, _| true).unwrap();
    let mut last = f64::INFINITY;
    for modes in [1, 4, 16] {
        let reduced = reduce(&sector, &ReductionOptions::new(modes), &NoCheckpoints, &|_, _| true).unwrap();
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

/// Wheel that hangs on nothing: without ground springs the wheel of translated springs floats, and its three
/// translations are three modes of nodal diameter 0. The refusal names them and asks about the hub.
#[test]
fn a_wheel_that_hangs_on_nothing_is_refused() {
    let sector = wheel(WheelRecipe { ground: 0.0, stiffening: false, ..Default::default() });
    let error = reduce(&sector, &ReductionOptions::new(5), &NoCheckpoints, &|_, _| true).unwrap_err();
    let expected = ModelError::RigidBodyModes { nodal_diameter: 0, speed_rad_s: 0.0, modes: 3 };
    assert_eq!(error, ReductionError::Model(expected));
    assert!(error.to_string().contains("is the hub constrained"));
}

/// Node almost without mass: it puts a mode at the far end of the spectrum; the lowest modes must not notice.
#[test]
fn a_nearly_massless_node_leaves_the_lowest_modes_alone() {
    let recipe = WheelRecipe { nodes: 20, ..Default::default() };
    let lowest = |factor: f64| {
        let mut parts = wheel(recipe).into_parts();
        // The fixture's mass is diagonal, one entry a column.
        parts.mass.own.val_mut()[9..12].iter_mut().for_each(|value| *value *= factor);
        let sector = SectorModel::new(parts).unwrap();
        let reduced = reduce(&sector, &ReductionOptions::new(12), &NoCheckpoints, &|_, _| true).unwrap();
        let found = natural_frequencies(&reduced.harmonics[2], 0.0, true).unwrap();
        found[..3].to_vec()
    };
    let (light, massless) = (lowest(1e-6), lowest(1e-12));
    for (a, b) in light.iter().zip(&massless) {
        assert!((a / b - 1.0).abs() < 1e-5, "{light:?} {massless:?}");
    }
}
