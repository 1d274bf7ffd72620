//! Histories, contact and spectra of a run against the literal dense schemes, step by step.

use std::f64::consts::TAU;

use faer::c64;
use rubmap::dynamics::casing::{Casing, Lobes};
use rubmap::dynamics::direction::Direction;
use rubmap::dynamics::effects::Effects;
use rubmap::dynamics::integrate::{Detail, History, Outcome, Revolutions, Run, SensorRow, Simulation};
use rubmap::dynamics::modal_wheel::{ModalWheel, RotationEffects};
use rubmap::dynamics::oscillators::ModalDamping;
use rubmap::dynamics::reduction::{NoCheckpoints, ReducedWheel, ReductionOptions, reduce};
use rubmap::dynamics::schemes::Scheme;
use rubmap::dynamics::schemes::central_differences::smallest_stable_steps;
use rubmap::dynamics::states::{HarmonicStates, WheelStates};
use rubmap_numerics::sector_fourier::SectorFourier;
use rubmap_numerics::spectrum::amplitudes;

use crate::fixtures::{TOP_SPEED, WheelRecipe, wheel};
use crate::oracle::schemes::Literal;
use crate::oracle::{free_gaps, gauss_seidel};

const SPEED: f64 = 0.6 * TOP_SPEED;
const DAMPING: f64 = 0.005;
const SCHEMES: [Scheme; 3] =
    [Scheme::CentralDifferences, Scheme::ExactModal, Scheme::MasslessBoundary { kept_modes: 7 }];

struct Scene {
    reduced: ReducedWheel,
    modal: ModalWheel,
    casing: Casing,
}

impl Scene {
    fn new(recipe: WheelRecipe) -> Self {
        let reduced =
            reduce(&wheel(recipe), &ReductionOptions::new(6), &NoCheckpoints, &|_, _| true).unwrap();
        Self {
            modal: ModalWheel::at(&reduced, SPEED, RotationEffects::stiffening(true)).unwrap(),
            casing: Casing {
                clearance: (0..recipe.contact_nodes).map(|k| 0.30 - 0.02 * k as f64).collect(),
                restriction: Some(
                    Lobes { count: 2, amplitude: 0.425, width_rad: 0.35, phase_rad: 0.1 }.into(),
                ),
                ramp_revolutions: 0.5,
            },
            reduced,
        }
    }

    /// Number of steps, a multiple of `interval`.
    fn steps(&self, interval: usize) -> usize {
        let stable = smallest_stable_steps(self.modal.largest_frequency(), SPEED) as f64;
        ((1.5 * stable).ceil() as usize).next_multiple_of(interval)
    }

    fn sensors(&self) -> Vec<SensorRow> {
        let sensor = |sector: usize, node: usize, components: [f64; 3]| SensorRow {
            direction: Direction { node, components },
            sector,
        };
        let last = self.reduced.sectors - 1;
        vec![sensor(0, 0, [1.0, 0.0, 0.0]), sensor(last, self.reduced.contact.len() - 1, [0.0, 1.0, 0.0])]
    }

    fn run(&self, scheme: Scheme, steps: usize, interval: usize, detail: Option<Detail>) -> Run {
        let damping = ModalDamping { modal_ratio: DAMPING, family_ratios: Vec::new(), ranks: Vec::new() };
        Simulation {
            wheel: &self.modal,
            contact_nodes: &self.reduced.contact,
            damping: Some(&damping),
            casing: Some(&self.casing),
            effects: Effects::default(),
            initial: &[],
            scheme,
            sensors: &self.sensors(),
            steps_per_revolution: steps,
            samples_per_revolution: steps / interval,
            revolutions: 1,
            window_revolutions: 1,
            detail,
            repeats: None,
            states: Some(Revolutions::Last(1)),
        }
        .run(&|_| true)
    }
}

/// Displacements of the two sensors and all contact forces at every step from the first on.
fn literally(scene: &Scene, scheme: Scheme, steps: usize) -> (Vec<[f64; 2]>, Vec<Vec<f64>>) {
    let Scene { reduced, casing, .. } = scene;
    let h = TAU / (SPEED * steps as f64);
    let mut literal = Literal::new(scheme, reduced, SPEED, DAMPING, h);
    let (last_sector, last_node) = (reduced.sectors - 1, reduced.contact.len() - 1);
    (1..=steps + 1)
        .map(|q| {
            literal.step(&free_gaps(casing, reduced, q as f64 / steps as f64), gauss_seidel);
            let displacement =
                [literal.displacement(0, 0, 0), literal.displacement(last_sector, last_node, 1)];
            (displacement, literal.forces().iter().copied().collect())
        })
        .unzip()
}

