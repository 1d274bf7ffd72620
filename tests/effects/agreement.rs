//! Agreement of the production code with the literal model: every effect alone, every pair, all together, by every scheme.

use rubmap::dynamics::contact::friction::sliding_directions;
use rubmap::dynamics::schemes::Scheme;

use crate::literal::{Literal, Record};
use crate::scene::{EFFECTS, Effect, Scene, Start, contact_nodes, difference, history, sliding};

/// Largest relative difference that is accepted: over two revolutions of lightly damped contact round-off grows to some
/// 1e-12 of the largest displacement.
const AGREE: f64 = 1e-9;

/// Runs both models, compares everything that both know, and returns the difference of the histories.
pub(crate) fn agrees(scene: &Scene, name: &str) -> f64 {
    let run = scene.run();
    let found = history(&run);
    let expected: Record = Literal::new(scene).run();
    let apart = difference(&found.displacement, &expected.displacement);
    assert!(apart < AGREE, "{name}: {apart:e}");
    let energy = run.energy.largest_energy();
    let effects = run.energy.effects();
    let length = expected.displacement.iter().flatten().fold(0.0f64, |m, u| m.max(u.abs()));
    let pairs = [
        ("impulse", run.statistics.contact_impulse, expected.impulse, expected.impulse),
        ("work of contact", run.energy.work(), expected.contact_work, energy),
        ("friction's heat", effects.friction_heat, expected.friction_heat, expected.friction_heat),
        ("work of engine orders", effects.excitation, expected.excitation_work, energy),
        ("work of mistuning", effects.mistuning, expected.mistuning_work, energy),
        ("work on the casing", effects.casing, expected.casing_work, energy),
        ("casing's loss", effects.casing_loss, expected.casing_loss, energy),
        (
            "casing's amplitude",
            run.statistics.casing_amplitude.unwrap_or(0.0),
            expected.casing_amplitude,
            length,
        ),
    ];
    for (what, found, expected, scale) in pairs {
        assert!((found - expected).abs() <= 10.0 * AGREE * scale, "{name}, {what}: {found} {expected}");
    }
    let worn = run.coating.as_ref().map_or(Vec::new(), |coating| coating.worn_depths());
    assert_eq!(worn.len(), expected.worn_depths.len());
    for (found, expected) in worn.iter().flatten().zip(expected.worn_depths.iter().flatten()) {
        assert!((found - expected).abs() < AGREE * length, "{name}: worn {found} {expected}");
    }
    apart
}

/// Asserts that the record shows that an effect was at work.
fn assert_seen(effect: Effect, scene: &Scene) {
    let record = Literal::new(scene).run();
    assert!(record.impulse > 0.0, "no contact");
    match effect {
        Effect::Friction => assert!(record.friction_heat > 0.0),
        Effect::Coating => {
            let thickness = scene.coating.unwrap().thickness;
            let worn = record.worn_depths.concat();
            let deepest = worn.iter().fold(0.0f64, |m, &w| m.max(w));
            assert!(deepest > 0.1 * thickness, "worn {deepest}");
            assert!(worn.contains(&0.0), "untouched rods");
        }
        Effect::FlexibleCasing => assert!(record.casing_amplitude > 1e-3),
        Effect::Mistuning => assert!(record.mistuning_work != 0.0),
        Effect::Excitation => assert!(record.excitation_work != 0.0),
        Effect::Orbit | Effect::ClearanceChange | Effect::Coriolis => {}
    }
    let without = Scene::clone(scene);
    let without = match effect {
        Effect::Friction => Scene { friction: None, ..without },
        Effect::Coating => Scene { coating: None, ..without },
        Effect::FlexibleCasing => Scene { flexible_casing: None, ..without },
        Effect::Orbit => Scene { orbit: None, ..without },
        Effect::ClearanceChange => Scene { clearance_change: None, ..without },
        Effect::Mistuning => Scene { mistuning: None, ..without },
        Effect::Excitation => Scene { excitation: Vec::new(), ..without },
        Effect::Coriolis => {
            let mut without = without;
            without.wheel.harmonics.iter_mut().for_each(|h| h.gyroscopic = None);
            without
        }
    };
    let changed = difference(&Literal::new(&without).run().displacement, &record.displacement);
    assert!(changed > 1e-3, "{effect:?} changes the histories by {changed:e} only");
}

