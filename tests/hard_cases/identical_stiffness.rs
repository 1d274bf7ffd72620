//! Stiffness that is the same at all three speeds: the three sets of fixed-interface modes are one set three times over.
//!
//! Codes that orthogonalise without looking at the rank divide by round-off here and carry 2k directions of noise as
//! the stiffest modes of the wheel. Guaranteed: rank k, no trace of K1 and K2, and the sweep that the package with
//! that stiffness alone gives.

use rubmap::dynamics::modal_wheel::{ModalWheel, RotationEffects};
use rubmap::dynamics::sector::{SectorModel, SectorParts};
use serde_json::json;

use crate::fixtures::{TOP_SPEED, WheelRecipe, wheel};
use crate::support::{SCHEMES, assert_sound, reduced, run, spectral_difference, sweep};

const MODES: u32 = 8;

/// Sectors of one wheel with its stiffness at rest given once, and given three times.
fn once_and_thrice() -> (SectorModel, SectorModel) {
    let mut thrice = wheel(WheelRecipe { nodes: 40, ..Default::default() }).into_parts();
    let rest = thrice.stiffness[0].clone();
    let once = SectorParts { stiffness: vec![rest.clone()], speeds_rad_s: vec![0.0], ..thrice.clone() };
    thrice.stiffness = vec![rest.clone(), rest.clone(), rest];
    (SectorModel::new(once).unwrap(), SectorModel::new(thrice).unwrap())
}

#[test]
fn the_basis_has_rank_k() {
    let (once, thrice) = once_and_thrice();
    let (once, thrice) = (reduced(&once, MODES), reduced(&thrice, MODES));
    assert_eq!(once.report.unknowns, thrice.report.unknowns);
    for harmonic in &thrice.wheel.harmonics {
        assert_eq!(harmonic.mass.nrows(), 9 + MODES as usize);
        for coefficient in &harmonic.stiffness.coefficients[1..] {
            assert_eq!(coefficient.norm_max(), 0.0, "differences of equal matrices");
        }
    }
    for share in [0.0, 0.3, 1.0] {
        let (a, b) = (
            ModalWheel::at(&once.wheel, share * TOP_SPEED, RotationEffects::stiffening(false)).unwrap(),
            ModalWheel::at(&thrice.wheel, share * TOP_SPEED, RotationEffects::stiffening(true)).unwrap(),
        );
        for (a, b) in a.harmonics.iter().zip(&b.harmonics) {
            for (a, b) in a.omega.iter().zip(&b.omega) {
                // The bases differ by the residual of the modes, 1e-9; frequencies by its square, and round-off.
                assert!((a / b - 1.0).abs() < 1e-10, "{a} {b}");
            }
        }
    }
}

#[test]
fn the_sweep_is_that_of_a_single_stiffness() {
    let (once, thrice) = once_and_thrice();
    let (of_one, of_three) = (reduced(&once, MODES), reduced(&thrice, MODES));
    for scheme in SCHEMES {
        let speeds = [0.4 * TOP_SPEED, 0.9 * TOP_SPEED];
        let changes = json!({"modes_per_speed": MODES});
        let a = run(&of_one, &sweep(&once, scheme, &speeds, changes.clone()));
        let b = run(&of_three, &sweep(&thrice, scheme, &speeds, changes));
        for (a, b) in a.iter().zip(&b) {
            assert_sound(a, 1.0);
            assert_sound(b, 1.0);
            assert!(a.point.contact_share > 0.01);
            assert_eq!(a.point.steps_per_revolution, b.point.steps_per_revolution);
            let difference = spectral_difference(a, b);
            assert!(difference < 1e-7, "{scheme}: {difference:e}");
        }
    }
}
