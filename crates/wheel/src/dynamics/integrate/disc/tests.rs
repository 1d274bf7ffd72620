//! Closed forms of a block on a turning casing, and properties that hold for every wheel.

use std::f64::consts::{PI, TAU};

use faer::{Mat, c64};

use crate::dynamics::casing::{Casing, Lobes};
use crate::dynamics::contact::disc::disc_directions;
use crate::dynamics::contact::friction::sliding_directions;
use crate::dynamics::direction::Direction;
use crate::dynamics::effects::{Effects, Friction, FrictionLaw};
use crate::dynamics::initial::InitialMode;
use crate::dynamics::integrate::{Outcome, Run, SensorRow, Simulation};
use crate::dynamics::modal_wheel::{ModalHarmonic, ModalWheel};
use crate::dynamics::numbers::Numbers;
use crate::dynamics::oscillators::ModalDamping;
use crate::dynamics::schemes::Scheme;
use crate::dynamics::sector::ContactNode;

const SCHEMES: [Scheme; 2] = [Scheme::CentralDifferences, Scheme::ExactModal];

/// Block of mass 1 on springs along r, θ and z, held `pressed` into a casing that passes it at Ω = 1 on the radius 1.
struct Block {
    omega: [f64; 3],
    normal: [f64; 3],
    pressed: f64,
    mu: f64,
    /// Velocity along θ and z.
    velocity: [f64; 2],
    steps: usize,
}

impl Block {
    fn run(&self, scheme: Scheme) -> Run {
        let Self { omega, normal, pressed, mu, velocity, steps } = *self;
        let contact = Mat::from_fn(3, 3, |i, j| if i == j { c64::ONE } else { c64::ZERO });
        let harmonic =
            ModalHarmonic { harmonic: 0, single: true, omega: omega.to_vec(), contact, gyroscopic: None };
        let wheel = ModalWheel { speed_rad_s: 1.0, sectors: 1, repeats: 1, harmonics: vec![harmonic] };
        let nodes = [ContactNode { id: 0, position: [1.0, 0.0, 0.0], normal, dofs: [0, 1, 2] }];
        let casing = Casing { clearance: vec![-pressed], restriction: None, ramp_revolutions: 0.0 };
        let directions = disc_directions(&nodes).unwrap();
        let start = |family: usize, displacement: f64, velocity: f64| InitialMode {
            harmonic: 0,
            family,
            displacement: displacement.into(),
            velocity: velocity.into(),
        };
        let unit = |d: usize| SensorRow {
            direction: Direction {
                node: 0,
                components: std::array::from_fn(|c| f64::from(u8::from(c == d))),
            },
            sector: 0,
        };
        Simulation {
            wheel: &wheel,
            contact_nodes: &nodes,
            damping: None,
            casing: Some(&casing),
            effects: Effects {
                friction: Some(Friction { coefficient: mu, law: FrictionLaw::Disc, directions: &directions }),
                ..Effects::default()
            },
            initial: &[
                start(0, -pressed * normal[0], 0.0),
                start(1, -pressed * normal[1], velocity[0]),
                start(2, -pressed * normal[2], velocity[1]),
            ],
            sensors: &[unit(0), unit(1), unit(2)],
            scheme,
            steps_per_revolution: steps,
            samples_per_revolution: steps,
            revolutions: 1,
            window_revolutions: 1,
            repeats: None,
            detail: None,
            states: None,
        }
        .run(&|_| true)
    }
}

/// Motion along r, θ and z at every step of a run that kept its promises.
fn motion(run: &Run) -> [&[f64]; 3] {
    assert!(run.energy.residual() < 1e-10, "{}", run.energy.residual());
    assert!(run.energy.effects().friction_heat >= 0.0);
    let Outcome::Completed(history) = &run.outcome else { panic!("{:?}", run.outcome) };
    [0, 1, 2].map(|d| history.displacement[d].as_slice())
}

/// Block that a slowly passing casing takes along, u = −rΩt, until its spring pulls as hard as friction can, u = −μN/k. From there the
/// block swings about that place with the casing's velocity, u = −μN/k − (rΩ/ω) sin ω(t − t₁), and meets the casing again after one period,
/// when its velocity is that of the casing: it sticks for a moment of no length, and slides on.
#[test]
fn a_block_sticks_and_slips_as_in_closed_form() {
    let (omega, pressed, mu) = (60.0, 0.02, 0.4);
    let block = |steps| Block {
        omega: [120.0, omega, 80.0],
        normal: [1.0, 0.0, 0.0],
        pressed,
        mu,
        velocity: [-1.0, 0.0],
        steps,
    };
    let slips = mu * pressed * 120.0f64.powi(2) / (omega * omega);
    let exact = |t: f64| {
        if t < slips { -t } else { -slips - (omega * (t - slips)).sin() / omega }
    };
    for scheme in SCHEMES {
        let error = |steps: usize| {
            let run = block(steps).run(scheme);
            let [r, theta, z] = motion(&run);
            let h = TAU / steps as f64;
            // To the end of the first period; there the slightest error decides how long it sticks.
            let until = slips + 0.9 * TAU / omega;
            let count = (until / h) as usize;
            let sticking = run.statistics.sticking as f64 * h;
            assert!(sticking >= slips - 2.0 * h, "{sticking} {slips}");
            assert!(r.iter().all(|u| (u + pressed).abs() < 1e-12) && z.iter().all(|u| *u == 0.0));
            let away = |(step, u): (usize, &f64)| (u - exact((step + 1) as f64 * h)).abs();
            theta.iter().take(count).enumerate().map(away).fold(0.0, f64::max)
        };
        let (coarse, fine) = (error(20_000), error(80_000));
        // The step in which it slips is not resolved: first order. A thousandth of the swing is 1.7e-5.
        assert!(fine < 2e-5 && fine < 0.5 * coarse, "{scheme:?}: {coarse:e} {fine:e}");
    }
}

