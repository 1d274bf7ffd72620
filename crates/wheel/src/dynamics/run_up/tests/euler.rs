//! Euler force against a Runge–Kutta integration of z̈ + 2ζωż + Ωgż + (ω² + ½Ω̇g)z = Ω̇f.

use faer::{Mat, c64};

use super::super::profile::SpeedProfile;
use super::super::segments::Cutting;
use super::{nodes, untouched};
use crate::dynamics::effects::Effects;
use crate::dynamics::euler::{EulerForce, SpeedRate, StraightRate};
use crate::dynamics::initial::InitialMode;
use crate::dynamics::integrate::{Part, Simulation};
use crate::dynamics::modal_wheel::{ModalHarmonic, ModalWheel};
use crate::dynamics::numbers::Numbers;
use crate::dynamics::oscillators::ModalDamping;
use crate::dynamics::schemes::Scheme;

const MODES: usize = 3;
const ZETA: f64 = 0.01;
const SAMPLES: usize = 960;
const LOAD: [f64; MODES] = [0.7, -0.4, 0.2];
const OMEGA: [[f64; MODES]; 2] = [[60.0, 150.0, 400.0], [70.0, 190.0, 430.0]];

/// Displacement and velocity of every mode of the nodal diameters 0 and 1.
type State = [[[c64; 2]; MODES]; 2];

fn gyroscopic() -> [Mat<c64>; 2] {
    let mut numbers = Numbers(0x9E37_79B9_7F4A_7C15);
    [true, false].map(|single| {
        let any = Mat::from_fn(MODES, MODES, |_, _| {
            c64::new(numbers.next(), if single { 0.0 } else { numbers.next() })
        });
        Mat::from_fn(MODES, MODES, |i, j| any[(i, j)] - any[(j, i)].conj())
    })
}

fn wheel(speed_rad_s: f64, turning: bool) -> ModalWheel {
    let harmonics = gyroscopic().into_iter().enumerate().map(|(harmonic, g)| ModalHarmonic {
        harmonic,
        single: harmonic == 0,
        omega: OMEGA[harmonic].to_vec(),
        contact: Mat::from_fn(3, MODES, |row, m| c64::from((1 + row + m) as f64)),
        gyroscopic: turning.then_some(g),
    });
    ModalWheel { speed_rad_s, sectors: 3, repeats: 1, harmonics: harmonics.collect() }
}

fn start() -> State {
    let mut state = State::default();
    state[1][0] = [c64::new(0.02, -0.01), c64::new(0.3, 0.8)];
    state
}

/// State at the end of the profile, stepped by segments.
fn stepped(profile: &SpeedProfile, scheme: Scheme, turning: bool, tolerance_rad: f64) -> (State, f64) {
    let cutting = Cutting {
        samples_per_revolution: SAMPLES,
        tolerance_rad,
        frame_revolutions: 64,
        band_ratio: 10.0,
        most_segments: 100_000,
    };
    let nodes = nodes();
    let damping = ModalDamping { modal_ratio: ZETA, family_ratios: Vec::new(), ranks: Vec::new() };
    let mut modes = Vec::new();
    let begun = start();
    for (harmonic, of) in begun.iter().enumerate() {
        for (family, [displacement, velocity]) in of.iter().copied().enumerate() {
            modes.push(InitialMode { harmonic, family, displacement, velocity });
        }
    }
    let mut end_s = 0.0;
    for segment in cutting.segments(profile).unwrap() {
        let wheel = wheel(segment.speed_rad_s, turning);
        let force = EulerForce { rate: profile.rates(segment.times_s), load: LOAD.to_vec() };
        let effects = Effects { euler_force: Some(&force), ..Effects::default() };
        let of = untouched(&wheel, &nodes[..1], &damping, effects, &modes, 4 * SAMPLES, SAMPLES);
        let stretch = Simulation { scheme, ..of }
            .stretch(Part { first_sample: segment.first_sample, samples: segment.samples }, &|_| true);
        assert_eq!(stretch.ended, None);
        assert!(stretch.energy.residual() < 1e-9, "{}", stretch.energy.residual());
        (modes, end_s) = (stretch.end, segment.times_s[1]);
    }
    let mut state = State::default();
    for mode in modes {
        state[mode.harmonic][mode.family] = [mode.displacement, mode.velocity];
    }
    (state, end_s)
}