#[test]
fn the_plain_scene_agrees() {
    for sectors in 1..=5 {
        for start in [Start::Rest, Start::Standing, Start::Travelling] {
            let apart = agrees(&Scene::rubbing(sectors, start), &format!("{sectors} {start:?}"));
            println!("{sectors} sectors, {start:?}: {apart:.1e}");
        }
    }
}

#[test]
fn every_effect_alone_agrees() {
    for effect in EFFECTS {
        let mut largest = 0.0f64;
        for sectors in 1..=5 {
            for start in [Start::Rest, Start::Standing, Start::Travelling] {
                let scene = Scene::rubbing(sectors, start).with(&[effect]);
                if sectors > 1 {
                    assert_seen(effect, &scene);
                }
                largest = largest.max(agrees(&scene, &format!("{effect:?}, {sectors} sectors, {start:?}")));
            }
        }
        println!("{effect:?}: {largest:.1e}");
    }
}

#[test]
fn every_pair_of_effects_agrees() {
    for (i, &first) in EFFECTS.iter().enumerate() {
        for &second in &EFFECTS[i + 1..] {
            let mut largest = 0.0f64;
            for (sectors, start) in [(4, Start::Standing), (5, Start::Travelling), (3, Start::Rest)] {
                let scene = Scene::rubbing(sectors, start).with(&[first, second]);
                let name = format!("{first:?} and {second:?}, {sectors} sectors, {start:?}");
                largest = largest.max(agrees(&scene, &name));
            }
            println!("{first:?} and {second:?}: {largest:.1e}");
        }
    }
}

#[test]
fn all_effects_together_agree() {
    for sectors in 1..=5 {
        for start in [Start::Rest, Start::Standing, Start::Travelling] {
            let scene = Scene::rubbing(sectors, start).with(&EFFECTS);
            let apart = agrees(&scene, &format!("{sectors} {start:?}"));
            println!("{sectors} sectors, {start:?}: {apart:.1e}");
        }
    }
}

/// Wheels of many sectors agree, of which only the sectors near a lobe are transformed.
#[test]
fn wheels_of_many_sectors_agree() {
    let laws = [vec![], vec![Effect::Friction], vec![Effect::Coating], vec![Effect::Orbit], EFFECTS.to_vec()];
    for scheme in [Scheme::CentralDifferences, Scheme::ExactModal] {
        for effects in &laws {
            for (sectors, start) in [(17, Start::Rest), (20, Start::Travelling)] {
                // Round-off in the wear by so many blades would grow in a second revolution.
                let scene = Scene { scheme, revolutions: 1, ..Scene::rubbing(sectors, start).with(effects) };
                let apart = agrees(&scene, &format!("{scheme:?} {effects:?} {sectors}"));
                println!("{scheme:?} {effects:?}, {sectors} sectors: {apart:.1e}");
            }
        }
    }
}

/// Effects agree without a casing, where there is another loop.
#[test]
fn effects_without_a_casing_agree() {
    let free = [Effect::Mistuning, Effect::Excitation, Effect::Coriolis];
    for scheme in [Scheme::CentralDifferences, Scheme::ExactModal, Scheme::MasslessBoundary { kept_modes: 2 }]
    {
        for effects in [&free[..1], &free[1..2], &free[2..], &free[..2], &free[1..], &free] {
            for (sectors, start) in [(4, Start::Standing), (5, Start::Travelling)] {
                let scene = Scene { casing: None, scheme, ..Scene::rubbing(sectors, start).with(effects) };
                let apart = agrees(&scene, &format!("{scheme:?} {effects:?} {sectors}"));
                println!("{scheme:?} {effects:?}: {apart:.1e}");
            }
        }
    }
}

