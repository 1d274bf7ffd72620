//! Convergence of histories with the step: how fast, and that all schemes converge to the same one.

use std::f64::consts::{PI, TAU};

use faer::{Mat, c64};
use rubmap::dynamics::casing::{Casing, Lobes};
use rubmap::dynamics::direction::Direction;
use rubmap::dynamics::effects::Effects;
use rubmap::dynamics::initial::InitialMode;
use rubmap::dynamics::integrate::{Outcome, SensorRow, Simulation};
use rubmap::dynamics::modal_wheel::{ModalHarmonic, ModalWheel, RotationEffects};
use rubmap::dynamics::oscillators::ModalDamping;
use rubmap::dynamics::reduction::{NoCheckpoints, ReductionOptions, reduce};
use rubmap::dynamics::schemes::Scheme;
use rubmap::dynamics::sector::{ContactNode, SectorModel};
use rubmap::impeller::{ImpellerParameters, PaperCasing, generate};
use rubmap::package::to_sector;

use crate::fixtures::{TOP_SPEED, WheelRecipe, wheel};

/// Wheel at one speed against two lobes.
struct Scene {
    wheel: ModalWheel,
    contact: Vec<ContactNode>,
    casing: Casing,
    damping_ratio: f64,
    revolutions: usize,
}

/// Number of samples of a revolution at which histories are compared.
const SAMPLES: usize = 100;

impl Scene {
    fn new(
        sector: &SectorModel,
        modes_per_speed: usize,
        speed: f64,
        stiffening: bool,
        casing: Casing,
    ) -> Self {
        let reduced =
            reduce(sector, &ReductionOptions::new(modes_per_speed), &NoCheckpoints, &|_, _| true).unwrap();
        let wheel = ModalWheel::at(&reduced, speed, RotationEffects::stiffening(stiffening)).unwrap();
        Self { wheel, contact: reduced.contact, casing, damping_ratio: 0.005, revolutions: 1 }
    }

    /// Scene of ten sectors of masses and springs.
    fn small() -> Self {
        let lobes = Lobes { count: 2, amplitude: 0.425, width_rad: 0.35, phase_rad: 0.1 };
        let casing =
            Casing { clearance: vec![0.3; 3], restriction: Some(lobes.into()), ramp_revolutions: 0.5 };
        Self::new(&wheel(WheelRecipe::default()), 6, 0.6 * TOP_SPEED, true, casing)
    }

    /// Scene of the impeller of the demo in its casing at 24,000 rpm.
    fn demo() -> Self {
        let parameters = ImpellerParameters::default();
        let sector = to_sector(generate(&parameters).unwrap()).unwrap();
        let paper = PaperCasing::of(&parameters);
        let positions: Vec<_> = sector.contact.iter().map(|node| node.position).collect();
        let clearance = rubmap::dynamics::casing::clearance_along_chord(
            paper.leading_clearance,
            paper.trailing_clearance,
            &positions,
        );
        let lobes = Lobes { count: 2, amplitude: paper.restriction, width_rad: 0.35, phase_rad: 0.0 };
        let casing = Casing { clearance, restriction: Some(lobes.into()), ramp_revolutions: 1.0 };
        let mut scene = Self::new(&sector, 20, 24_000.0 * TAU / 60.0, true, casing);
        scene.revolutions = 2;
        scene
    }

    /// Radial displacement of the first node of sector 0, `steps` a multiple of the samples.
    fn tip(&self, scheme: Scheme, steps: usize) -> Vec<f64> {
        let damping =
            ModalDamping { modal_ratio: self.damping_ratio, family_ratios: Vec::new(), ranks: Vec::new() };
        let sensor = SensorRow { direction: Direction { node: 0, components: [1.0, 0.0, 0.0] }, sector: 0 };
        let run = Simulation {
            wheel: &self.wheel,
            contact_nodes: &self.contact,
            damping: (self.damping_ratio > 0.0).then_some(&damping),
            casing: Some(&self.casing),
            effects: Effects::default(),
            initial: &[],
            sensors: &[sensor],
            scheme,
            steps_per_revolution: steps,
            samples_per_revolution: SAMPLES,
            revolutions: self.revolutions,
            window_revolutions: 1,
            repeats: None,
            detail: None,
            states: None,
        }
        .run(&|_| true);
        match run.outcome {
            Outcome::Completed(mut history) => {
                println!(
                    "  {scheme:?} {steps}: energy {:e} contact {}",
                    run.energy.largest_energy(),
                    run.statistics.contact_share()
                );
                history.displacement.swap_remove(0)
            }
            other => panic!("{scheme:?} {steps}: {other:?}"),
        }
    }