fn completed(run: &Run) -> &History {
    let Outcome::Completed(history) = &run.outcome else { panic!("{:?}", run.outcome) };
    history
}

const WHOLE: Detail =
    Detail { revolutions: Revolutions::Last(1), velocity: true, contact: true, forces: true, energy: true };

/// Displacement of component `d` of contact node `node` of `sector`, read from the states of the whole wheel.
fn of_states(states: &WheelStates, sectors: usize, (sector, node, d): (usize, usize, usize)) -> Vec<f64> {
    let at = |instant: usize| {
        let of = |harmonic: &HarmonicStates| {
            let angle = TAU * (harmonic.harmonic * sector % sectors) as f64 / sectors as f64;
            (c64::cis(angle) * harmonic.coordinates[(3 * node + d, instant)]).re
        };
        states.harmonics.iter().map(of).sum()
    };
    (0..states.revolutions.len()).map(at).collect()
}

/// Largest difference over the largest truth.
fn apart(found: &[f64], truth: &[f64]) -> f64 {
    assert_eq!(found.len(), truth.len());
    let largest = truth.iter().fold(0.0f64, |most, x| most.max(x.abs()));
    assert!(largest > 0.0);
    found.iter().zip(truth).fold(0.0f64, |most, (a, b)| most.max((a - b).abs())) / largest
}

#[test]
fn histories_are_those_of_the_literal_schemes() {
    for (scheme, recipe, interval) in [
        (SCHEMES[0], WheelRecipe::default(), 4),
        (SCHEMES[1], WheelRecipe { sectors: 7, seed: 2, ..Default::default() }, 3),
        (SCHEMES[2], WheelRecipe { sectors: 5, contact_nodes: 2, seed: 8, ..Default::default() }, 5),
        (SCHEMES[1], WheelRecipe { sectors: 1, seed: 5, ..Default::default() }, 1),
        (SCHEMES[2], WheelRecipe { sectors: 2, contact_nodes: 1, seed: 6, ..Default::default() }, 2),
    ] {
        let scene = Scene::new(recipe);
        let steps = scene.steps(interval);
        let (truth, forces) = literally(&scene, scheme, steps);
        let run = scene.run(scheme, steps, interval, Some(WHOLE));
        let detail = completed(&run).detail.as_ref().unwrap();
        let states = completed(&run).states.as_ref().unwrap();
        let states = WheelStates::of(states, &scene.modal, &scene.reduced, true).unwrap();
        let h = TAU / (SPEED * steps as f64);
        let at = |q: usize, sensor: usize| if q == 0 { 0.0 } else { truth[q - 1][sensor] };
        let what = format!("{scheme:?} {recipe:?}");

        let (last_sector, last_node) = (scene.reduced.sectors - 1, scene.reduced.contact.len() - 1);
        for (sensor, place) in [(0, (0, 0, 0)), (1, (last_sector, last_node, 1))] {
            let samples = (1..=steps / interval).map(|j| j * interval);
            let displacement: Vec<f64> = samples.clone().map(|q| at(q, sensor)).collect();
            assert!(apart(&completed(&run).displacement[sensor], &displacement) < 1e-9, "{what}");
            let of_states = of_states(&states, scene.reduced.sectors, place);
            assert!(apart(&of_states, &displacement) < 1e-9, "{what}: states");
            let velocity: Vec<f64> = samples
                .map(|q| match q {
                    q if q < steps => (at(q + 1, sensor) - at(q - 1, sensor)) / (2.0 * h),
                    q => (3.0 * at(q, sensor) - 4.0 * at(q - 1, sensor) + at(q - 2, sensor)) / (2.0 * h),
                })
                .collect();
            assert!(apart(&detail.velocity[sensor], &velocity) < 1e-9, "{what}");
        }

        let intervals: Vec<&[Vec<f64>]> = forces[..steps].chunks_exact(interval).collect();
        let pairs = forces[0].len();
        let mean = |interval: &&[Vec<f64>], pair: usize| {
            interval.iter().map(|forces| forces[pair]).sum::<f64>() / interval.len() as f64
        };
        let truth_of = |pair: usize| intervals.iter().map(|i| mean(i, pair)).collect::<Vec<f64>>();
        let largest = (0..pairs).flat_map(truth_of).fold(0.0f64, f64::max);
        for pair in 0..pairs {
            for (found, truth) in detail.force[pair].iter().zip(truth_of(pair)) {
                assert!((found - truth).abs() < 1e-9 * largest, "{what}: {found} {truth}");
            }
        }
        let touching = |forces: &Vec<f64>| forces.iter().filter(|&&force| force > 0.0).count() as f64;
        let nodes: Vec<f64> =
            intervals.iter().map(|i| i.iter().map(touching).sum::<f64>() / interval as f64).collect();
        assert!(apart(&detail.nodes_in_contact, &nodes) < 1e-12, "{what}");

        let contact = run.contact.as_ref().unwrap();
        let mut of_pairs = 0.0;
        for (pair, found) in contact.pairs.iter().enumerate() {
            let line: Vec<f64> = forces[..steps].iter().map(|forces| forces[pair]).collect();
            let impulse = h * line.iter().sum::<f64>();
            assert!((found.impulse - impulse).abs() < 1e-9 * h * largest * steps as f64, "{what}");
            assert_eq!(found.steps as usize, line.iter().filter(|&&force| force > 0.0).count(), "{what}");
            let before = [0.0].into_iter().chain(line.iter().copied());
            let closings = before.zip(&line).filter(|(before, now)| *before == 0.0 && **now > 0.0).count();
            assert_eq!(found.closings as usize, closings, "{what}");
            let peak = truth_of(pair).into_iter().fold(0.0, f64::max);
            assert!((found.peak_force - peak).abs() < 1e-9 * largest, "{what}");
            // The histories' forces integrate to the impulse.
            let integral = h * interval as f64 * detail.force[pair].iter().sum::<f64>();
            assert!((found.impulse - integral).abs() <= 1e-12 * found.impulse, "{what}");
            of_pairs += found.impulse;
        }
        let total = run.statistics.contact_impulse;
        assert!(total > 0.0 && (of_pairs - total).abs() < 1e-12 * total, "{what}");
    }
}

