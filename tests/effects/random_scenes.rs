//! Random scenes, which nobody chose: the production code against the literal model.

use std::f64::consts::TAU;

use faer::{Mat, c64};
use rubmap::dynamics::casing::{Casing, Lobe, Lobes, Measured, Part, PeriodicSpline, Profile, Restriction};
use rubmap::dynamics::clearance_change::ClearanceChange;
use rubmap::dynamics::contact::coating::CoatingMaterial;
use rubmap::dynamics::direction::Direction;
use rubmap::dynamics::excitation::EngineOrderExcitation;
use rubmap::dynamics::flexible_casing::{CasingWave, FlexibleCasing};
use rubmap::dynamics::initial::InitialMode;
use rubmap::dynamics::integrate::SensorRow;
use rubmap::dynamics::orbit::Orbit;
use rubmap::dynamics::oscillators::ModalDamping;
use rubmap::dynamics::schemes::Scheme;

use crate::agreement::agrees;
use crate::fixtures::Numbers;
use crate::scene::{Abradable, MASS, SPEED, Scene, Start, contact_nodes, set_gyroscopic};

struct Dice(Numbers);

impl Dice {
    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.0.next()
    }

    fn below(&mut self, count: usize) -> usize {
        (self.0.next() * count as f64) as usize
    }

    fn maybe<T>(&mut self, share: f64, of: impl FnOnce(&mut Self) -> T) -> Option<T> {
        (self.0.next() < share).then(|| of(self))
    }

    fn direction(&mut self, nodes: usize) -> Direction {
        Direction { node: self.below(nodes), components: [0; 3].map(|_| self.between(-1.0, 1.0)) }
    }
}

/// Random scene: one to five sectors of one to three contact nodes and two to three times as many modes, frequencies
/// from 2 to 16 Ω; lengths of tenths of a millimetre, friction below what could jam so few modes, every effect in half
/// of the scenes.
fn scene(seed: u64) -> Scene {
    let mut dice = Dice(Numbers::new(seed));
    let (sectors, nodes) = (1 + dice.below(5), 1 + dice.below(3));
    let families = 2 * nodes + dice.below(nodes + 1);
    let mut scene = Scene::rubbing(sectors, Start::Rest);
    scene.nodes = contact_nodes(nodes);
    scene.wheel = crate::scene::wheel(sectors, nodes, families);
    scene.mistuning = dice.maybe(0.5, |dice| (0..sectors).map(|_| dice.between(-0.1, 0.1)).collect());
    for modes in &mut scene.wheel.harmonics {
        modes.omega = (0..families).map(|_| SPEED * dice.between(2.0, 16.0)).collect();
        modes.omega.sort_by(f64::total_cmp);
        // Mistuned families keep the one shape of all their nodal diameters.
        if scene.mistuning.is_none() {
            modes.contact = Mat::from_fn(3 * nodes, families, |_, _| {
                let im = if modes.single { 0.0 } else { dice.between(-1.0, 1.0) };
                c64::new(dice.between(-1.0, 1.0), im) / MASS.sqrt()
            });
        }
    }
    if dice.maybe(0.5, |_| ()).is_some() {
        set_gyroscopic(&mut scene.wheel, 0.5);
    }
    scene.damping = dice.maybe(0.8, |dice| ModalDamping {
        modal_ratio: dice.between(0.0, 0.1),
        family_ratios: vec![dice.between(0.0, 0.1); 2],
        ranks: Vec::new(),
    });
    scene.casing = Some(Casing {
        clearance: (0..nodes).map(|_| dice.between(0.1, 0.3)).collect(),
        restriction: dice.maybe(0.8, |dice| {
            let lobes = Lobes {
                count: 1 + dice.below(5) as u32,
                amplitude: dice.between(0.1, 0.4),
                width_rad: dice.between(0.2, 0.8),
                phase_rad: dice.between(-3.0, 3.0),
            };
            lobes.into()
        }),
        ramp_revolutions: dice.between(0.0, 0.5),
    });
    scene.friction = dice.maybe(0.5, |dice| dice.between(0.0, 0.08));
    if nodes > 1 {
        scene.coating = dice.maybe(0.5, |dice| Abradable {
            material: CoatingMaterial {
                modulus: dice.between(100.0, 1000.0),
                yield_stress: dice.between(0.0, 5.0),
                hardening: dice.between(10.0, 100.0),
            },
            thickness: dice.between(0.1, 0.3),
            rods_around: 4 * sectors + dice.below(200),
        });
    }
    scene.orbit = dice.maybe(0.5, |dice| Orbit {
        radius: dice.between(0.0, 0.15),
        whirl_ratio: dice.between(-1.0, 1.5),
        phase_rad: dice.between(-3.0, 3.0),
    });
    scene.clearance_change = seed.is_multiple_of(3).then(|| ClearanceChange {
        course: vec![(0.2, 0.1), (0.3 + 0.001 * seed as f64, -0.1), (0.8, 0.04)],
        along_chord: None,
    });
    let orders = dice.below(3);
    scene.excitation = (0..orders)
        .map(|_| EngineOrderExcitation {
            order: dice.below(13) as u32,
            directions: vec![dice.direction(nodes), dice.direction(nodes)],
            amplitude: dice.between(0.0, 3.0),
            phase_rad: dice.between(-3.0, 3.0),
            ramp_revolutions: dice.between(-0.5, 1.0).max(0.0),
        })
        .collect();
    let moving = dice.below(3);
    scene.initial = (0..moving)
        .map(|moved| InitialMode {
            harmonic: dice.below(sectors / 2 + 1),
            family: moved,
            displacement: c64::cis(dice.between(0.0, TAU)) * (0.1 * MASS.sqrt()),
            velocity: c64::cis(dice.between(0.0, TAU)) * (0.2 * SPEED * MASS.sqrt()),
        })
        .collect();
    let mut seen = |sector| SensorRow { direction: dice.direction(nodes), sector };
    scene.sensors = vec![seen(0), seen(sectors - 1)];
    // A second revolution would let some scenes grow round-off to a disagreement.
    (scene.steps, scene.samples, scene.revolutions) = (960, 240, 1);
    scene.scheme = match dice.below(3) {
        0 => Scheme::CentralDifferences,
        1 => Scheme::ExactModal,
        _ => Scheme::MasslessBoundary { kept_modes: 1 + dice.below(families - nodes) },
    };
    if let Scheme::MasslessBoundary { kept_modes } = scene.scheme {
        scene.initial.retain(|mode| mode.family < kept_modes);
        let smallest = scene.scheme.smallest_stable_steps(&scene.wheel, &scene.nodes);
        if smallest > scene.steps as u64 {
            scene.scheme = Scheme::ExactModal;
        }
    }
    if !matches!(scene.scheme, Scheme::MasslessBoundary { .. }) {
        scene.flexible_casing = dice.maybe(0.5, |dice| FlexibleCasing {
            waves: (0..1 + dice.below(3))
                .map(|_| CasingWave {
                    nodal_diameter: dice.below(7) as u32,
                    omega: SPEED * dice.between(2.0, 12.0),
                    modal_mass: MASS * dice.between(10.0, 100.0),
                })
                .collect(),
            damping_ratio: dice.between(0.0, 0.1),
        });
    }
    if seed.is_multiple_of(2) {
        let parts = shapes(&mut Dice(Numbers::new(1000 + seed)), nodes);
        let casing = scene.casing.as_mut().expect("every scene has one");
        let restriction = casing.restriction.get_or_insert(Restriction { parts: Vec::new() });
        restriction.parts.extend(parts);
    }
    scene
}

