//! Friction as a disc against the literal model, which finds its forces by repetition, and in a mirror.

use rubmap::dynamics::casing::Lobes;
use rubmap::dynamics::schemes::Scheme;

use crate::agreement::agrees;
use crate::literal::Literal;
use crate::scene::{Effect, Scene, Start, difference, history};

const SCHEMES: [Scheme; 2] = [Scheme::CentralDifferences, Scheme::ExactModal];

/// Effects that a disc may be together with.
const OTHERS: [Effect; 5] =
    [Effect::FlexibleCasing, Effect::Orbit, Effect::Mistuning, Effect::Excitation, Effect::Coriolis];

/// Scene that rubs by a disc, with tips that run at `share` of their speed: their radius is in nothing else.
fn rubbing(sectors: usize, start: Start, share: f64) -> Scene {
    let mut scene = Scene { disc: true, revolutions: 1, ..Scene::rubbing(sectors, start) };
    // Three directions of two nodes, which have to be told apart where they stick.
    scene.wheel = crate::scene::wheel(sectors, 2, 8);
    scene.friction = Some(0.1);
    scene.nodes.iter_mut().for_each(|node| node.position[0] *= share);
    scene
}

#[test]
fn a_disc_agrees_alone_and_with_every_effect() {
    for scheme in SCHEMES {
        for others in
            [&[][..], &OTHERS[..1], &OTHERS[1..2], &OTHERS[2..3], &OTHERS[3..4], &OTHERS[4..], &OTHERS]
        {
            for (sectors, start) in [(1, Start::Rest), (4, Start::Standing), (5, Start::Travelling)] {
                let scene = Scene { scheme, ..rubbing(sectors, start, 1.0).with(others) };
                let apart = agrees(&scene, &format!("{scheme:?} {others:?} {sectors}"));
                println!("{scheme:?} {others:?} {sectors}: {apart:.1e}");
            }
        }
    }
}

/// Discs on many sectors agree, of which only the sectors near a lobe are transformed.
#[test]
fn a_disc_on_many_sectors_agrees() {
    for scheme in SCHEMES {
        for (sectors, start) in [(17, Start::Rest), (20, Start::Travelling)] {
            let apart =
                agrees(&Scene { scheme, ..rubbing(sectors, start, 1.0) }, &format!("{scheme:?} {sectors}"));
            println!("{scheme:?} {sectors}: {apart:.1e}");
        }
    }
}

/// Slow tips, which run hardly faster than they vibrate, and one that hardly runs: they slide in all directions, turn, and stick.
#[test]
fn slow_tips_stick_and_slide_as_literally() {
    for scheme in SCHEMES {
        let mut stuck = 0;
        let pressed = [(4, Start::Standing, true), (5, Start::Travelling, true)];
        for (sectors, start, pressed) in
            [(4, Start::Standing, false), (5, Start::Travelling, false)].into_iter().chain(pressed)
        {
            let mut scene = Scene { scheme, friction: Some(0.3), ..rubbing(sectors, start, 0.05) };
            scene.nodes[1].position[0] *= 0.01;
            if pressed {
                let casing = scene.casing.as_mut().unwrap();
                // The lobe is as wide as the casing and comes slowly.
                casing.restriction =
                    Some(Lobes { count: 1, amplitude: 0.4, width_rad: 4.0, phase_rad: 0.1 }.into());
                casing.ramp_revolutions = 1.0;
            }
            let apart = agrees(&scene, &format!("{scheme:?} {sectors}"));
            let record = Literal::new(&scene).run();
            let counted = scene.run().statistics.sticking;
            println!("{scheme:?} {sectors}: {apart:.1e}, stuck {} {counted}", record.sticking);
            stuck += record.sticking;
            // The counts may differ by steps where one model takes friction for all of its limit, the other for all but 1e-9.
            assert!(record.sticking.abs_diff(counted as usize) <= 2);
        }
        assert!(stuck > 300, "{scheme:?}: {stuck}");
    }
}

/// Wheel that turns backwards: seen in a mirror, it turns forwards. θ and z change sign, sectors are numbered backwards, and a wave
/// e^{jisα} is its conjugate.
#[test]
fn reversed_rotation_mirrors_the_response() {
    let sign = [1.0, -1.0, -1.0];
    let mirrored = |components: [f64; 3]| [0, 1, 2].map(|d| sign[d] * components[d]);
    for scheme in SCHEMES {
        for (share, sectors) in [(1.0, 5), (0.05, 4)] {
            let scene = Scene { scheme, ..rubbing(sectors, Start::Travelling, share) };
            let mut seen = scene.clone();
            for modes in &mut seen.wheel.harmonics {
                let shapes = &mut modes.contact;
                for row in 0..shapes.nrows() {
                    for column in 0..shapes.ncols() {
                        shapes[(row, column)] = shapes[(row, column)].conj() * sign[row % 3];
                    }
                }
            }
            for node in &mut seen.nodes {
                node.position = mirrored(node.position);
                node.normal = mirrored(node.normal);
            }
            for mode in &mut seen.initial {
                (mode.displacement, mode.velocity) = (mode.displacement.conj(), mode.velocity.conj());
            }
            for sensor in &mut seen.sensors {
                sensor.direction.components = mirrored(sensor.direction.components);
                sensor.sector = (sectors - sensor.sector) % sectors;
            }
            seen.casing.as_mut().unwrap().restriction =
                Some(Lobes { count: 2, amplitude: 0.42, width_rad: 0.35, phase_rad: -0.1 }.into());
            let run = seen.run();
            let expected = Literal::new(&scene).backwards().run();
            let apart = difference(&history(&run).displacement, &expected.displacement);
            assert!(apart < 1e-9, "{scheme:?} {share}: {apart:e}");
            let forwards = Literal::new(&scene).run();
            assert!(difference(&forwards.displacement, &expected.displacement) > 1e-2, "no matter which way");
        }
    }
}

/// Slow tips show what the sliding law leaves out.
#[test]
fn a_disc_is_not_sliding() {
    for share in [1.0, 0.1] {
        let disc = rubbing(4, Start::Travelling, share);
        let sliding = Scene { disc: false, ..disc.clone() };
        let apart = difference(&history(&disc.run()).displacement, &history(&sliding.run()).displacement);
        println!("{share}: {apart:.1e}");
        assert!(apart > 1e-6);
    }
}
