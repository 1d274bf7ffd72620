//! Contact with a casing that moves and gives way, where it has a closed form; others are rows of `rubmap_validation`.

use std::f64::consts::TAU;

use faer::{Mat, c64};
use nalgebra::{DMatrix, DVector};
use rubmap::dynamics::casing::Casing;
use rubmap::dynamics::flexible_casing::{CasingWave, FlexibleCasing};
use rubmap::dynamics::modal_wheel::{ModalHarmonic, ModalWheel};
use rubmap::dynamics::orbit::Orbit;
use rubmap::dynamics::sector::ContactNode;

use crate::scene::{SPEED, Scene, Start, history};

/// Scene of one blade that moves radially, at (100, 0.3, 0), with one sensor there, undamped, from rest.
fn blade(omega: Vec<f64>, shape: &[f64]) -> Scene {
    let contact = Mat::from_fn(3, omega.len(), |d, m| c64::new(if d == 0 { shape[m] } else { 0.0 }, 0.0));
    let modes = ModalHarmonic { harmonic: 0, single: true, omega, contact, gyroscopic: None };
    let mut scene = Scene::rubbing(1, Start::Rest);
    scene.wheel = ModalWheel { speed_rad_s: SPEED, sectors: 1, repeats: 1, harmonics: vec![modes] };
    scene.nodes =
        vec![ContactNode { id: 1, position: [100.0, 0.3, 0.0], normal: [1.0, 0.0, 0.0], dofs: [0, 1, 2] }];
    scene.damping = None;
    scene.sensors.truncate(1);
    scene.sensors[0].direction.components = [1.0, 0.0, 0.0];
    scene
}

fn circular(clearance: f64, ramp_revolutions: f64) -> Option<Casing> {
    Some(Casing { clearance: vec![clearance], restriction: None, ramp_revolutions })
}

/// Blade pushed for good against waves cos 2φ and sin 2φ that it runs past. Seen from the blade, the deflection p at its
/// place and q a quarter wave off obey
///
/// ```text
/// (m_b + m)p̈ + (m_b ω_b² + m(ω² − n²Ω²))p − 2nΩ m q̇ = const,   m(q̈ + (ω² − n²Ω²)q + 2nΩ ṗ) = 0
/// ```
///
/// so that its motion is a constant and the two frequencies of that system.
#[test]
fn a_blade_sees_the_waves_it_runs_past() {
    let (n, mass, blade_omega, wave_mass, omega) = (2.0, 3e-4, 4.0 * SPEED, 2e-4, 6.3 * SPEED);
    let mut scene = blade(vec![blade_omega], &[f64::sqrt(1.0 / mass)]);
    scene.orbit = Some(Orbit { radius: 0.5, whirl_ratio: 1.0, phase_rad: 0.3 });
    scene.casing = circular(0.05, 0.3);
    let wave = CasingWave { nodal_diameter: 2, omega, modal_mass: wave_mass };
    scene.flexible_casing = Some(FlexibleCasing { waves: vec![wave], damping_ratio: 0.0 });
    // ((m_b + m)x − k_p)(x − k_q) = (2nΩ)² m x with x the square of a frequency.
    let turning = (n * SPEED).powi(2);
    let (whole, q) = (mass + wave_mass, omega * omega - turning);
    let p = mass * blade_omega.powi(2) + wave_mass * q;
    let (b, c) = ((p + whole * q + 4.0 * turning * wave_mass) / whole, p * q / whole);
    let root = (b * b / 4.0 - c).sqrt();
    let frequencies = [(b / 2.0 - root).sqrt(), (b / 2.0 + root).sqrt()];
    let left = |steps: usize| {
        let scene = Scene { steps, samples: 400, ..scene.clone() };
        let run = scene.run();
        let line = &history(&run).displacement[0][160..];
        assert!(run.statistics.contact_steps as f64 > 1.6 * steps as f64, "contact is lost");
        let motion = DVector::from_column_slice(line);
        let basis = DMatrix::from_fn(line.len(), 5, |sample, column| {
            let t = TAU / SPEED * sample as f64 / 400.0;
            match column {
                0 => 1.0,
                1 | 2 => (frequencies[column - 1] * t).cos(),
                _ => (frequencies[column - 3] * t).sin(),
            }
        });
        let fit = basis.clone().svd(true, true).solve(&motion, 1e-12).unwrap();
        for pair in [[1, 3], [2, 4]] {
            assert!(fit[pair[0]].hypot(fit[pair[1]]) > 1e-4, "both frequencies are there: {fit}");
        }
        (basis * fit - motion).amax()
    };
    // The force that closes the gap at the end of a step acts from where the blade is then: of first order in nΩh.
    let (coarse, fine) = (left(4000), left(8000));
    assert!(fine < 1e-4 && (coarse / fine - 2.0).abs() < 0.2, "{coarse:e} {fine:e}");
}