/// Shapes of a casing: single lobes, waves and a measured curve for every node, each in half of the scenes.
fn shapes(dice: &mut Dice, nodes: usize) -> Vec<Part> {
    let along =
        |dice: &mut Dice| dice.maybe(0.5, |dice| (0..nodes).map(|_| dice.between(-1.0, 1.0)).collect());
    let single = dice.maybe(0.5, |dice| {
        let lobe = |dice: &mut Dice| Lobe {
            amplitude: dice.between(-0.2, 0.3),
            width_rad: dice.between(0.1, 0.8),
            angle_rad: dice.between(-4.0, 8.0),
        };
        Profile::Each((0..1 + dice.below(3)).map(|_| lobe(dice)).collect())
    });
    let wave = dice.maybe(0.5, |dice| Profile::Wave {
        order: dice.below(7) as u32,
        amplitude: dice.between(0.0, 0.2),
        phase_rad: dice.between(-3.0, 3.0),
    });
    let measured = dice.maybe(0.5, |dice| {
        let points = 12 + dice.below(30);
        let angles: Vec<f64> =
            (0..points).map(|i| TAU / points as f64 * (i as f64 + dice.between(-0.3, 0.3)) - 1.0).collect();
        let curve = |dice: &mut Dice| {
            let heights: Vec<f64> = angles.iter().map(|_| dice.between(-0.1, 0.1)).collect();
            PeriodicSpline::new(&angles, &heights)
        };
        Profile::Measured(Measured::at_each((0..nodes).map(|_| curve(dice)).collect()))
    });
    let profiles = [single, wave, measured].into_iter().flatten();
    profiles.map(|profile| Part { profile, along_chord: along(dice) }).collect()
}

#[test]
fn random_scenes_agree() {
    let (mut touched, mut largest) = (0, 0.0f64);
    for seed in 1..=200 {
        let scene = scene(seed);
        if !scene.run().energy.largest_energy().is_normal() {
            continue;
        }
        largest = largest.max(agrees(&scene, &format!("seed {seed}")));
        touched += usize::from(scene.run().statistics.contact_steps > 0);
    }
    assert!(touched > 80, "{touched} scenes touch");
    println!("{touched} scenes in contact: {largest:.1e}");
}
