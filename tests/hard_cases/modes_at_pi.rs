//! `exact_modal` with modes whose period is two steps: ωh ≈ π.
//!
//! Such a mode changes sign at every step and the exact propagator moves it by force at hardly any cost of energy, so contact
//! that opens and closes from step to step pumps it without bound while the motion it is exact in looks perfect.
//! Guaranteed: modes near and beyond that rhythm follow statically; wherever the highest mode sits, energy stays what a
//! resolved step gives.

use std::f64::consts::PI;

use rubmap::dynamics::schemes::Scheme;
use rubmap::dynamics::schemes::exact_modal::FOLLOWS;

use crate::fixtures::WheelRecipe;
use crate::scenes::{PENETRATION, Scene, assert_sound};

const STEPS: usize = 640;

#[test]
fn energy_is_bounded_wherever_the_highest_mode_sits() {
    for lobes in [2u32, 24] {
        let mut scene = Scene::new(WheelRecipe { stiffening: false, ..Default::default() });
        scene.damping_ratio = 0.0;
        scene.revolutions = 20;
        scene.lobes().count = lobes;
        if lobes > 2 {
            scene.lobes().width_rad = 0.06;
            scene.lobes().amplitude = 0.31;
        }
        for turn in [0.7, 0.8, 0.833, 0.834, 0.9, 0.99, 1.0, 1.01, 1.2, 1.5, 1.99, 2.0, 2.01] {
            // ω_max h = turn·π
            scene.wheel.speed_rad_s = 2.0 * scene.wheel.largest_frequency() / (STEPS as f64 * turn);
            let run = scene.run(Scheme::ExactModal, STEPS);
            let fine = scene.run(Scheme::ExactModal, 4 * STEPS);
            let context = format!("{lobes} lobes, ω_max h = {turn} π");
            assert_sound(&run, PENETRATION, &context);
            assert!(run.energy.largest_energy() < 2.0 * fine.energy.largest_energy(), "{context}");
        }
    }
}

/// Largest energy of both modes of a blade, one soft and one stiff, before a wall that oscillates; the stiff mode is
/// advanced exactly or follows statically.
fn blade(turn: f64, follows: bool) -> f64 {
    // Units: step 1, both modes move the tip by 1.
    let omegas = [0.02, turn * PI];
    let receptance: [f64; 2] = std::array::from_fn(|m| {
        if m == 1 && follows {
            omegas[1].powi(-2)
        } else {
            (2.0 * (0.5 * omegas[m]).sin() / omegas[m]).powi(2)
        }
    });
    let keep: [f64; 2] = [1.0, if follows { 0.0 } else { 1.0 }];
    let (mut z, mut d) = ([0.0f64; 2], [0.0f64; 2]);
    let mut largest = 0.0f64;
    for q in 0..20_000 {
        for m in 0..2 {
            d[m] = keep[m] * d[m] - omegas[m].powi(2) * receptance[m] * z[m];
            z[m] += d[m];
        }
        let wall = 0.5 - (0.05 * f64::from(q)).cos() * f64::from(q).min(1000.0) / 1000.0;
        let force = ((z[0] + z[1] - wall) / (receptance[0] + receptance[1])).max(0.0);
        let mut energy = 0.0;
        for m in 0..2 {
            d[m] -= receptance[m] * force;
            z[m] -= receptance[m] * force;
            energy += 0.5 * (d[m] * d[m] + omegas[m].powi(2) * z[m] * z[m]);
        }
        largest = largest.max(energy);
    }
    largest
}

/// Modes at the rhythm of the steps gain energy if they are advanced exactly, which is why they follow statically: at
/// that rhythm the energy is what the run lasts, a sixth below it what contact gives.
#[test]
fn advanced_exactly_such_a_mode_gains_energy() {
    for turn in [0.99, 0.999, 1.001, 1.01] {
        let (exact, following) = (blade(turn, false), blade(turn, true));
        assert!(exact > 1e3 * following, "{turn}: {exact} {following}");
    }
    let resolved = FOLLOWS / PI;
    assert!(
        blade(resolved, false) < 20.0 * blade(resolved, true),
        "{} {}",
        blade(resolved, false),
        blade(resolved, true)
    );
}
