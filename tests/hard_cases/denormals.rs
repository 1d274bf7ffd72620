//! Strongly damped wheel long after its last touch.
//!
//! Decaying numbers end among the denormals, where every operation takes a hundred times as long and the state never becomes
//! zero: a run that has nothing left to compute grows slow. Guaranteed: what has decayed below any meaning is brought to rest,
//! so that no recorded number is ever denormal and the wheel ends in exact rest.

use faer::c64;
use rubmap::dynamics::initial::InitialMode;
use rubmap::dynamics::integrate::History;

use crate::fixtures::WheelRecipe;
use crate::scenes::{PENETRATION, Scene, assert_sound, history};
use crate::support::LIBRARY_SCHEMES;

fn recorded(history: &History) -> impl Iterator<Item = &f64> {
    history.displacement.iter().flatten().chain(history.harmonics.iter().flatten().flatten())
}

/// Scene of a blow to two nodal diameters, damped by half: 1e-100 is reached within some forty revolutions.
fn struck() -> Scene {
    let mut scene = Scene::new(WheelRecipe::default());
    scene.damping_ratio = 0.5;
    scene.revolutions = 120;
    let speed = scene.wheel.speed_rad_s;
    scene.initial = [0, 3]
        .into_iter()
        .flat_map(|harmonic| (0..3).map(move |family| (harmonic, family)))
        .map(|(harmonic, family)| InitialMode {
            harmonic,
            family,
            displacement: c64::ZERO,
            velocity: c64::new(-1e-4 * speed, 1e-4 * speed),
        })
        .collect();
    scene.sensors = vec![scene.normal(0, 0), scene.normal(2, 4)];
    scene
}

#[test]
fn a_struck_wheel_comes_to_exact_rest() {
    let free = Scene { casing: None, ..struck() };
    // One casing is out of reach, on another the blades lean while they come to rest: gaps and forces decay with them.
    let mut apart = struck();
    let casing = apart.casing.as_mut().unwrap();
    (casing.clearance, casing.restriction) = (vec![10.0; 3], None);
    let mut leaning = apart.clone();
    leaning.casing.as_mut().unwrap().clearance = vec![0.0; 3];
    for (name, scene) in [("free", free), ("apart", apart), ("leaning", leaning)] {
        for scheme in LIBRARY_SCHEMES {
            let context = format!("{name}, {scheme:?}");
            let run = scene.run(scheme, scene.steps(scheme, 1.3));
            let history = history(&run);
            let subnormal = recorded(history).filter(|u| u.is_subnormal()).count();
            let line = &history.displacement[0];
            assert_sound(&run, PENETRATION, &context);
            assert_eq!(subnormal, 0, "{context}");
            let last = line.len() - scene.samples;
            // Meanwhile it passed everything down to what its smallest recorded number is made of.
            assert!(line.iter().any(|&u| u != 0.0 && u.abs() < 1e-90), "{context}");
            assert!(
                history.displacement.iter().all(|line| line[last..].iter().all(|&u| u == 0.0)),
                "{context}"
            );
        }
    }
}