/// Block that moves across a much faster rotation: it loses its motion as to a damper of μN/rΩ. Amplitudes decay by e^{−μNt/2mrΩ}, which
/// the law of tips that slide forwards leaves out.
#[test]
fn sliding_across_the_rotation_damps() {
    let (omega, pressed, mu) = (40.0, 0.02, 0.5);
    let velocity = 0.01;
    for scheme in SCHEMES {
        let steps = 40_000;
        let block = Block {
            omega: [50.0, 300.0, omega],
            normal: [1.0, 0.0, 0.0],
            pressed,
            mu,
            velocity: [0.0, velocity],
            steps,
        };
        let run = block.run(scheme);
        let [_, theta, z] = motion(&run);
        let damping = mu * pressed * 50.0f64.powi(2);
        let damped = (omega * omega - damping * damping / 4.0).sqrt();
        let exact = |t: f64| velocity / damped * (-damping * t / 2.0).exp() * (damped * t).sin();
        // μN = 25 damps by e^{−12.5 t}: a tenth of the revolution is four times its inverse.
        let count = steps / 10;
        let away = |(step, u): (usize, &f64)| (u - exact((step + 1) as f64 * TAU / steps as f64)).abs();
        let most = z.iter().take(count).enumerate().map(away).fold(0.0, f64::max);
        // Neglected: the block's own motion along the rotation, which starts with a jerk to −μN/k = −2.8e-4 and swings at 300 rad/s
        // with velocities of a twelfth of rΩ, undamped.
        assert!(most < 0.02 * velocity / omega, "{scheme:?} {most:e}");
        assert!(theta.iter().all(|u| *u <= 1e-15));
        assert_eq!(run.statistics.sticking, 0);
    }
}

/// Block that sticks over a whole revolution: a wall that is nearly across the rotation passes by a hundredth of rΩ, and the block goes with it.
#[test]
fn a_block_sticks_as_long_as_friction_holds_it() {
    for scheme in SCHEMES {
        let across = 0.01f64;
        let along = (1.0 - across * across).sqrt();
        let (pressed, soft) = (0.05, 5.0);
        // Softly held along r, into which the wall takes it by 2π·0.01; pressed hard along θ.
        let block = Block {
            omega: [soft, 100.0, soft],
            normal: [across, along, 0.0],
            pressed,
            mu: 0.9,
            velocity: [0.0, 0.0],
            steps: 4000,
        };
        let run = block.run(scheme);
        let [r, theta, _] = motion(&run);
        assert_eq!(run.statistics.sliding, 0, "{scheme:?}");
        assert_eq!(run.statistics.sticking, 4000);
        // t = (−along, across): it is taken back along t by rΩ·across·t.
        for (step, (r, theta)) in r.iter().zip(theta).enumerate() {
            let t = (step + 1) as f64 * TAU / 4000.0;
            let expected = -across * t;
            let found = -along * r + across * theta;
            // v is a difference over two steps, which two interleaved motions share: the start sets them apart by no more than one.
            assert!((found - expected).abs() < 2.0 * across * TAU / 4000.0, "{step}: {found} {expected}");
        }
        assert!(PI * across < 0.1, "no longer a small displacement");
    }
}

/// Wheel under two lobes whose mode shapes are random.
struct Rubbing {
    wheel: ModalWheel,
    nodes: Vec<ContactNode>,
    casing: Casing,
}

