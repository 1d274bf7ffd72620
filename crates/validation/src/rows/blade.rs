//! Wheel of one sector or few with modes that are given, and its simulation.

use anyhow::bail;
use faer::{Mat, c64};
use rubmap_wheel::dynamics::casing::Casing;
use rubmap_wheel::dynamics::direction::Direction;
use rubmap_wheel::dynamics::effects::Effects;
use rubmap_wheel::dynamics::initial::InitialMode;
use rubmap_wheel::dynamics::integrate::{Outcome, Run, SensorRow, Simulation};
use rubmap_wheel::dynamics::modal_wheel::{ModalHarmonic, ModalWheel};
use rubmap_wheel::dynamics::oscillators::ModalDamping;
use rubmap_wheel::dynamics::schemes::Scheme;
use rubmap_wheel::dynamics::sector::ContactNode;

/// Speed Ω of all wheels here, rad/s.
pub(super) const SPEED: f64 = 1000.0;

/// Largest energy that a run may leave unaccounted for, relative.
const ENERGY: f64 = 1e-9;

/// Simulation of a small wheel, with what it owns.
#[derive(Debug)]
pub(super) struct Blade {
    pub(super) wheel: ModalWheel,
    pub(super) nodes: Vec<ContactNode>,
    pub(super) damping: Option<ModalDamping>,
    pub(super) casing: Option<Casing>,
    pub(super) initial: Vec<InitialMode>,
    pub(super) scheme: Scheme,
    pub(super) steps: usize,
    pub(super) samples: usize,
    pub(super) revolutions: usize,
}

impl Blade {
    /// Blade of one sector with a contact node at (100, 0, 0) whose normal is radial, with these natural frequencies and shapes there; undamped,
    /// at rest, without casing.
    pub(super) fn new(omega: Vec<f64>, shapes: &[[f64; 3]]) -> Self {
        let contact = Mat::from_fn(3, omega.len(), |row, mode| c64::from(shapes[mode][row]));
        let modes = ModalHarmonic { harmonic: 0, single: true, omega, contact, gyroscopic: None };
        Self {
            wheel: ModalWheel { speed_rad_s: SPEED, sectors: 1, repeats: 1, harmonics: vec![modes] },
            nodes: vec![ContactNode {
                id: 1,
                position: [100.0, 0.0, 0.0],
                normal: [1.0, 0.0, 0.0],
                dofs: [0, 1, 2],
            }],
            damping: None,
            casing: None,
            initial: Vec::new(),
            scheme: Scheme::ExactModal,
            steps: 4000,
            samples: 400,
            revolutions: 1,
        }
    }

    /// Blade with the damping ratio ζ in all modes.
    pub(super) fn damped(mut self, ratio: f64) -> Self {
        self.damping =
            Some(ModalDamping { modal_ratio: ratio, family_ratios: Vec::new(), ranks: Vec::new() });
        self
    }

    /// Blade in a circular casing.
    pub(super) fn in_casing(mut self, clearance: f64, ramp_revolutions: f64) -> Self {
        let clearance = vec![clearance; self.nodes.len()];
        self.casing = Some(Casing { clearance, restriction: None, ramp_revolutions });
        self
    }

    /// Duration of a step, s.
    pub(super) fn step_s(&self) -> f64 {
        std::f64::consts::TAU / (self.wheel.speed_rad_s * self.steps as f64)
    }

    /// Simulation with `effects` and `sensors`.
    pub(super) fn simulation<'a>(&'a self, effects: Effects<'a>, sensors: &'a [SensorRow]) -> Simulation<'a> {
        Simulation {
            wheel: &self.wheel,
            contact_nodes: &self.nodes,
            damping: self.damping.as_ref(),
            casing: self.casing.as_ref(),
            effects,
            initial: &self.initial,
            sensors,
            scheme: self.scheme,
            steps_per_revolution: self.steps,
            samples_per_revolution: self.samples,
            revolutions: self.revolutions,
            window_revolutions: 0,
            repeats: None,
            detail: None,
            states: None,
        }
    }

    /// Run with `effects` and its displacements `[component][sample]` r, θ and z of the first contact node of sector 0.
    ///
    /// # Errors
    /// A run that does not end, or loses energy.
    pub(super) fn run(&self, effects: Effects<'_>) -> anyhow::Result<(Run, Vec<Vec<f64>>)> {
        self.run_seen(effects, &[[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|axis| at(0, axis)))
    }

    /// Run with `effects` and its displacements `[sensor][sample]`.
    ///
    /// # Errors
    /// As of [`Self::run`].
    pub(super) fn run_seen(
        &self,
        effects: Effects<'_>,
        sensors: &[SensorRow],
    ) -> anyhow::Result<(Run, Vec<Vec<f64>>)> {
        let mut run = self.simulation(effects, sensors).run(&|_| true);
        let lost = run.energy.residual();
        if lost > ENERGY {
            bail!("the run loses {lost:.1e} of its energy");
        }
        let seen = match &mut run.outcome {
            Outcome::Completed(history) => std::mem::take(&mut history.displacement),
            other => bail!("the run did not end: {other:?}"),
        };
        Ok((run, seen))
    }
}

/// Sensor at the first contact node of a sector.
pub(super) fn at(sector: usize, components: [f64; 3]) -> SensorRow {
    SensorRow { direction: Direction { node: 0, components }, sector }
}

/// Largest difference between `found` and `exact(sample)`, over the largest of `exact`.
pub(super) fn difference(found: &[f64], exact: impl Fn(usize) -> f64) -> f64 {
    let (mut apart, mut largest) = (0.0f64, 0.0f64);
    for (sample, &u) in found.iter().enumerate() {
        let exact = exact(sample);
        apart = apart.max((u - exact).abs());
        largest = largest.max(exact.abs());
    }
    apart / largest
}

/// Largest of relative errors of `found` against `exact`.
pub(super) fn relative(pairs: impl IntoIterator<Item = (f64, f64)>) -> f64 {
    pairs.into_iter().fold(0.0, |most: f64, (found, exact)| most.max((found / exact - 1.0).abs()))
}