/// State at `end_s` by Runge–Kutta; `share` of the Euler force acts on the vibration.
fn integrated(profile: &SpeedProfile, turning: bool, share: f64, end_s: f64) -> State {
    let g = gyroscopic();
    let derivative = |t: f64, state: &State| {
        let (speed, rate) = (profile.speed_rad_s(t), profile.rate_rad_s2(t));
        let mut out = State::default();
        for harmonic in 0..2 {
            for m in 0..MODES {
                let ([z, v], omega) = (state[harmonic][m], OMEGA[harmonic][m]);
                let mut force = -v * (2.0 * ZETA * omega) - z * (omega * omega);
                if harmonic == 0 {
                    force += c64::from(rate * LOAD[m]);
                }
                for n in (0..MODES).filter(|_| turning) {
                    let [z, v] = state[harmonic][n];
                    force -= g[harmonic][(m, n)] * (v * speed + z * (0.5 * share * rate));
                }
                out[harmonic][m] = [v, force];
            }
        }
        out
    };
    let along = |state: &State, step: f64, slope: &State| {
        let mut moved = *state;
        for (to, by) in moved.as_flattened_mut().iter_mut().zip(slope.as_flattened()) {
            *to = [to[0] + by[0] * step, to[1] + by[1] * step];
        }
        moved
    };
    let steps = 40_000;
    let h = end_s / f64::from(steps);
    let mut state = start();
    for step in 0..steps {
        let t = f64::from(step) * h;
        let a = derivative(t, &state);
        let b = derivative(t + 0.5 * h, &along(&state, 0.5 * h, &a));
        let c = derivative(t + 0.5 * h, &along(&state, 0.5 * h, &b));
        let d = derivative(t + h, &along(&state, h, &c));
        for (slope, weight) in [(a, 1.0), (b, 2.0), (c, 2.0), (d, 1.0)] {
            state = along(&state, weight * h / 6.0, &slope);
        }
    }
    state
}

/// Largest difference of displacements, over the largest.
fn off(found: &State, expected: &State) -> f64 {
    let pairs = || found.as_flattened().iter().zip(expected.as_flattened());
    let largest =
        |of: &dyn Fn(&[c64; 2], &[c64; 2]) -> f64| pairs().map(|(a, b)| of(a, b)).fold(0.0, f64::max);
    largest(&|a, b| (a[0] - b[0]).norm()) / largest(&|_, b| b[0].norm())
}

/// Euler force while speeding up and slowing down, straight and smoothly, with and without Coriolis forces: of second order in the length
/// of the pieces.
#[test]
fn the_euler_force_is_that_of_the_rotating_frame() {
    let points = [(0.0, 60.0), (0.05, 110.0), (0.1, 200.0), (0.15, 80.0)];
    let profiles = [SpeedProfile::smooth(&points), SpeedProfile::linear(&points)];
    let all = Scheme::MasslessBoundary { kept_modes: MODES };
    for (profile, scheme) in profiles.iter().flat_map(|profile| {
        [Scheme::ExactModal, Scheme::CentralDifferences, all].map(|scheme| (profile, scheme))
    }) {
        for turning in [false, true] {
            let ((coarse, end_s), (fine, _)) =
                (stepped(profile, scheme, turning, 4e-4), stepped(profile, scheme, turning, 1e-4));
            let exact = integrated(profile, turning, 1.0, end_s);
            let errors = [off(&coarse, &exact), off(&fine, &exact)];
            assert!(errors[1] < 1e-3, "{scheme:?} {turning}: {errors:?}");
            if turning {
                // A corner lies within a step.
                assert!(errors[1] < 0.4 * errors[0] || errors[1] < 1e-4, "{errors:?}");
                let without = off(&integrated(profile, turning, 0.0, end_s), &exact);
                assert!(without > 20.0 * errors[1], "{without} {errors:?}");
            }
        }
    }
}

/// Heavily damped mode, many times faster than the steps, that follows, has no past that is handed on, and drives no other by Coriolis
/// forces: energies are those of a static load, however often the run is cut.
#[test]
fn what_follows_is_handed_on_without_a_blow() {
    let omega = [10.0, 40_000.0];
    let gyroscopic = Mat::from_fn(2, 2, |i, j| c64::from(0.01 * (j as f64 - i as f64)));
    let harmonic = ModalHarmonic {
        harmonic: 0,
        single: true,
        omega: omega.to_vec(),
        contact: Mat::from_fn(3, 2, |_, _| c64::ONE),
        gyroscopic: Some(gyroscopic),
    };
    let wheel = ModalWheel { speed_rad_s: 100.0, sectors: 1, repeats: 1, harmonics: vec![harmonic] };
    let nodes = nodes();
    let damping = ModalDamping { modal_ratio: 0.2, family_ratios: Vec::new(), ranks: Vec::new() };
    // Only the fast mode is loaded, by a rate of 1.
    let rate = SpeedRate(vec![StraightRate { revolutions: [0.0, 10.0], rad_s2: [1.0; 2] }]);
    let load = vec![0.0, omega[1].powi(2)];
    let force = EulerForce { rate, load };
    let mut modes = vec![InitialMode { harmonic: 0, family: 1, displacement: c64::ONE, velocity: c64::ZERO }];
    for part in 0..20 {
        let effects = Effects { euler_force: Some(&force), ..Effects::default() };
        // ωh = 10.5.
        let stretch = untouched(&wheel, &nodes[..1], &damping, effects, &modes, 240, 24)
            .stretch(Part { first_sample: 12 * part, samples: 12 }, &|_| true);
        modes = stretch.end;
        let still = 0.5 * omega[1].powi(2);
        assert!((stretch.energy.largest_energy() / still - 1.0).abs() < 1e-6, "{:?}", stretch.energy);
        assert!(
            (modes[1].displacement.re - 1.0).abs() < 1e-6 && modes[0].displacement.norm() < 1e-4,
            "{modes:?}"
        );
    }
}