impl Rubbing {
    fn new(radius: f64) -> Self {
        const SECTORS: usize = 5;
        let mut numbers = Numbers(11);
        let harmonic = |harmonic: usize| {
            let mut shape = || 100.0 * numbers.next();
            let contact =
                Mat::from_fn(6, 8, |_, _| c64::new(shape(), if harmonic == 0 { 0.0 } else { shape() }));
            let omega = (0..8).map(|m| 2500.0 * (1 + m) as f64 + 400.0 * harmonic as f64).collect();
            ModalHarmonic { harmonic, single: harmonic == 0, omega, contact, gyroscopic: None }
        };
        let node = |k: usize| ContactNode {
            id: k as u64,
            position: [radius, 0.03 * k as f64, 4.0 * k as f64],
            normal: [0.8, 0.0, 0.6],
            dofs: [3 * k, 3 * k + 1, 3 * k + 2],
        };
        let lobes = Lobes { count: 2, amplitude: 0.5, width_rad: 0.4, phase_rad: 0.1 };
        Self {
            wheel: ModalWheel {
                speed_rad_s: 1000.0,
                sectors: SECTORS,
                repeats: 1,
                harmonics: (0..=SECTORS / 2).map(harmonic).collect(),
            },
            nodes: (0..2).map(node).collect(),
            casing: Casing {
                clearance: vec![0.25, 0.3],
                restriction: Some(lobes.into()),
                ramp_revolutions: 0.5,
            },
        }
    }

    fn run(&self, scheme: Scheme, friction: Option<(f64, FrictionLaw)>) -> Run {
        let sliding = |mu| sliding_directions(&self.nodes, mu).unwrap();
        let directions = match friction {
            Some((_, FrictionLaw::Disc)) => disc_directions(&self.nodes).unwrap(),
            Some((mu, FrictionLaw::Sliding)) => sliding(mu),
            None => Vec::new(),
        };
        let friction =
            friction.map(|(coefficient, law)| Friction { coefficient, law, directions: &directions });
        let sensors = [0, 1].map(|node| SensorRow {
            direction: Direction { node, components: [0.5, 0.4, -0.7] },
            sector: 3 * node,
        });
        Simulation {
            wheel: &self.wheel,
            contact_nodes: &self.nodes,
            damping: Some(&ModalDamping { modal_ratio: 0.02, family_ratios: Vec::new(), ranks: Vec::new() }),
            casing: Some(&self.casing),
            effects: Effects { friction, ..Effects::default() },
            initial: &[],
            sensors: &sensors,
            scheme,
            steps_per_revolution: 3000,
            samples_per_revolution: 600,
            revolutions: 2,
            window_revolutions: 1,
            repeats: None,
            detail: None,
            states: None,
        }
        .run(&|_| true)
    }
}

/// Largest difference of two histories over the largest displacement.
fn difference(a: &Run, b: &Run) -> f64 {
    let of = |run: &Run| {
        assert!(run.energy.residual() < 1e-10, "{}", run.energy.residual());
        let Outcome::Completed(history) = &run.outcome else { panic!("{:?}", run.outcome) };
        assert!(run.statistics.contact_impulse > 0.0);
        history.displacement.concat()
    };
    let (a, b) = (of(a), of(b));
    let apart = a.iter().zip(&b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    apart / a.iter().map(|a| a.abs()).fold(0.0, f64::max)
}

#[test]
fn no_coefficient_is_no_friction() {
    let rubbing = Rubbing::new(100.0);
    for scheme in SCHEMES {
        let none = rubbing.run(scheme, None);
        let disc = |mu| rubbing.run(scheme, Some((mu, FrictionLaw::Disc)));
        assert!(difference(&none, &disc(0.0)) < 1e-10);
        // In proportion to μ.
        let (more, less) = (difference(&none, &disc(1e-4)), difference(&none, &disc(1e-5)));
        assert!(more < 1e-2 && less < 0.3 * more && less > 0.0, "{more:e} {less:e}");
    }
}

/// Vibration turns the sliding of tips the less, the faster they run: only friction knows the radius.
#[test]
fn a_fast_rotation_leaves_sliding_tips() {
    for scheme in SCHEMES {
        let apart = |radius: f64| {
            let rubbing = Rubbing::new(radius);
            let [sliding, disc] =
                [FrictionLaw::Sliding, FrictionLaw::Disc].map(|law| rubbing.run(scheme, Some((0.05, law))));
            assert!(disc.statistics.sliding > 0);
            difference(&sliding, &disc)
        };
        let (slow, fast, fastest) = (apart(1e3), apart(1e5), apart(1e7));
        assert!(slow > 1e-4 && fast < 0.05 * slow && fastest < 0.05 * fast, "{slow:e} {fast:e} {fastest:e}");
    }
}

/// Friction never adds energy, with every step and coefficient, even at tips that are no faster than they vibrate.
#[test]
fn energy_is_never_gained() {
    for radius in [3.0, 10.0, 100.0] {
        let rubbing = Rubbing::new(radius);
        for scheme in SCHEMES {
            for mu in [0.02, 0.1] {
                let run = rubbing.run(scheme, Some((mu, FrictionLaw::Disc)));
                assert!(!matches!(run.outcome, Outcome::ContactFailed { .. }), "{:?}", run.outcome);
                assert!(run.energy.residual() < 1e-10, "{}", run.energy.residual());
                assert!(run.energy.effects().friction_heat > 0.0);
            }
        }
    }
}
