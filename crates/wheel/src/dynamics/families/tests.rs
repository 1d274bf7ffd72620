//! Families followed on matrices whose branches have closed forms.

use std::f64::consts::TAU;

use super::*;
use crate::dynamics::centrifugal::StiffnessPolynomial;
use crate::dynamics::reduction::{InterpolationCheck, InterpolationVerdict, ReducedHarmonic};

use crate::response::veerings::{Course, Veering, veerings};

/// Highest speed of the matrices, rad/s.
const TOP: f64 = 240.0;

/// Wheel of four sectors whose nodal diameter 1 has M = TᴴT and K = Tᴴ(D0 + Ω²D1)T, T far from orthonormal.
fn wheel<const N: usize>(rest: [[f64; N]; N], growth: [[f64; N]; N]) -> ReducedWheel {
    let turned =
        |i: usize, j: usize| c64::new((1.0 + (3 * i + j) as f64).sin(), (2.0 * (i * j) as f64).cos());
    let t = Mat::from_fn(N, N, |i, j| turned(i, j) + if i == j { c64::new(3.0, 0.0) } else { c64::ZERO });
    let of = |d: &[[f64; N]; N]| {
        let full = t.adjoint() * (Mat::from_fn(N, N, |i, j| c64::new(d[i][j], 0.0)) * &t);
        Mat::from_fn(N, N, |i, j| (full[(i, j)] + full[(j, i)].conj()) * 0.5)
    };
    let identity: [[f64; N]; N] = std::array::from_fn(|i| std::array::from_fn(|j| f64::from(i == j)));
    let harmonic = |harmonic| ReducedHarmonic {
        harmonic,
        mass: of(&identity),
        stiffness: StiffnessPolynomial { coefficients: vec![of(&rest), of(&growth), Mat::zeros(N, N)] },
        gyroscopic: None,
        certificates: Vec::new(),
    };
    ReducedWheel {
        sectors: 4,
        contact: Vec::new(),
        speeds_rad_s: vec![0.0, 0.5 * TOP, TOP],
        harmonics: vec![harmonic(0), harmonic(1), harmonic(2)],
        interpolation: InterpolationCheck {
            verdict: InterpolationVerdict::Sound,
            linear_ratio: 0.0,
            quadratic_ratio: 0.0,
            frequency_error: 0.0,
        },
        comparison: Vec::new(),
    }
}

/// Wheel whose eigenvalues are those of [[p, c], [c, q]] with p = 100² + 1.5Ω², q = 180²: without coupling they are equal at Ω² = 22400/1.5.
fn coupled(c: f64) -> ReducedWheel {
    wheel([[1e4, c], [c, 3.24e4]], [[1.5, 0.0], [0.0, 0.0]])
}

/// Speed at which p = q.
fn meeting() -> f64 {
    (2.24e4_f64 / 1.5).sqrt()
}

fn ranks(wheel: &ReducedWheel, speeds: &[f64]) -> Vec<FamilyModes> {
    let mut walk = FamilyWalk::new(wheel, 1, true).unwrap();
    speeds.iter().map(|&speed| walk.at(speed).unwrap()).collect()
}

fn found(wheel: &ReducedWheel) -> Vec<Veering> {
    let grid = grid(wheel, true, TOP);
    let omega = |speed: f64| {
        let pairs = mode_pairs(wheel, 1, speed, true).ok()?;
        Some(pairs.values.iter().map(|lambda| lambda.sqrt()).collect())
    };
    veerings(&grid, &ranks(wheel, &grid), 1, 2, omega)
}

#[test]
fn uncoupled_families_cross() {
    let wheel = coupled(0.0);
    let speeds: Vec<f64> = (0..=48).map(|i| 5.0 * f64::from(i)).collect();
    for (speed, modes) in speeds.iter().zip(ranks(&wheel, &speeds)) {
        let expected = [(1e4 + 1.5 * speed * speed).sqrt(), 180.0];
        for (family, omega) in expected.into_iter().enumerate() {
            let got = modes.omega[modes.ranks[family]];
            assert!((got / omega - 1.0).abs() < 1e-10, "{speed}: {got} is not {omega}");
            assert!(modes.assurance[family] > 1.0 - 1e-9);
        }
    }
    let [Veering { families: [1, 2], speed_rad_s, frequency_hz, course: Course::Crosses, .. }] =
        found(&wheel)[..]
    else {
        panic!("{:?}", found(&wheel))
    };
    assert!((speed_rad_s / meeting() - 1.0).abs() < 1e-7);
    assert!((frequency_hz * TAU / 180.0 - 1.0).abs() < 1e-7);
}