/// Effects agree by the exact propagator, the elastic casing included.
#[test]
fn exact_modal_agrees() {
    let pairs = EFFECTS.iter().flat_map(|&a| EFFECTS.iter().map(move |&b| vec![a, b]));
    for effects in pairs.chain([EFFECTS.to_vec()]) {
        for (sectors, start) in [(4, Start::Travelling), (5, Start::Standing)] {
            let scene = Scene { scheme: Scheme::ExactModal, ..Scene::rubbing(sectors, start).with(&effects) };
            agrees(&scene, &format!("{effects:?} {sectors}"));
        }
    }
}

/// Effects agree with a boundary without mass; the casing is rigid there.
#[test]
fn massless_boundary_agrees() {
    let rigid: Vec<_> = EFFECTS.into_iter().filter(|&e| e != Effect::FlexibleCasing).collect();
    let pairs = rigid.iter().flat_map(|&a| rigid.iter().map(move |&b| vec![a, b]));
    for effects in pairs.chain([rigid.clone()]) {
        for (sectors, start) in [(4, Start::Travelling), (5, Start::Standing)] {
            let mut scene = Scene::rubbing(sectors, start);
            // Two families keep their mass, the other three give way at the two contact nodes.
            scene.wheel = crate::scene::wheel(sectors, 2, 5);
            scene.scheme = Scheme::MasslessBoundary { kept_modes: 2 };
            let scene = scene.with(&effects);
            let smallest = scene.scheme.smallest_stable_steps(&scene.wheel, &scene.nodes);
            assert!(smallest <= scene.steps as u64, "{smallest}");
            agrees(&scene, &format!("{effects:?} {sectors}"));
        }
    }
}

/// Directions of sliding that the scenes here are given are those that a request gets.
#[test]
fn directions_of_sliding_agree() {
    let nodes = contact_nodes(4);
    let found = sliding_directions(&nodes, 0.3).unwrap();
    for (node, (found, contact)) in found.iter().zip(&nodes).enumerate() {
        assert_eq!(found.node, node);
        for (found, expected) in found.components.iter().zip(sliding(contact, 0.3)) {
            assert!((found - expected).abs() < 1e-15);
        }
    }
}

/// Effects agree at steps so long that some families stay tuned and some follow statically.
#[test]
fn steps_that_hardly_resolve_the_modes_agree() {
    let effects = [Effect::Mistuning, Effect::Coriolis, Effect::Excitation, Effect::FlexibleCasing];
    for (scheme, steps) in [(Scheme::CentralDifferences, 36), (Scheme::ExactModal, 24)] {
        for sectors in [4, 5] {
            let mut scene = Scene::rubbing(sectors, Start::Travelling);
            scene.wheel = crate::scene::wheel(sectors, 2, 5);
            scene.damping = None;
            (scene.scheme, scene.steps, scene.samples) = (scheme, steps, steps);
            let scene = scene.with(&effects);
            let modes = &scene.wheel.harmonics[0].omega;
            let angles = [modes[0], modes[4]].map(|omega| omega * scene.step_s());
            assert!(angles[0].powi(2) < 3.0 && angles[1].powi(2) > 3.0, "{angles:?}");
            let apart = agrees(&scene, &format!("{scheme:?} {sectors}"));
            println!("{scheme:?} {sectors}: {angles:?} {apart:.1e}");
        }
    }
}

/// Runs repeat to the last bit.
#[test]
fn runs_repeat_to_the_last_bit() {
    let scene = Scene::rubbing(5, Start::Travelling).with(&EFFECTS);
    let (first, second) = (scene.run(), scene.run());
    assert_eq!(first, second);
    let bits = |run| history(run).displacement.concat().iter().map(|u: &f64| u.to_bits()).collect::<Vec<_>>();
    assert_eq!(bits(&first), bits(&second));
}
