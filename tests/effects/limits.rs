//! Limits in which an effect vanishes, and scenes that are the same scene in two guises.

use std::f64::consts::TAU;

use rubmap::dynamics::casing::{Lobe, Lobes, Measured, Part, PeriodicSpline, Profile, Restriction};
use rubmap::dynamics::direction::Direction;
use rubmap::dynamics::excitation::EngineOrderExcitation;
use rubmap::dynamics::flexible_casing::{CasingWave, FlexibleCasing};
use rubmap::dynamics::integrate::SensorRow;
use rubmap::dynamics::orbit::Orbit;
use rubmap::dynamics::schemes::Scheme;

use crate::scene::{Effect, SPEED, Scene, Start, difference, history, set_gyroscopic};

const SCHEMES: [Scheme; 3] =
    [Scheme::CentralDifferences, Scheme::ExactModal, Scheme::MasslessBoundary { kept_modes: 2 }];

/// Scene that rubs by `scheme`, with modes to leave out.
fn rubbing(sectors: usize, scheme: Scheme) -> Scene {
    let mut scene = Scene::rubbing(sectors, Start::Travelling);
    scene.wheel = crate::scene::wheel(sectors, 2, 5);
    scene.scheme = scheme;
    scene
}

fn apart(a: &Scene, b: &Scene) -> f64 {
    let (a, b) = (a.run(), b.run());
    assert!(a.statistics.contact_steps > 20 && b.statistics.contact_steps > 20, "no contact");
    difference(&history(&a).displacement, &history(&b).displacement)
}

/// Effects of size zero: they run in another loop than the plain scene, and differ from it by round-off.
#[test]
fn effects_of_no_size_leave_the_plain_scene() {
    for scheme in SCHEMES {
        for sectors in [4, 5] {
            let plain = rubbing(sectors, scheme);
            let mut gyroscopic = plain.clone();
            set_gyroscopic(&mut gyroscopic.wheel, 0.0);
            let silent = EngineOrderExcitation {
                order: 2,
                directions: vec![Direction { node: 0, components: [1.0, 0.0, 0.0] }],
                amplitude: 0.0,
                phase_rad: 0.3,
                ramp_revolutions: 0.0,
            };
            let still = Orbit { radius: 0.0, whirl_ratio: 0.3, phase_rad: 0.2 };
            let cases = [
                ("friction", Scene { friction: Some(0.0), ..plain.clone() }),
                ("mistuning", Scene { mistuning: Some(vec![0.0; sectors]), ..plain.clone() }),
                ("engine orders", Scene { excitation: vec![silent], ..plain.clone() }),
                ("orbit", Scene { orbit: Some(still), ..plain.clone() }),
                ("Coriolis", gyroscopic),
            ];
            for (name, scene) in cases {
                let apart = apart(&scene, &plain);
                assert!(apart < 1e-10, "{scheme:?} {sectors}, {name}: {apart:e}");
            }
        }
    }
}

/// Asserts that the difference from `limit` is of first order in 1/size, over half a revolution, in which differences do not grow by themselves.
fn first_order(limit: &Scene, scene: impl Fn(f64) -> Scene) {
    let error = |size: f64| apart(&scene(size), limit);
    let (coarse, fine) = (error(1e3), error(1e4));
    assert!(fine < 0.03 && coarse > 1e-9, "{coarse:e} {fine:e}");
    assert!((5.0..20.0).contains(&(coarse / fine)), "{coarse:e} {fine:e}");
}

#[test]
fn a_heavy_casing_is_rigid() {
    for scheme in [Scheme::CentralDifferences, Scheme::ExactModal] {
        for sectors in [4, 5] {
            let rigid = Scene { revolutions: 1, ..rubbing(sectors, scheme) };
            first_order(&rigid, |size| {
                let mut scene = rigid.clone().with(&[Effect::FlexibleCasing]);
                for wave in &mut scene.flexible_casing.as_mut().unwrap().waves {
                    wave.modal_mass *= size;
                }
                scene
            });
        }
    }
}

/// Stiff coating: the casing is rigid at its surface, and all its work is elastic.
#[test]
fn a_stiff_coating_is_rigid() {
    for scheme in SCHEMES {
        for sectors in [4, 5] {
            let rigid = Scene { revolutions: 1, ..rubbing(sectors, scheme) };
            first_order(&rigid, |size| {
                let mut scene = rigid.clone().with(&[Effect::Coating]);
                let coating = scene.coating.as_mut().unwrap();
                coating.material.modulus = 1e4 * size;
                coating.material.hardening = 1e14;
                coating.material.yield_stress = 1e9;
                scene
            });
        }
    }
}

