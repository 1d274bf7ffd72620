//! Closed forms: the literal model, and the production code beside it, against solutions that are known.

use std::f64::consts::TAU;

use faer::{Mat, c64, mat};
use rubmap::dynamics::direction::Direction;
use rubmap::dynamics::excitation::EngineOrderExcitation;
use rubmap::dynamics::initial::InitialMode;
use rubmap::dynamics::modal_wheel::{ModalHarmonic, ModalWheel};
use rubmap::dynamics::oscillators::ModalDamping;
use rubmap::dynamics::schemes::Scheme;

use crate::literal::Literal;
use crate::scene::{SPEED, Scene, difference, history};

const SCHEMES: [Scheme; 3] =
    [Scheme::CentralDifferences, Scheme::ExactModal, Scheme::MasslessBoundary { kept_modes: usize::MAX }];

/// Histories of the production code and of the literal model.
fn both(scene: &Scene) -> [Vec<Vec<f64>>; 2] {
    [history(&scene.run()).displacement.clone(), Literal::new(scene).run().displacement]
}

/// Asserts that errors of both models against `solution(sensor, t)` fall fourfold when the step is halved.
fn second_order(scene: &Scene, solution: impl Fn(usize, f64) -> f64) {
    for scheme in SCHEMES {
        let error = |steps: usize| {
            let scene = Scene { steps, samples: 300, scheme, ..scene.clone() };
            let time = |sample: usize| TAU / SPEED * (sample + 1) as f64 / 300.0;
            let line =
                |sensor: usize| (0..300 * scene.revolutions).map(|q| solution(sensor, time(q))).collect();
            let exact: Vec<Vec<f64>> = (0..scene.sensors.len()).map(line).collect();
            both(&scene).map(|found| difference(&found, &exact))
        };
        let (coarse, fine) = (error(900), error(1800));
        for (coarse, fine) in coarse.into_iter().zip(fine) {
            assert!(coarse < 1e-2, "{scheme:?}: {coarse:e}");
            // The error is round-off where the scheme is exact.
            assert!(coarse < 1e-10 || (coarse / fine - 4.0).abs() < 0.1, "{scheme:?}: {coarse:e} {fine:e}");
        }
    }
}

fn one_node(sectors: usize, harmonics: Vec<ModalHarmonic>) -> ModalWheel {
    ModalWheel { speed_rad_s: SPEED, sectors, repeats: 1, harmonics }
}

fn mode(harmonic: usize, displacement: c64, velocity: c64) -> InitialMode {
    InitialMode { harmonic, family: 0, displacement, velocity }
}

/// Rotating mass m(ẍ − 2Ωẏ − Ω²x) + kx = 0, and y alike: ω = |ω0 ∓ Ω|, released at rest in the rotating frame.
#[test]
fn a_rotating_mass_swings_as_seen_from_outside() {
    let omega0 = 3.3 * SPEED;
    let omega = (omega0 * omega0 - SPEED * SPEED).sqrt();
    let contact =
        mat![[c64::new(1.0, 0.0), c64::ZERO], [c64::ZERO, c64::new(1.0, 0.0)], [c64::ZERO, c64::ZERO]];
    let g = mat![[c64::ZERO, c64::new(-2.0, 0.0)], [c64::new(2.0, 0.0), c64::ZERO]];
    let harmonic =
        ModalHarmonic { harmonic: 0, single: true, omega: vec![omega; 2], contact, gyroscopic: Some(g) };
    let wheel = one_node(1, vec![harmonic]);
    let mut scene = Scene::free(wheel, vec![mode(0, c64::new(0.5, 0.0), c64::ZERO)]);
    let sensor = scene.sensors[0];
    let tangential = Direction { node: 0, components: [0.0, 1.0, 0.0] };
    scene.sensors.push(rubmap::dynamics::integrate::SensorRow { direction: tangential, ..sensor });
    second_order(&scene, |sensor, t| {
        let (fast, slow) = (omega0 + SPEED, omega0 - SPEED);
        let z = c64::cis(slow * t) * (fast / (2.0 * omega0)) + c64::cis(-fast * t) * (slow / (2.0 * omega0));
        0.5 * if sensor == 0 { z.re } else { z.im }
    });
}

/// Coriolis forces with g = jγ: forward and backward waves at −Ωγ/2 ± √((Ωγ/2)² + ω²), eigenvalues of [[0, ω], [−ω, −Ωg]].
#[test]
fn coriolis_forces_split_travelling_waves() {
    let (omega, gamma) = (2.7 * SPEED, 0.8);
    let shape = |size: f64| Mat::from_fn(3, 1, |d, _| c64::new(if d == 0 { size } else { 0.0 }, 0.0));
    for sectors in [4, 5] {
        let harmonics = (0..=sectors / 2).map(|harmonic| ModalHarmonic {
            harmonic,
            single: harmonic == 0 || 2 * harmonic == sectors,
            omega: vec![omega],
            contact: shape(1.0),
            gyroscopic: (harmonic == 1).then(|| mat![[c64::new(0.0, gamma)]]),
        });
        let mut wheel = one_node(sectors, harmonics.collect());
        for harmonic in &mut wheel.harmonics {
            harmonic.gyroscopic.get_or_insert_with(|| Mat::zeros(1, 1));
        }
        let middle = -0.5 * SPEED * gamma;
        let spread = middle.hypot(omega);
        let (a, b) = (middle + spread, middle - spread);
        let alpha = TAU / sectors as f64;
        let weight = (2.0 / sectors as f64).sqrt();
        let moves = |z: c64, s: usize| weight * (z * c64::cis(alpha * s as f64)).re;
        // Both waves swing if released at rest, one alone with the velocity of its eigenvector.
        let start = c64::new(0.3, 0.1);
        let standing = Scene::free(wheel.clone(), vec![mode(1, start, c64::ZERO)]);
        second_order(&standing, |s, t| {
            moves(start * (c64::cis(b * t) * a - c64::cis(a * t) * b) / (a - b), s)
        });
        for lambda in [a, b] {
            let scene = Scene::free(wheel.clone(), vec![mode(1, start, c64::new(0.0, lambda) * start)]);
            second_order(&scene, |s, t| moves(start * c64::cis(lambda * t), s));
        }
    }
}

