//! Scenes that the hard cases of time integration share, given to a simulation without the door.

use faer::{Mat, c64};
use rubmap::dynamics::casing::{Casing, Lobes, Profile};
use rubmap::dynamics::direction::Direction;
use rubmap::dynamics::effects::Effects;
use rubmap::dynamics::initial::InitialMode;
use rubmap::dynamics::integrate::{History, Outcome, Run, SensorRow, Simulation};
use rubmap::dynamics::modal_wheel::{ModalHarmonic, ModalWheel, RotationEffects};
use rubmap::dynamics::oscillators::ModalDamping;
use rubmap::dynamics::reduction::{NoCheckpoints, ReductionOptions, reduce};
use rubmap::dynamics::schemes::Scheme;
use rubmap::dynamics::sector::ContactNode;

use crate::fixtures::{TOP_SPEED, WheelRecipe, wheel};
use crate::support::ENERGY_TOLERANCE;

/// Scene: a wheel at one speed, its casing and how it starts; every sample of the run is recorded.
#[derive(Debug, Clone)]
pub(crate) struct Scene {
    pub(crate) wheel: ModalWheel,
    pub(crate) contact: Vec<ContactNode>,
    pub(crate) damping_ratio: f64,
    pub(crate) casing: Option<Casing>,
    pub(crate) initial: Vec<InitialMode>,
    pub(crate) sensors: Vec<SensorRow>,
    /// Number of samples per revolution.
    pub(crate) samples: usize,
    pub(crate) revolutions: usize,
}

impl Scene {
    /// Makes a scene at six tenths of the top speed, well damped, with two lobes that outgrow a clearance of 0.3 over
    /// half a revolution, from rest; the normal displacement of node 0 of sector 0 is recorded.
    pub(crate) fn new(recipe: WheelRecipe) -> Self {
        let reduced =
            reduce(&wheel(recipe), &ReductionOptions::new(6), &NoCheckpoints, &|_, _| true).unwrap();
        let wheel = ModalWheel::at(&reduced, 0.6 * TOP_SPEED, RotationEffects::stiffening(recipe.stiffening))
            .unwrap();
        let mut scene = Self {
            wheel,
            damping_ratio: 0.05,
            casing: Some(Casing {
                clearance: vec![0.3; recipe.contact_nodes],
                restriction: Some(
                    Lobes { count: 2, amplitude: 0.425, width_rad: 0.35, phase_rad: 0.1 }.into(),
                ),
                ramp_revolutions: 0.5,
            }),
            initial: Vec::new(),
            sensors: Vec::new(),
            samples: 64,
            revolutions: 4,
            contact: reduced.contact,
        };
        scene.sensors = vec![scene.normal(0, 0)];
        scene
    }

    /// Sensor of the normal displacement of a contact node.
    pub(crate) fn normal(&self, node: usize, sector: usize) -> SensorRow {
        SensorRow { direction: Direction { node, components: self.contact[node].normal }, sector }
    }

    /// Lobes of the casing.
    pub(crate) fn lobes(&mut self) -> &mut Lobes {
        let parts = &mut self.casing.as_mut().unwrap().restriction.as_mut().unwrap().parts;
        let Profile::Lobes(lobes) = &mut parts[0].profile else { panic!("scenes begin with lobes") };
        lobes
    }

    /// Number of steps per revolution, `factor` times the smallest stable number of the scheme (of central differences,
    /// where the scheme has no limit), a multiple of the samples.
    pub(crate) fn steps(&self, scheme: Scheme, factor: f64) -> usize {
        let bound = match scheme {
            Scheme::ExactModal => Scheme::CentralDifferences,
            other => other,
        };
        let smallest = bound.smallest_stable_steps(&self.wheel, &self.contact);
        ((factor * smallest as f64).ceil().max(360.0) as usize).next_multiple_of(self.samples)
    }

    pub(crate) fn run(&self, scheme: Scheme, steps: usize) -> Run {
        let damping =
            ModalDamping { modal_ratio: self.damping_ratio, family_ratios: Vec::new(), ranks: Vec::new() };
        Simulation {
            wheel: &self.wheel,
            contact_nodes: &self.contact,
            damping: (self.damping_ratio > 0.0).then_some(&damping),
            casing: self.casing.as_ref(),
            effects: Effects::default(),
            initial: &self.initial,
            sensors: &self.sensors,
            scheme,
            steps_per_revolution: steps,
            samples_per_revolution: self.samples,
            revolutions: self.revolutions,
            window_revolutions: self.revolutions,
            repeats: None,
            detail: None,
            states: None,
        }
        .run(&|_| true)
    }

    /// Scene of the same wheel with the contact nodes `nodes` of this one, which may repeat.
    pub(crate) fn with_nodes(&self, nodes: &[usize]) -> Self {
        let contact = |shapes: &Mat<c64>| {
            Mat::from_fn(3 * nodes.len(), shapes.ncols(), |row, mode| {
                shapes[(3 * nodes[row / 3] + row % 3, mode)]
            })
        };
        let mut scene = self.clone();
        for harmonic in &mut scene.wheel.harmonics {
            harmonic.contact = contact(&harmonic.contact);
        }
        scene.contact = nodes.iter().map(|&node| self.contact[node].clone()).collect();
        if let (Some(new), Some(old)) = (&mut scene.casing, &self.casing) {
            new.clearance = nodes.iter().map(|&node| old.clearance[node]).collect();
        }
        scene
    }

    /// Scene with only the `modes` lowest modes of every nodal diameter.
    pub(crate) fn truncated(&self, modes: usize) -> Self {
        let mut scene = self.clone();
        for ModalHarmonic { omega, contact, .. } in &mut scene.wheel.harmonics {
            omega.truncate(modes);
            *contact = contact.subcols(0, modes.min(contact.ncols())).to_owned();
        }
        scene
    }
}

/// History that a completed run recorded.
pub(crate) fn history(run: &Run) -> &History {
    match &run.outcome {
        Outcome::Completed(history) => history,
        other => panic!("{other:?}"),
    }
}

/// Largest absolute value.
pub(crate) fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |m, u| m.max(u.abs()))
}

/// Largest difference of two records, relative to the largest value.
pub(crate) fn difference(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    let worst = a.iter().zip(b).fold(0.0f64, |m, (a, b)| m.max((a - b).abs()));
    worst / largest(a).max(largest(b))
}

/// Asserts that a run is completed, with finite numbers, complementary contact that leaves at most `penetration`, and balanced energy.
pub(crate) fn assert_sound(run: &Run, penetration: f64, context: &str) {
    let history = history(run);
    assert!(history.displacement.iter().flatten().all(|u| u.is_finite()), "{context}");
    let statistics = &run.statistics;
    assert!(statistics.contact_impulse.is_finite(), "{context}: {statistics:?}");
    assert!(statistics.largest_penetration <= penetration, "{context}: {statistics:?}");
    assert!(statistics.smallest_multiplier.unwrap_or(0.0) >= 0.0, "{context}: {statistics:?}");
    let residual = run.energy.residual();
    assert!(residual < ENERGY_TOLERANCE, "{context}: energy residual {residual:e}");
    assert!(run.energy.loss() >= 0.0, "{context}");
}

/// Penetration that a step's contact solution may leave of a gap: round-off of lengths of about one through W.
pub(crate) const PENETRATION: f64 = 1e-12;
