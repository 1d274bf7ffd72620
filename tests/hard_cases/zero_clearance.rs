//! Clearance of zero: blades rest on the casing.
//!
//! Tolerances relative to the clearance are zero, a gap of exactly 0 is neither open nor closed, and every step of a
//! moving wheel closes something. Guaranteed: a wheel at rest stays at rest to the bit; one that moves, or is pushed, keeps its
//! gaps closed or open without pulling and without penetration.

use faer::c64;
use rubmap::dynamics::initial::InitialMode;

use crate::fixtures::WheelRecipe;
use crate::scenes::{PENETRATION, Scene, assert_sound, history, largest};
use crate::support::LIBRARY_SCHEMES;

fn without_clearance() -> Scene {
    let mut scene = Scene::new(WheelRecipe::default());
    scene.casing.as_mut().unwrap().clearance = vec![0.0; 3];
    scene
}

#[test]
fn at_rest_in_a_circular_casing_nothing_moves() {
    let mut scene = without_clearance();
    scene.casing.as_mut().unwrap().restriction = None;
    for scheme in LIBRARY_SCHEMES {
        let run = scene.run(scheme, scene.steps(scheme, 1.3));
        assert!(history(&run).displacement[0].iter().all(|&u| u == 0.0), "{scheme:?}");
        assert_eq!(run.statistics.contact_steps, 0, "{scheme:?}");
    }
}

/// Circular casing without clearance: nothing gives a length to hold gaps against, neither a clearance nor a lobe.
#[test]
fn a_vibrating_wheel_in_a_circular_casing() {
    let mut scene = without_clearance();
    scene.casing.as_mut().unwrap().restriction = None;
    let speed = scene.wheel.speed_rad_s;
    scene.initial = vec![
        InitialMode {
            harmonic: 0,
            family: 0,
            displacement: c64::ZERO,
            velocity: c64::new(-1e-3 * speed, 0.0),
        },
        InitialMode {
            harmonic: 2,
            family: 1,
            displacement: c64::ZERO,
            velocity: c64::new(1e-4 * speed, -3e-4 * speed),
        },
    ];
    for damping_ratio in [0.0, 0.01] {
        scene.damping_ratio = damping_ratio;
        for scheme in LIBRARY_SCHEMES {
            let context = format!("ζ = {damping_ratio}, {scheme:?}");
            let run = scene.run(scheme, scene.steps(scheme, 1.3));
            assert_sound(&run, PENETRATION, &context);
            assert!(run.statistics.contact_share() > 0.1, "{context}: {:?}", run.statistics);
            assert!(largest(&history(&run).displacement[0]) < 1.0, "{context}");
        }
    }
}

#[test]
fn lobes_push_from_the_first_step_on() {
    let mut scene = without_clearance();
    scene.lobes().amplitude = 0.1;
    for scheme in LIBRARY_SCHEMES {
        let run = scene.run(scheme, scene.steps(scheme, 1.3));
        assert_sound(&run, PENETRATION, &format!("{scheme:?}"));
        assert!(run.statistics.contact_share() > 0.9, "{scheme:?}: {:?}", run.statistics);
    }
}
