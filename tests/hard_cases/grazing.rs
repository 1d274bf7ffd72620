//! Lobes that just touch, and blades that touch hundreds of times.
//!
//! At grazing a solver that decides by the sign of a rounded gap switches forces on and off with round-off, and a force
//! too large for its penetration kicks the blade; chatter multiplies whatever a closing does wrong. Guaranteed: the
//! response goes to nothing with the overlap, continuously; hundreds of openings leave every step complementary and the
//! energy accounted for.

use crate::fixtures::WheelRecipe;
use crate::scenes::{PENETRATION, Scene, assert_sound, history, largest};
use crate::support::LIBRARY_SCHEMES;

/// Lobes beyond the clearance by a share of it, down to its last digit. Only their very tops touch, in one step each, and
/// contact is homogeneous: half the overlap, half the motion.
#[test]
fn the_response_vanishes_with_the_overlap() {
    let mut scene = Scene::new(WheelRecipe::default());
    for scheme in LIBRARY_SCHEMES {
        // A multiple of every sector's and lobe's angle: a node passes each lobe's top in a step.
        let steps = scene.steps(scheme, 1.3).next_multiple_of(640);
        let mut per_overlap = Vec::new();
        for overlap in [-1e-12, 0.0, 1e-15, 1e-12, 1e-11, 1e-10, 1e-9, 1e-6, 1e-3] {
            scene.lobes().amplitude = 0.3 * (1.0 + overlap);
            scene.lobes().phase_rad = 0.0;
            let run = scene.run(scheme, steps);
            let context = format!("{scheme:?}, overlap {overlap:e}");
            let moved = largest(&history(&run).displacement[0]);
            assert_sound(&run, PENETRATION, &context);
            if overlap <= 1e-15 {
                // Within the last digits of the clearance.
                assert_eq!((moved, run.statistics.contact_steps), (0.0, 0), "{context}");
            } else {
                assert!(run.statistics.contact_steps > 0 && moved < 1.0, "{context}: {moved}");
            }
            if (1e-12..=1e-9).contains(&overlap) {
                per_overlap.push(moved / overlap);
            }
        }
        // The last digit of the clearance is 2e-4 of the smallest overlap.
        for ratio in &per_overlap {
            assert!((ratio / per_overlap[3] - 1.0).abs() < 5e-3, "{scheme:?}: {per_overlap:?}");
        }
    }
}

/// Number of openings of the recorded nodes: samples without contact after one with it.
fn openings(scene: &Scene, displacement: &[Vec<f64>], steps: usize) -> usize {
    let casing = scene.casing.as_ref().unwrap();
    let restriction = casing.restriction.as_ref().unwrap();
    let mut openings = 0;
    for (sensor, line) in scene.sensors.iter().zip(displacement) {
        let node = sensor.direction.node;
        let start = scene.contact[node].position[1]
            + std::f64::consts::TAU * sensor.sector as f64 / scene.wheel.sectors as f64;
        let mut closed = false;
        for (q, u) in line.iter().enumerate() {
            let revolutions = (q + 1) as f64 / steps as f64;
            let angle = start + std::f64::consts::TAU * revolutions;
            let p = restriction.height(angle, node) * casing.growth(revolutions);
            let touches = casing.clearance[node] - p - u < 1e-10;
            openings += usize::from(closed && !touches);
            closed = touches;
        }
    }
    openings
}

/// Twenty-four narrow lobes that hardly reach in, hardly any damping: blades bounce from lobe to lobe.
#[test]
fn hundreds_of_openings() {
    for damping_ratio in [0.0, 0.002] {
        let mut scene = Scene::new(WheelRecipe::default());
        scene.damping_ratio = damping_ratio;
        let lobes = scene.lobes();
        (lobes.count, lobes.amplitude, lobes.width_rad) = (24, 0.301, 0.06);
        scene.sensors =
            (0..10).flat_map(|s| (0..3).map(move |k| (s, k))).map(|(s, k)| scene.normal(k, s)).collect();
        scene.revolutions = 5;
        for scheme in LIBRARY_SCHEMES {
            let context = format!("ζ = {damping_ratio}, {scheme:?}");
            let steps = scene.steps(scheme, 2.0).max(2000);
            scene.samples = steps;
            let run = scene.run(scheme, steps);
            let openings = openings(&scene, &history(&run).displacement, steps);
            assert_sound(&run, PENETRATION, &context);
            assert!(openings > 300, "{context}: {openings}");
        }
    }
}
