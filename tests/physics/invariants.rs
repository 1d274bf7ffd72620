//! Invariants that hold for every wheel, casing and step: complementarity, the energy identity, symmetry.

use proptest::prelude::*;
use rubmap::dynamics::casing::{Casing, Lobes};
use rubmap::dynamics::direction::Direction;
use rubmap::dynamics::effects::Effects;
use rubmap::dynamics::integrate::{History, Outcome, Run, SensorRow, Simulation};
use rubmap::dynamics::modal_wheel::{ModalWheel, RotationEffects};
use rubmap::dynamics::oscillators::ModalDamping;
use rubmap::dynamics::reduction::{NoCheckpoints, ReducedWheel, ReductionOptions, reduce};
use rubmap::dynamics::schemes::Scheme;
use rubmap::dynamics::schemes::central_differences::smallest_stable_steps;
use rubmap::numerics::sector_fourier::SectorFourier;
use rubmap::response::spectra::nodal_diameter_amplitudes;

use crate::fixed::fixed;
use crate::fixtures::{TOP_SPEED, WheelRecipe, wheel};

const LOBES: Lobes = Lobes { count: 2, amplitude: 0.4, width_rad: 0.35, phase_rad: 0.0 };

struct Scene {
    reduced: ReducedWheel,
    speed: f64,
    damping_ratio: f64,
    casing: Casing,
    steps_factor: f64,
    revolutions: usize,
    sensor: SensorRow,
}

impl Scene {
    fn new(recipe: WheelRecipe) -> Self {
        let sector = wheel(recipe);
        Self {
            reduced: reduce(&sector, &ReductionOptions::new(6), &NoCheckpoints, &|_, _| true).unwrap(),
            speed: 0.55 * TOP_SPEED,
            damping_ratio: 0.05,
            casing: Casing {
                clearance: vec![0.25; recipe.contact_nodes],
                restriction: Some(LOBES.into()),
                ramp_revolutions: 1.0,
            },
            steps_factor: 1.25,
            revolutions: 4,
            sensor: SensorRow { direction: Direction { node: 0, components: [1.0, 0.0, 0.0] }, sector: 0 },
        }
    }

    fn run(&self) -> Run {
        let modal = ModalWheel::at(&self.reduced, self.speed, RotationEffects::stiffening(true)).unwrap();
        let smallest = smallest_stable_steps(modal.largest_frequency(), self.speed) as f64;
        let samples = 64;
        let steps = ((self.steps_factor * smallest).max(720.0) as usize).next_multiple_of(samples);
        let damping =
            ModalDamping { modal_ratio: self.damping_ratio, family_ratios: Vec::new(), ranks: Vec::new() };
        Simulation {
            wheel: &modal,
            contact_nodes: &self.reduced.contact,
            damping: (self.damping_ratio > 0.0).then_some(&damping),
            casing: Some(&self.casing),
            effects: Effects::default(),
            initial: &[],
            scheme: Scheme::CentralDifferences,
            sensors: &[self.sensor],
            steps_per_revolution: steps,
            samples_per_revolution: samples,
            revolutions: self.revolutions,
            window_revolutions: self.revolutions.min(2),
            repeats: None,
            detail: None,
            states: None,
        }
        .run(&|_| true)
    }
}

fn completed(run: &Run) -> &History {
    match &run.outcome {
        Outcome::Completed(history) => history,
        other => panic!("{other:?}"),
    }
}

