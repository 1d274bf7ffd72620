//! The step loop, top to bottom.
//!
//! With mass at the contact, a step predicts every modal oscillator (Eq. 8), reads the normal displacement of every
//! contact node and solves the complementarity problem of the gaps (Eqs 9, 10) for the forces that complete it; they are
//! applied together with the next step's prediction, in one pass over the mode shapes. Without mass at the contact, the
//! forces of the last instant carry the modes to the next one, where the boundary then finds its own equilibrium.
//!
//! Scenes with effects have a loop of their own, so that the others do not even ask for them.

use pulp::Simd;

#[cfg(test)]
use super::super::casing::RestrictionTable;
use super::super::energy::EnergyAudit;
use super::super::flexible_casing::CasingMotion;
use super::super::initial::InitialMode;
use super::super::oscillators::driven::Drive;
use super::super::oscillators::{Loads, Oscillators};
use super::super::schemes::Scheme;
use super::super::statistics::RunStatistics;
use super::bounds::Bounds;
use super::obstacle::Obstacle;
use super::recorder::Recorder;
use super::run::{Divergence, Outcome, Run};
use super::simulation::Simulation;
use super::surroundings::applied;
use rubmap_numerics::sector_fourier::SectorFourier;

/// Steps between two looks at progress and cancellation: some tens of milliseconds.
const WATCHED_STEPS: u64 = 1 << 14;

/// Steps between two looks for motion that has decayed to nothing.
const QUENCHED_STEPS: u64 = 16;

/// Contact of a scene and of its scheme, decided before the loop.
mod contact {
    pub(super) const NONE: u8 = 0;
    /// The force that closes the gap completes the step.
    pub(super) const COMPLETES: u8 = 1;
    /// The force acts from the instant at which it closes the gap.
    pub(super) const MASSLESS: u8 = 2;
    /// Any of these, asked for at every step: in scenes with effects.
    pub(super) const ASKED: u8 = 3;
}

/// Everything a step changes or reads; built before the loop, nothing is allocated in it.
#[derive(Debug)]
pub(super) struct Stepper {
    fourier: SectorFourier,
    oscillators: Oscillators,
    /// What else than contact moves the wheel.
    drive: Option<Drive>,
    obstacle: Option<Obstacle>,
    /// Of a wheel that may touch something.
    bounds: Option<Bounds>,
    recorder: Recorder,
    statistics: RunStatistics,
    energy: EnergyAudit,
    /// Energy at the end of the last whole revolution.
    last_energy: Option<f64>,
}

impl Stepper {
    pub(super) fn new(simulation: &Simulation<'_>) -> Self {
        let (wheel, scheme) = (simulation.wheel, simulation.scheme);
        let fourier = SectorFourier::new(wheel.sectors);
        let touching = simulation.casing.is_some();
        let mut oscillators = Oscillators::new(
            wheel,
            scheme,
            simulation.step_s(),
            simulation.damping,
            touching,
            simulation.initial,
        );
        let obstacle =
            simulation.casing.map(|casing| Obstacle::new(simulation, casing, &oscillators, &fourier));
        let bounds = simulation.casing.map(|_| Bounds::new(simulation, &oscillators));
        let step = simulation.step_s();
        let mut drive = Drive::new(wheel, &simulation.effects, &oscillators, &fourier, step);
        if let Some(drive) = &mut drive {
            drive.start(wheel, simulation.initial, &mut oscillators);
        }
        let recorder = Recorder::new(simulation, &fourier);
        let energy = EnergyAudit::starting_at(oscillators.energy());
        let statistics = RunStatistics::default();
        Self {
            fourier,
            oscillators,
            drive,
            obstacle,
            bounds,
            recorder,
            statistics,
            energy,
            last_energy: None,
        }
    }

    #[cfg(test)]
    pub(super) fn replace_restriction(&mut self, restriction: RestrictionTable) {
        if let Some(obstacle) = &mut self.obstacle {
            obstacle.restriction = Some(restriction);
        }
    }

    /// Chooses the loop of the scene and its scheme.
    #[inline(always)]
    pub(super) fn run<S: Simd>(
        &mut self,
        simd: S,
        simulation: &Simulation<'_>,
        watch: &dyn Fn(f64) -> bool,
    ) -> Run {
        use contact::{ASKED, COMPLETES, MASSLESS, NONE};
        let massless = is_massless(simulation);
        let surrounded = self.obstacle.as_ref().is_some_and(|obstacle| obstacle.surroundings.is_some());
        let effects = self.drive.is_some() || surrounded;
        let outcome = match (effects, self.oscillators.dissipates(), self.obstacle.is_some(), massless) {
            (false, true, false, _) => self.integrate::<S, true, NONE, false>(simd, simulation, watch),
            (false, false, false, _) => self.integrate::<S, false, NONE, false>(simd, simulation, watch),
            (false, true, true, false) => {
                self.integrate::<S, true, COMPLETES, false>(simd, simulation, watch)
            }
            (false, false, true, false) => {
                self.integrate::<S, false, COMPLETES, false>(simd, simulation, watch)
            }
            (false, true, true, true) => self.integrate::<S, true, MASSLESS, false>(simd, simulation, watch),
            (false, false, true, true) => {
                self.integrate::<S, false, MASSLESS, false>(simd, simulation, watch)
            }
            (true, ..) => self.integrate::<S, true, ASKED, true>(simd, simulation, watch),
        };
        let outcome = match outcome {
            Ok(()) => Outcome::Completed(self.recorder.take()),
            Err(ended) => ended,
        };
        self.statistics.casing_amplitude = self.flexible_casing().map(CasingMotion::largest_amplitude);
        let coating = self.obstacle.as_ref().and_then(Obstacle::worn_coating).cloned();
        Run { outcome, statistics: self.statistics, energy: self.energy, coating }
    }

