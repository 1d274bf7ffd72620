//! Free vibration over a million steps.
//!
//! A phase error of 1e-6 a step is a lost period after a million of them; differences of nearly equal displacements shed
//! digits at small steps; a damping of 1e-9 a step drowns in round-off. Guaranteed: `exact_modal` (and the modes that
//! `massless_boundary` keeps) is the continuous solution, `central_differences` its own discrete one, in amplitude and
//! phase, standing and travelling, damped and not.

use std::f64::consts::TAU;

use faer::c64;
use rubmap::dynamics::initial::InitialMode;
use rubmap::dynamics::schemes::Scheme;

use crate::fixtures::WheelRecipe;
use crate::scenes::{Scene, history, largest};
use crate::support::ENERGY_TOLERANCE;

const STEPS: usize = 1_000_000;

/// Displacement z(t) of z̈ + 2ζωż + ω²z = 0.
fn continuous(omega: f64, zeta: f64, t: f64, z: f64, v: f64) -> f64 {
    let damped = omega * (1.0 - zeta * zeta).sqrt();
    (-zeta * omega * t).exp()
        * (z * (damped * t).cos() + (v + zeta * omega * z) / damped * (damped * t).sin())
}

/// Displacement z_q of (z⁺ − 2z + z⁻)/h² + ζω (z⁺ − z⁻)/h + ω²z = 0, z⁺ − z⁻ = 2hv at q = 0: r^q (A cos qφ + B sin qφ).
fn discrete(omega: f64, zeta: f64, h: f64, q: usize, z: f64, v: f64) -> f64 {
    let c = zeta * omega * h;
    let root = (1.0 - c * c).sqrt();
    let r = ((1.0 - c) / (1.0 + c)).sqrt();
    // cos φ = (1 − (ωh)²/2)/√(1−c²), without its cancellation.
    let sine = (((omega * h).powi(2) / 2.0 - c * c / (1.0 + root)) / (2.0 * root)).sqrt();
    let phi = 2.0 * sine.asin();
    let b = (2.0 * h * v - z * phi.cos() * (r - 1.0 / r)) / (phi.sin() * (r + 1.0 / r));
    let turned = q as f64 * phi;
    r.powi(q as i32) * (z * turned.cos() + b * turned.sin())
}

/// Standing and travelling waves from the lowest mode to the highest.
fn waves(scene: &Scene, families: [usize; 4]) -> Vec<InitialMode> {
    let [a, b, c, d] = families;
    let omega = |harmonic: usize, family: usize| scene.wheel.harmonics[harmonic].omega[family];
    let small = 1e-4;
    vec![
        InitialMode { harmonic: 0, family: a, displacement: c64::new(small, 0.0), velocity: c64::ZERO },
        // Forwards, backwards, and a standing wave that starts with a blow.
        InitialMode {
            harmonic: 1,
            family: b,
            displacement: c64::new(small, 0.0),
            velocity: c64::new(0.0, small * omega(1, b)),
        },
        InitialMode {
            harmonic: 3,
            family: c,
            displacement: c64::new(0.0, small),
            velocity: c64::new(small * omega(3, c), 0.0),
        },
        InitialMode {
            harmonic: 4,
            family: d,
            displacement: c64::ZERO,
            velocity: c64::new(small * omega(4, d), 0.0),
        },
    ]
}

/// Amplitude and phase with `per_revolution` from a step that resolves the highest mode sixty times over to one in which it turns by more than π.
#[test]
fn amplitude_and_phase_are_those_of_the_closed_form() {
    let scene = Scene::new(WheelRecipe::default());
    let last = scene.wheel.harmonics[0].omega.len() - 1;
    let (all, kept) = ([0, 5, 11, last], [0, 2, 4, 6]);
    for (scheme, families, per_revolution) in [
        (Scheme::CentralDifferences, all, 1000),
        (Scheme::CentralDifferences, all, 32),
        (Scheme::ExactModal, all, 1000),
        (Scheme::ExactModal, all, 32),
        (Scheme::ExactModal, all, 16),
        (Scheme::MasslessBoundary { kept_modes: 7 }, kept, 1000),
        (Scheme::MasslessBoundary { kept_modes: 7 }, kept, 32),
    ] {
        for damping_ratio in [0.0, 1e-6] {
            vibrate(scene.clone(), scheme, families, per_revolution, damping_ratio);
        }
    }
}

fn vibrate(
    mut scene: Scene,
    scheme: Scheme,
    families: [usize; 4],
    per_revolution: usize,
    damping_ratio: f64,
) {
    scene.casing = None;
    scene.damping_ratio = damping_ratio;
    scene.sensors = vec![scene.normal(0, 0), scene.normal(2, 7)];
    scene.samples = if per_revolution < 100 { 1 } else { 8 };
    scene.revolutions = STEPS / per_revolution;
    scene.initial = waves(&scene, families);
    let h = TAU / (scene.wheel.speed_rad_s * per_revolution as f64);
    let run = scene.run(scheme, per_revolution);
    assert_eq!(run.statistics.steps, STEPS as u64);
    let mut worst = 0.0f64;
    for (sensor, line) in scene.sensors.iter().zip(&history(&run).displacement) {
        let scale = largest(line);
        for (sample, &found) in line.iter().enumerate() {
            let q = (sample + 1) * (per_revolution / scene.samples);
            let mut expected = 0.0;
            for mode in &scene.initial {
                let harmonic = &scene.wheel.harmonics[mode.harmonic];
                let omega = harmonic.omega[mode.family];
                let z = |z, v| match scheme {
                    Scheme::CentralDifferences => discrete(omega, damping_ratio, h, q, z, v),
                    _ => continuous(omega, damping_ratio, q as f64 * h, z, v),
                };
                let imaginary = if harmonic.single { 0.0 } else { z(mode.displacement.im, mode.velocity.im) };
                let z = c64::new(z(mode.displacement.re, mode.velocity.re), imaginary);
                let row = 3 * sensor.direction.node;
                let shape: c64 = (0..3)
                    .map(|d| harmonic.contact[(row + d, mode.family)] * sensor.direction.components[d])
                    .sum();
                let waves = if harmonic.single { 1.0f64 } else { 2.0 };
                let turn = TAU * (mode.harmonic * sensor.sector % 10) as f64 / 10.0;
                expected += (waves / 10.0).sqrt() * (shape * z * c64::new(turn.cos(), turn.sin())).re;
            }
            worst = worst.max((found - expected).abs() / scale);
        }
    }
    let residual = run.energy.residual();
    let context = format!("{scheme:?}, {per_revolution} steps a revolution, ζ = {damping_ratio}");
    // ωt reaches 4e6 rad, of which the last digit is 5e-10; amplitudes walk by 1e-16 √1e6.
    assert!(worst < 1e-8, "{context}: {worst:e}");
    assert!(residual < ENERGY_TOLERANCE, "{context}: energy residual {residual:e}");
}