proptest! {
    #![proptest_config(fixed(40))]

    /// Random wheels (1 to 12 sectors, 1 to 4 contact nodes, random springs), lobes, damping from none to heavy,
    /// steps from 1.02 of the stability limit up: every step's contact solution is complementary and the energy
    /// identity holds.
    #[test]
    fn contact_is_complementary_and_energy_balances(
        sectors in 1usize..13,
        contact_nodes in 1usize..5,
        seed in 1u64..1000,
        lobes in 1u32..5,
        damping_ratio in prop::sample::select(vec![0.0, 0.001, 0.05, 0.3]),
        speed_share in 0.2f64..1.0,
        steps_factor in 1.02f64..4.0,
        amplitude in 0.1f64..0.6,
    ) {
        let recipe = WheelRecipe { sectors, contact_nodes, seed, ..Default::default() };
        let mut scene = Scene::new(recipe);
        scene.speed = speed_share * TOP_SPEED;
        scene.damping_ratio = damping_ratio;
        scene.steps_factor = steps_factor;
        scene.casing.restriction = Some(Lobes { count: lobes, amplitude, width_rad: 0.35, phase_rad: 0.3 }.into());
        let run = scene.run();
        let history = completed(&run);
        prop_assert!(history.displacement[0].iter().all(|u| u.is_finite()));
        // Gaps are differences of lengths of about one: 1e-13 is their round-off through W.
        prop_assert!(run.statistics.largest_penetration < 1e-12, "{:e}", run.statistics.largest_penetration);
        prop_assert!(run.statistics.smallest_multiplier.unwrap_or(0.0) >= 0.0);
        prop_assert!(run.energy.residual() < 1e-9, "{:e}", run.energy.residual());
        prop_assert!(run.energy.loss() >= 0.0);
        if amplitude > 0.27 {
            prop_assert!(run.statistics.contact_steps > 0, "lobes beyond the clearance must touch");
        }
    }
}

/// Symmetry of ten sectors from rest against two lobes: they keep their two-fold symmetry, and with damping that
/// quenches symmetry breaking, odd nodal diameters stay at round-off.
#[test]
fn two_lobes_leave_odd_nodal_diameters_at_round_off() {
    let mut scene = Scene::new(WheelRecipe::default());
    scene.revolutions = 8;
    let run = scene.run();
    assert!(run.statistics.contact_share() > 0.02);
    let diameters = nodal_diameter_amplitudes(&completed(&run).harmonics[0], &SectorFourier::new(10), 2 * 30);
    let largest = |i: usize| diameters[i].iter().fold(0.0f64, |m, &a| m.max(a));
    for odd in [1, 3, 5] {
        assert!(largest(odd) < 1e-10 * largest(0).max(largest(2)), "{odd}: {:e}", largest(odd));
    }
    assert!(largest(2) > 1e-3 && largest(4) > 1e-4);
}

/// Turning the lobes by one sector angle renumbers the sectors: sector 1 of the turned scene does what sector 0 does.
#[test]
fn renumbering_sectors_turns_the_response() {
    for sectors in [7, 10] {
        let mut scene = Scene::new(WheelRecipe { sectors, ..Default::default() });
        // The first revolution and a half is compared, before rounding differences can grow.
        scene.revolutions = 2;
        let reference = scene.run();
        let alpha = std::f64::consts::TAU / sectors as f64;
        scene.casing.restriction = Some(Lobes { phase_rad: alpha, ..LOBES }.into());
        scene.sensor.sector = 1;
        let turned = scene.run();
        let (a, b) = (&completed(&reference).displacement[0], &completed(&turned).displacement[0]);
        let scale = a.iter().fold(0.0f64, |m, u| m.max(u.abs()));
        assert!(scale > 1e-3);
        for (a, b) in a.iter().zip(b) {
            assert!((a - b).abs() < 1e-8 * scale, "{sectors}: {a} {b}");
        }
    }
}

/// Runs of one scene give the same bits every time.
#[test]
fn runs_are_reproducible_to_the_bit() {
    let scene = Scene::new(WheelRecipe::default());
    assert_eq!(scene.run(), scene.run());
}

/// A wheel that nothing touches stays at rest.
#[test]
fn nothing_moves_without_contact() {
    let mut scene = Scene::new(WheelRecipe::default());
    scene.casing.clearance = vec![1.0; 3];
    let run = scene.run();
    assert!(completed(&run).displacement[0].iter().all(|&u| u == 0.0));
    assert_eq!(run.statistics.contact_steps, 0);
    assert_eq!(run.energy.residual(), 0.0);
}