    #[inline(always)]
    fn integrate<S: Simd, const DISSIPATES: bool, const CONTACT: u8, const EFFECTS: bool>(
        &mut self,
        simd: S,
        simulation: &Simulation<'_>,
        watch: &dyn Fn(f64) -> bool,
    ) -> Result<(), Outcome> {
        let steps = simulation.steps_per_revolution;
        let sampling = steps / simulation.samples_per_revolution;
        let massless = is_massless(simulation);
        let window_start = simulation.revolutions - simulation.window_revolutions;
        for revolution in 0..simulation.revolutions {
            for step in 1..=steps {
                let revolutions = revolution as f64 + step as f64 / steps as f64;
                if EFFECTS {
                    let before = revolution as f64 + (step - 1) as f64 / steps as f64;
                    self.advance_wheel(simd, massless, before);
                } else if CONTACT == contact::NONE {
                    self.energy.add(self.oscillators.advance::<S, DISSIPATES>(simd));
                } else {
                    self.advance_touching::<S, DISSIPATES, CONTACT>(simd);
                }
                if CONTACT != contact::NONE {
                    self.touch::<S, EFFECTS>(simd, step % steps, revolutions)?;
                }
                self.statistics.steps += 1;
                if DISSIPATES && self.statistics.steps.is_multiple_of(QUENCHED_STEPS) {
                    self.oscillators.quench();
                    if EFFECTS
                        && let Some(casing) = self.obstacle.as_mut().and_then(Obstacle::flexible_casing)
                    {
                        casing.quench();
                    }
                }
                if self.statistics.steps.is_multiple_of(WATCHED_STEPS)
                    && !watch(revolutions / simulation.revolutions as f64)
                {
                    return Err(Outcome::Cancelled);
                }
                if step % sampling == 0 {
                    if CONTACT == contact::COMPLETES || (EFFECTS && !massless) {
                        self.complete::<S, DISSIPATES, EFFECTS>(simd);
                    }
                    if CONTACT != contact::NONE {
                        self.check_penetration::<S, EFFECTS>(simd, step % steps, revolutions);
                    }
                    let energy = self.mechanical_energy();
                    self.energy.check(energy);
                    self.record(simd, revolution >= window_start);
                    self.check_bounds(energy, revolutions)?;
                }
            }
            self.last_energy = Some(self.mechanical_energy());
            self.recorder.end_revolution(&self.oscillators);
        }
        if let Some(drive) = &mut self.drive {
            let read = |oscillators: &Oscillators| modal_state(simulation, oscillators);
            drive.end(simulation.wheel, simulation.revolutions as f64, &mut self.oscillators, read);
        }
        self.recorder.end(modal_state(simulation, &self.oscillators));
        Ok(())
    }

    /// A step of a wheel that may touch the casing, up to its gaps.
    #[inline(always)]
    fn advance_touching<S: Simd, const DISSIPATES: bool, const CONTACT: u8>(&mut self, simd: S) {
        let Some(obstacle) = &mut self.obstacle else {
            return;
        };
        let loads = Loads { rows: &obstacle.loaded, force: &obstacle.force };
        let (rows, out) = (&obstacle.rows, &mut obstacle.harmonic);
        let exchange = if CONTACT == contact::MASSLESS {
            self.oscillators.advance_loaded::<S, DISSIPATES>(simd, rows, (rows, loads), out)
        } else {
            self.oscillators.complete_and_predict::<S, DISSIPATES>(simd, rows, (rows, loads), out)
        };
        self.energy.add(exchange);
        obstacle.clear_forces(&self.fourier);
    }