/// Mistuned pair of sectors with deviations δ and −δ: λ = (ω0² + ω1²)/2 ± √((ω1² − ω0²)²/4 + (ω0 ω1 δ)²).
#[test]
fn a_mistuned_pair_of_sectors_beats() {
    let (omega, delta) = ([2.9 * SPEED, 3.1 * SPEED], 0.12);
    let harmonic = |harmonic: usize| ModalHarmonic {
        harmonic,
        single: true,
        omega: vec![omega[harmonic]],
        contact: Mat::from_fn(3, 1, |d, _| c64::new(if d == 0 { 1.0 } else { 0.0 }, 0.0)),
        gyroscopic: None,
    };
    let mut scene =
        Scene::free(one_node(2, vec![harmonic(0), harmonic(1)]), vec![mode(0, c64::ONE, c64::ZERO)]);
    scene.mistuning = Some(vec![delta, -delta]);
    let (squares, coupling) = (omega.map(|w| w * w), omega[0] * omega[1] * delta);
    let (mean, half) = (0.5 * (squares[0] + squares[1]), 0.5 * (squares[1] - squares[0]));
    let spread = half.hypot(coupling);
    second_order(&scene, |s, t| {
        let (high, low) = ((mean + spread).sqrt(), (mean - spread).sqrt());
        // This is e^{…} of the symmetric 2 × 2 matrix on (1, 0).
        let (a, b) = ((high * t).cos(), (low * t).cos());
        let z0 = 0.5 * (a + b) - 0.5 * half / spread * (a - b);
        let z1 = 0.5 * coupling / spread * (a - b);
        (z0 + if s == 0 { z1 } else { -z1 }) / 2f64.sqrt()
    });
}

/// Common deviation δ of all sectors: every frequency times √(1 + δ).
#[test]
fn a_common_deviation_scales_all_frequencies() {
    let (omega, delta) = (2.9 * SPEED, 0.2);
    for sectors in [1, 3, 4] {
        for harmonic in 0..=sectors / 2 {
            let mut scene = Scene::free(
                crate::scene::wheel(sectors, 1, 1),
                vec![mode(harmonic, c64::new(0.4, 0.0), c64::ZERO)],
            );
            scene.wheel.harmonics.iter_mut().for_each(|h| h.omega = vec![omega]);
            scene.mistuning = Some(vec![delta; sectors]);
            let modes = &scene.wheel.harmonics[harmonic];
            let weight = (if modes.single { 1.0 } else { 2.0 } / sectors as f64).sqrt();
            let amplitude = modes.contact[(0, 0)] * (0.4 * weight);
            let turn = TAU * harmonic as f64 / sectors as f64;
            second_order(&scene, |s, t| {
                (amplitude * c64::cis(turn * s as f64)).re * (omega * (1.0 + delta).sqrt() * t).cos()
            });
        }
    }
}

/// Driven oscillator: z = F/(ω² − w² + 2jζωw) e^{jwt} once the transient is gone.
#[test]
fn a_driven_oscillator_has_its_amplitude_and_phase() {
    let (omega, zeta, order, amplitude, phase) = (2.3 * SPEED, 0.3, 3, 4e5, 0.7);
    let harmonic = ModalHarmonic {
        harmonic: 0,
        single: true,
        omega: vec![omega],
        contact: Mat::from_fn(3, 1, |d, _| c64::new([1.0, 0.5, 0.0][d], 0.0)),
        gyroscopic: None,
    };
    let mut scene = Scene::free(one_node(1, vec![harmonic]), Vec::new());
    scene.damping = Some(ModalDamping { modal_ratio: zeta, family_ratios: Vec::new(), ranks: Vec::new() });
    scene.excitation = vec![EngineOrderExcitation {
        order,
        directions: vec![Direction { node: 0, components: [0.0, 1.0, 0.0] }],
        amplitude,
        phase_rad: phase,
        ramp_revolutions: 1.0,
    }];
    scene.revolutions = 8;
    let driven = f64::from(order) * SPEED;
    let z = c64::cis(phase) * (0.5 * amplitude)
        / c64::new(omega * omega - driven * driven, 2.0 * zeta * omega * driven);
    for scheme in SCHEMES {
        let error = |steps: usize| {
            let scene = Scene { steps, samples: 300, scheme, ..scene.clone() };
            both(&scene).map(|found| {
                let last = &found[0][300 * 7..];
                let exact = |q: usize| (z * c64::cis(driven * TAU / SPEED * (q + 1) as f64 / 300.0)).re;
                difference(&[last.to_vec()], &[(0..300).map(exact).collect()])
            })
        };
        for (coarse, fine) in error(900).into_iter().zip(error(1800)) {
            assert!(coarse < 1e-3 && (coarse / fine - 4.0).abs() < 0.1, "{scheme:?}: {coarse:e} {fine:e}");
        }
    }
}