/// A crossing at a speed of the grid, where the modes are any mixture of both, is passed like all others.
#[test]
fn crossings_on_the_grid_are_passed() {
    // Twelve of 24 steps.
    let at = 0.5 * TOP;
    let wheel = wheel([[1e4, 0.0], [0.0, 1e4 + 0.7 * at * at]], [[0.9, 0.0], [0.0, 0.2]]);
    let modes = ranks(&wheel, &[0.0, 0.45 * TOP, 0.55 * TOP, TOP]);
    assert_eq!(modes.iter().map(|modes| modes.ranks[0]).collect::<Vec<_>>(), [0, 0, 1, 1]);
    assert!(matches!(found(&wheel)[..], [Veering { course: Course::Crosses, .. }]));
}

/// Branches ½(p + q) ± √(¼(p − q)² + c²) of a veering are closest near p = q, where their squares differ by 2c.
#[test]
fn veerings_are_where_the_closed_form_has_them() {
    for (c, expected) in [(40.0, Course::Exchanges), (1500.0, Course::Stays)] {
        let wheel = coupled(c);
        let [Veering { families: [1, 2], speed_rad_s, distance_hz, course, .. }] = found(&wheel)[..] else {
            panic!("{c}: {:?}", found(&wheel))
        };
        assert_eq!(course, expected);
        // The minimum of √λ₂ − √λ₁ by the closed form, on a fine grid of speeds.
        let gap = |speed: f64| {
            let (p, q) = (1e4 + 1.5 * speed * speed, 3.24e4);
            let root = (0.25 * (p - q) * (p - q) + c * c).sqrt();
            ((0.5 * (p + q) + root).sqrt() - (0.5 * (p + q) - root).sqrt()) / TAU
        };
        let fine = (0..400_000).map(|i| meeting() * (0.9 + 5e-7 * f64::from(i)));
        let least = fine.min_by(|a, b| gap(*a).total_cmp(&gap(*b))).unwrap();
        assert!((speed_rad_s / least - 1.0).abs() < 2e-6, "{speed_rad_s} is not {least}");
        // A small difference of frequencies that are known to 1e-13.
        assert!((distance_hz / gap(least) - 1.0).abs() < 1e-7, "{distance_hz} is not {}", gap(least));
        let last = ranks(&wheel, &[TOP]).remove(0);
        assert_eq!(last.ranks, if expected == Course::Exchanges { [1, 0] } else { [0, 1] });
    }
}

/// In the first step of the grid shapes are compared with those at rest: the assurance is cos² of the angle by which the closed form turns.
#[test]
fn assurance_is_that_of_the_closed_form() {
    let (c, speed) = (3000.0, 9.0);
    let angle = |speed: f64| 0.5 * f64::atan2(2.0 * c, 3.24e4 - 1e4 - 1.5 * speed * speed);
    let expected = (angle(speed) - angle(0.0)).cos().powi(2);
    let modes = ranks(&coupled(c), &[speed]).remove(0);
    for assurance in modes.assurance {
        assert!((assurance - expected).abs() < 1e-12, "{assurance} is not {expected}");
    }
}

#[test]
fn names_do_not_depend_on_the_speeds_that_are_asked_for() {
    let wheel = wheel(
        [[1e4, 30.0, 10.0], [30.0, 1.6e4, 80.0], [10.0, 80.0, 3e4]],
        [[1.5, 0.0, 0.0], [0.0, 0.8, 0.0], [0.0, 0.0, 0.1]],
    );
    let many: Vec<f64> = (0..=97).map(|i| 2.5 * f64::from(i)).collect();
    let together = ranks(&wheel, &many);
    assert_ne!(together[0].ranks, together[97].ranks);
    for (speed, modes) in many.iter().zip(together) {
        assert_eq!(ranks(&wheel, &[*speed])[0], modes, "{speed}");
    }
}

/// A stiffness that is taken at rest, or is known at one speed alone, leaves all names at their ranks.
#[test]
fn without_stiffening_families_are_ranks() {
    let mut wheel = coupled(0.0);
    let still = FamilyWalk::new(&wheel, 1, false).unwrap().at(TOP).unwrap();
    assert_eq!(still.ranks, [0, 1]);
    wheel.speeds_rad_s = vec![0.0];
    assert_eq!(grid(&wheel, true, TOP), [0.0]);
}