    /// A step of a wheel with effects that starts after `revolutions`, up to its gaps.
    #[inline(always)]
    fn advance_wheel<S: Simd>(&mut self, simd: S, massless: bool, revolutions: f64) {
        let Self { oscillators, drive, obstacle, energy, .. } = self;
        let Some(obstacle) = obstacle else {
            let exchange = match drive {
                Some(drive) => {
                    oscillators.advance_driven(simd, drive, None, revolutions, energy.effects_mut())
                }
                None => oscillators.advance::<S, true>(simd),
            };
            return energy.add(exchange);
        };
        let loads = Loads { rows: &obstacle.loaded, force: &obstacle.force };
        let applied = applied(obstacle.surroundings.as_ref(), &obstacle.rows);
        let (rows, out) = (&obstacle.rows, &mut obstacle.harmonic);
        let exchange = match (drive, massless) {
            (None, true) => oscillators.advance_loaded::<S, true>(simd, rows, (applied, loads), out),
            (None, false) => oscillators.complete_and_predict::<S, true>(simd, rows, (applied, loads), out),
            (Some(drive), massless) => {
                let work = energy.effects_mut();
                let exchange = if massless {
                    oscillators.advance_driven(simd, drive, Some((applied, loads)), revolutions, work)
                } else {
                    let exchange = oscillators.complete_driven(simd, drive, applied, loads, work);
                    oscillators.predict_driven(simd, drive, revolutions);
                    exchange
                };
                oscillators.project(simd, rows, out);
                exchange
            }
        };
        energy.add(exchange);
        if let Some(casing) = obstacle.flexible_casing() {
            energy.add_casing(casing.complete());
            casing.predict();
        }
        obstacle.clear_forces(&self.fourier);
    }

    /// Contact at the end of a step; `step` is its position in the revolution.
    #[inline(always)]
    fn touch<S: Simd, const EFFECTS: bool>(
        &mut self,
        simd: S,
        step: usize,
        revolutions: f64,
    ) -> Result<(), Outcome> {
        let Some(obstacle) = &mut self.obstacle else {
            return Ok(());
        };
        if obstacle.predict_gaps::<S, EFFECTS>(simd, &self.fourier, step, revolutions) >= 0.0 {
            return Ok(());
        }
        obstacle
            .solve::<EFFECTS>(&self.fourier, step, &mut self.statistics, self.energy.effects_mut())
            .map_err(|error| Outcome::ContactFailed { revolutions, error })
    }

    /// Completes the last step now instead of with the next one.
    #[inline(always)]
    fn complete<S: Simd, const DISSIPATES: bool, const EFFECTS: bool>(&mut self, simd: S) {
        let Some(obstacle) = &mut self.obstacle else {
            return;
        };
        let loads = Loads { rows: &obstacle.loaded, force: &obstacle.force };
        let surroundings = if EFFECTS { obstacle.surroundings.as_ref() } else { None };
        let applied = applied(surroundings, &obstacle.rows);
        let exchange = match &mut self.drive {
            Some(drive) if EFFECTS => {
                let work = self.energy.effects_mut();
                self.oscillators.complete_driven(simd, drive, applied, loads, work)
            }
            _ => self.oscillators.complete::<S, DISSIPATES>(simd, applied, loads),
        };
        self.energy.add(exchange);
        if EFFECTS && let Some(casing) = obstacle.flexible_casing() {
            self.energy.add_casing(casing.complete());
        }
        obstacle.clear_forces(&self.fourier);
    }

    fn mechanical_energy(&self) -> f64 {
        self.oscillators.energy() + self.flexible_casing().map_or(0.0, CasingMotion::energy)
    }

    fn flexible_casing(&self) -> Option<&CasingMotion> {
        self.obstacle.as_ref()?.surroundings.as_ref()?.casing.as_ref()
    }

    /// Holds what the contact solution promised against the state.
    #[inline(always)]
    fn check_penetration<S: Simd, const EFFECTS: bool>(&mut self, simd: S, step: usize, revolutions: f64) {
        let Some(obstacle) = &mut self.obstacle else { return };
        let left =
            obstacle.penetration::<S, EFFECTS>(simd, &self.oscillators, &self.fourier, step, revolutions);
        self.statistics.largest_penetration = self.statistics.largest_penetration.max(left);
    }

    #[inline(always)]
    fn record<S: Simd>(&mut self, simd: S, windowed: bool) {
        let force = self.obstacle.as_ref().map(|obstacle| obstacle.force.as_slice());
        self.recorder.record(simd, &self.oscillators, &self.fourier, force, windowed);
    }

    #[inline(never)]
    fn check_bounds(&mut self, energy: f64, revolutions: f64) -> Result<(), Outcome> {
        let force = self.obstacle.as_ref().map_or(&[][..], |obstacle| obstacle.force.as_slice());
        let tip = match &mut self.bounds {
            Some(bounds) => bounds.exceeded(&self.oscillators, &self.fourier, energy, force),
            None => None,
        };
        if energy.is_finite() && tip.is_none() {
            return Ok(());
        }
        Err(Outcome::Diverged(Divergence {
            revolutions,
            tip,
            energy_growth: self.last_energy.map(|last| energy / last),
        }))
    }
}

/// z and ż of every mode, its increment being that of free motion.
fn modal_state(simulation: &Simulation<'_>, oscillators: &Oscillators) -> Vec<InitialMode> {
    let (step, touching) = (simulation.step_s(), simulation.casing.is_some());
    oscillators.modal_state(|harmonic, family, z, d| {
        let omega = simulation.wheel.harmonics[harmonic].omega[family];
        let zeta = simulation.damping.map_or(0.0, |damping| damping.ratio(family));
        simulation.scheme.velocity(omega, zeta, step, z, d, touching)
    })
}

fn is_massless(simulation: &Simulation<'_>) -> bool {
    matches!(simulation.scheme, Scheme::MasslessBoundary { .. })
}