#[test]
fn energy_parts_add_up_at_every_sample() {
    for scheme in SCHEMES {
        let scene = Scene::new(WheelRecipe::default());
        let run = scene.run(scheme, scene.steps(4), 4, Some(WHOLE));
        let detail = completed(&run).detail.as_ref().unwrap();
        assert_eq!(detail.energy.len(), scene.steps(4) / 4);
        let most = run.energy.largest_energy();
        for audit in &detail.energy {
            let (initial, now) = audit.ends();
            assert!((initial + audit.work() - audit.loss() - now).abs() < 1e-9 * most, "{scheme:?}");
        }
        assert_eq!(detail.energy.last(), Some(&run.energy));
    }
}

/// Details that are recorded change no bit of what happens, and any revolutions of them are the same.
#[test]
fn details_change_nothing() {
    for scheme in SCHEMES {
        let scene = Scene::new(WheelRecipe::default());
        let steps = scene.steps(4);
        let plain = scene.run(scheme, steps, 4, None);
        let mut detailed = scene.run(scheme, steps, 4, Some(WHOLE));
        let Outcome::Completed(history) = &mut detailed.outcome else { panic!() };
        assert!(history.detail.take().is_some());
        assert_eq!(plain, detailed);
    }
}

/// Spectra of the samples against those of every step: nothing folds.
#[test]
fn spectra_are_those_of_all_steps() {
    for scheme in SCHEMES {
        let scene = Scene::new(WheelRecipe::default());
        let interval = 8;
        let steps = scene.steps(interval).max(64 * interval);
        let samples = steps / interval;
        let run = scene.run(scheme, steps, interval, None);
        let history = completed(&run);
        let (truth, _) = literally(&scene, scheme, steps);
        let row = SectorFourier::new(10);
        let (mut picked_worst, mut worst) = (0.0f64, 0.0f64);
        for (sensor, sector) in [(0, 0), (1, 9)] {
            let bins = samples / 8;
            let every: Vec<f64> = truth[..steps].iter().map(|u| u[sensor]).collect();
            let truth = amplitudes(&every, bins);
            let columns = row.row(sector).iter().zip(&history.harmonics[sensor]);
            let mut filtered = vec![0.0; samples];
            for (f, column) in columns {
                filtered.iter_mut().zip(column).for_each(|(sum, value)| *sum += f * value);
            }
            worst = worst.max(apart(&amplitudes(&filtered, bins), &truth));
            picked_worst = picked_worst.max(apart(&amplitudes(&history.displacement[sensor], bins), &truth));
        }
        println!("{scheme:?}: {samples} samples of {steps}: picked {picked_worst:.1e}, filtered {worst:.1e}");
        assert!(worst < 1e-4, "{scheme:?}: {worst:e}");
        assert!(worst < 0.1 * picked_worst, "{scheme:?}: {worst:e} {picked_worst:e}");
    }
}