/// Synchronous whirl: it turns with the wheel, so that every node has the clearance that is left to it, for ever.
#[test]
fn a_synchronous_whirl_is_another_clearance() {
    for scheme in SCHEMES {
        let mut whirling = rubbing(1, scheme);
        let casing = whirling.casing.as_mut().unwrap();
        casing.ramp_revolutions = 0.0;
        let orbit = Orbit { radius: 0.05, whirl_ratio: 1.0, phase_rad: 0.9 };
        whirling.orbit = Some(orbit);
        let mut nearer = Scene { orbit: None, ..whirling.clone() };
        for (clearance, node) in nearer.casing.as_mut().unwrap().clearance.iter_mut().zip(&whirling.nodes) {
            *clearance -= node.normal[0] * orbit.radius * (node.position[1] - orbit.phase_rad).cos();
        }
        let apart = apart(&whirling, &nearer);
        assert!(apart < 1e-10, "{scheme:?}: {apart:e}");
    }
}

/// Casing of lobes, lobes one by one, a wave along the chord and a measured curve, which all repeat so often.
fn parts(repeats: u32) -> Vec<Part> {
    let turn = |l: u32| TAU * f64::from(l) / f64::from(repeats);
    let part = |profile| Part { profile, along_chord: None };
    let lobes = Lobes { count: repeats, amplitude: 0.25, width_rad: 0.35, phase_rad: 0.1 };
    let each = |l: u32| Lobe { amplitude: 0.15, width_rad: 0.3, angle_rad: 0.3 + turn(l) };
    let wave = Profile::Wave { order: 2 * repeats, amplitude: 0.04, phase_rad: 0.2 };
    let points = 24 * repeats;
    let angles: Vec<f64> = (0..points).map(|i| TAU * f64::from(i) / f64::from(points)).collect();
    let heights: Vec<f64> = (0..points).map(|i| 0.02 * (f64::from(i % 24) - 12.0).abs() / 12.0).collect();
    let curve = PeriodicSpline::new(&angles, &heights);
    vec![
        part(Profile::Lobes(lobes)),
        part(Profile::Each((0..repeats).map(each).collect())),
        Part { profile: wave, along_chord: Some(vec![1.0, 0.4]) },
        part(Profile::Measured(Measured::at_each(vec![curve; 2]))),
    ]
}

/// Part of a wheel that repeats: simulated once, it gives the whole wheel, with casings of all shapes, elastic ones and engine orders included.
#[test]
fn a_part_does_what_the_whole_wheel_does() {
    for scheme in SCHEMES {
        for (sectors, repeats) in [(4, 2), (6, 2), (6, 3)] {
            let mut whole = Scene { initial: Vec::new(), ..rubbing(sectors, scheme) };
            whole.add(Effect::Friction);
            whole.add(Effect::Coriolis);
            let shape = Restriction { parts: parts(repeats as u32) };
            assert_eq!(shape.repeats(), repeats as u32);
            whole.casing.as_mut().unwrap().restriction = Some(shape);
            let wave = |nodal_diameter: usize, omega: f64| CasingWave {
                nodal_diameter: nodal_diameter as u32,
                omega: omega * SPEED,
                modal_mass: 4e-4,
            };
            let waves = vec![wave(0, 8.0), wave(1, 3.0), wave(repeats, 4.0), wave(sectors, 6.0)];
            if !matches!(scheme, Scheme::MasslessBoundary { .. }) {
                whole.flexible_casing = Some(FlexibleCasing { waves, damping_ratio: 0.02 });
            }
            whole.excitation = vec![EngineOrderExcitation {
                order: repeats as u32,
                directions: vec![Direction { node: 1, components: [0.5, 0.3, -0.2] }],
                amplitude: 4.0,
                phase_rad: 0.3,
                ramp_revolutions: 0.5,
            }];
            let sensor =
                |sector| SensorRow { direction: Direction { node: 0, components: [1.0, 0.2, -0.3] }, sector };
            whole.sensors = (0..sectors / repeats).map(sensor).collect();
            let sub = Scene { wheel: whole.wheel.clone().part(repeats), ..whole.clone() };
            let apart = apart(&sub, &whole);
            assert!(apart < 1e-9, "{scheme:?} {sectors}/{repeats}: {apart:e}");
        }
    }
}

/// Nodal diameters with different numbers of modes: the padding to whole vectors must not move.
#[test]
fn nodal_diameters_of_different_sizes_keep_to_themselves() {
    for scheme in [Scheme::CentralDifferences, Scheme::ExactModal] {
        let mut scene = Scene::rubbing(5, Start::Travelling);
        scene.wheel = crate::scene::wheel(5, 2, 10);
        for (harmonic, kept) in scene.wheel.harmonics.iter_mut().zip([10, 6, 9]) {
            harmonic.omega.truncate(kept);
            harmonic.contact = harmonic.contact.subcols(0, kept).to_owned();
        }
        set_gyroscopic(&mut scene.wheel, 0.4);
        scene.scheme = scheme;
        let run = scene.run();
        assert!(run.statistics.contact_steps > 20 && run.energy.residual() < 1e-9, "{:?}", run.energy);
    }
}