    /// Smallest stable number of steps, to the next multiple of the samples.
    fn smallest(&self, scheme: Scheme) -> usize {
        (scheme.smallest_stable_steps(&self.wheel, &self.contact) as usize).next_multiple_of(SAMPLES)
    }
}

/// Root mean square of the difference of two histories over that of the second.
fn error(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    let squares = |values: &mut dyn Iterator<Item = f64>| values.map(|x| x * x).sum::<f64>();
    (squares(&mut a.iter().zip(b).map(|(a, b)| a - b)) / squares(&mut b.iter().copied())).sqrt()
}

/// Observed order between the first and the last of errors whose step is halved from one to the next.
fn order(errors: &[f64]) -> f64 {
    (errors[0] / errors[errors.len() - 1]).log2() / (errors.len() - 1) as f64
}

/// Orders over the first revolution. With mass at the contact, the instant of each closing is a matter of the step.
#[test]
fn orders_on_a_small_wheel() {
    let scene = Scene::small();
    let finest = 204_800;
    let errors = |scheme: Scheme, fine: &[f64], from: usize| -> Vec<f64> {
        let steps = [400, 800, 1600, 3200, 6400, 12_800];
        steps.iter().filter(|&&s| s >= from).map(|&steps| error(&scene.tip(scheme, steps), fine)).collect()
    };
    let limit = scene.tip(Scheme::CentralDifferences, finest);
    for scheme in [Scheme::CentralDifferences, Scheme::ExactModal] {
        let fine = scene.tip(scheme, finest);
        // Free motion is as good as exact in both at this step: they have one limit.
        let apart = error(&fine, &limit);
        assert!(apart < 1e-6, "{scheme:?}: {apart:e}");
        let errors = errors(scheme, &fine, 1600);
        assert!((1.0..2.0).contains(&order(&errors)), "{scheme:?}: {errors:?}");
    }
    for kept_modes in [4, 7, 12, 16] {
        let scheme = Scheme::MasslessBoundary { kept_modes };
        let errors = errors(scheme, &scene.tip(scheme, finest), scene.smallest(scheme));
        assert!((1.6..2.4).contains(&order(&errors)), "{scheme:?}: {errors:?}");
    }
}

/// Orders and limits on the impeller of the demo over two revolutions: 900 unknowns and more, 73 modes per nodal diameter.
#[test]
fn orders_and_limits_on_the_impeller() {
    let mut scene = Scene::demo();
    let central = scene.smallest(Scheme::CentralDifferences);
    let limit = scene.tip(Scheme::ExactModal, 8 * central);
    let errors = |scheme, steps: &[usize]| -> Vec<f64> {
        steps.iter().map(|&steps| error(&scene.tip(scheme, steps), &limit)).collect()
    };
    // The limit of schemes with mass is one: 4.7e-4 apart at eight times the smallest number of steps, of first order.
    let differences = errors(Scheme::CentralDifferences, &[central, 2 * central, 4 * central, 8 * central]);
    assert!((1.0..2.2).contains(&order(&differences)), "{differences:?}");
    assert!(differences[3] < 1e-3, "{differences:?}");
    // The exact propagator is there at a fraction of the steps, most modes of the lowest number following statically.
    let exact = errors(Scheme::ExactModal, &[900, 1800, 3600, 7200]);
    assert!((1.5..3.5).contains(&order(&exact)), "{exact:?}");
    assert!(exact[2] < 5e-4, "{exact:?}");
    // Without mass at the boundary the limit is another one. It comes closer with every mode kept, 3.3e-2, 2.4e-2 and 1.9e-2
    // for 30, 40 and 50 of 73: what is left is the inertia of the tail and the energy its mass loses at every closing.
    let mut apart = Vec::new();
    for kept_modes in [30, 40, 50] {
        let scheme = Scheme::MasslessBoundary { kept_modes };
        apart.push(error(&scene.tip(scheme, 16 * scene.smallest(scheme)), &limit));
    }
    assert!(apart[0] < 0.05 && apart[2] < 0.025 && apart.is_sorted_by(|a, b| a > b), "{apart:?}");
    // The error is of second order towards the scheme's own limit.
    scene.revolutions = 1;
    for kept_modes in [30, 40, 50] {
        let scheme = Scheme::MasslessBoundary { kept_modes };
        let smallest = scene.smallest(scheme);
        let own = scene.tip(scheme, 16 * smallest);
        let errors: Vec<f64> =
            [1, 2, 4, 8].iter().map(|factor| error(&scene.tip(scheme, factor * smallest), &own)).collect();
        assert!((1.7..2.7).contains(&order(&errors)), "{kept_modes} kept: {errors:?}");
    }
}

/// Free vibration of a mass between its spring and a stop at distance d, amplitude A: Ω/ω0 = π/(π − arccos(d/A)) where
/// the stop is rigid and gives all energy back. The stop is the residual flexibility of a stiff mode.
#[test]
fn a_mass_bounces_off_a_stop_at_the_frequency_of_restitution_one() {
    let tip = ContactNode { id: 0, position: [1e9, 0.0, 0.0], normal: [1.0, 0.0, 0.0], dofs: [0, 1, 2] };
    let scheme = Scheme::MasslessBoundary { kept_modes: 1 };
    for share in [0.9, 0.75, 0.5, 0.25, 0.0f64] {
        let mut contact = Mat::<c64>::zeros(3, 2);
        // Here ω0 = 1 and the flexibility is (10/10⁴)²: in contact the mass swings at ω_c = 1000 ω0.
        contact[(0, 0)] = c64::new(1.0, 0.0);
        contact[(0, 1)] = c64::new(10.0, 0.0);
        let modes =
            ModalHarmonic { harmonic: 0, single: true, omega: vec![1.0, 1e4], contact, gyroscopic: None };
        // A revolution is ten periods of the free mass.
        let wheel = ModalWheel { speed_rad_s: 0.1, sectors: 1, repeats: 1, harmonics: vec![modes] };
        let steps = 32 * scheme.smallest_stable_steps(&wheel, std::slice::from_ref(&tip)) as usize;
        let start =
            InitialMode { harmonic: 0, family: 0, displacement: c64::new(-1.0, 0.0), velocity: c64::ZERO };
        let run = Simulation {
            wheel: &wheel,
            contact_nodes: std::slice::from_ref(&tip),
            damping: None,
            casing: Some(&Casing { clearance: vec![share], restriction: None, ramp_revolutions: 0.0 }),
            effects: Effects::default(),
            initial: &[start],
            sensors: &[SensorRow {
                direction: Direction { node: 0, components: [1.0, 0.0, 0.0] },
                sector: 0,
            }],
            scheme,
            steps_per_revolution: steps,
            samples_per_revolution: steps,
            revolutions: 2,
            window_revolutions: 1,
            repeats: None,
            detail: None,
            states: None,
        }
        .run(&|_| true);
        let Outcome::Completed(history) = &run.outcome else { panic!("{:?}", run.outcome) };
        let line = &history.displacement[0];
        // These are the turning points on the free side, and not round-off at the stop.
        let turns: Vec<usize> = (1..line.len() - 1)
            .filter(|&q| line[q] < line[q - 1] && line[q] <= line[q + 1] && line[q] < -0.5)
            .collect();
        let (first, last) = (turns[0], turns[turns.len() - 1]);
        let found = TAU * (turns.len() - 1) as f64 / ((last - first) as f64 * TAU / (0.1 * steps as f64));
        let expected = PI / (PI - share.acos());
        // The stop gives way for a thousandth of the time.
        assert!((found / expected - 1.0).abs() < 2e-3, "d/A = {share}: Ω/ω0 = {found} for {expected}");
        assert!((line[last] + 1.0).abs() < 1e-2, "d/A = {share}: amplitude {}", -line[last]);
        assert!(turns.len() > 20, "d/A = {share}");
    }
}
