//! Step loop, top to bottom.
//!
//! With mass at the contact, a step predicts every modal oscillator (Eq. 8), reads the normal displacement of every
//! contact node and solves the complementarity problem of the gaps (Eqs 9, 10) for the forces that complete it; they are
//! applied together with the next step's prediction, in one pass over the mode shapes, or before the state is recorded.
//! Without mass at the contact, the forces of the last instant carry the modes to the next one, where the boundary then
//! finds its own equilibrium.
//!
//! Whole runs, parts of runs and flows differ in what they make of the steps, the [`Observer`]; the steps themselves are taken in ranges by
//! one loop, in [`steps`].

mod kernels;
mod steps;
mod stretch;

use faer::Mat;
use pulp::Arch;

#[cfg(test)]
use super::super::casing::RestrictionTable;
use super::super::energy::EnergyAudit;
use super::super::flexible_casing::CasingMotion;
use super::super::initial::{InitialMode, Stepped};
use super::super::oscillators::Oscillators;
use super::super::oscillators::driven::Drive;
use super::super::schemes::Scheme;
use super::super::statistics::RunStatistics;
use super::bounds::Bounds;
use super::contact::Contact;
use super::instant::Instant;
use super::recorder::Recorder;
use super::repetition::Repetition;
use super::revolutions::Repeated;
use super::run::{Outcome, Run};
use super::simulation::Simulation;
use super::step_range::{Observer, StepRange};
use super::trace::Trace;
use rubmap_numerics::sector_fourier::SectorFourier;

/// Number of steps between two checks of progress and cancellation: some tens of milliseconds.
const WATCHED_STEPS: u64 = 1 << 14;

/// Everything a step changes or reads; built before the loop, nothing is allocated in it.
#[derive(Debug)]
pub(super) struct Stepper {
    /// Vectors to compute on.
    arch: Arch,
    fourier: SectorFourier,
    oscillators: Oscillators,
    /// Drive of the wheel by everything but contact.
    drive: Option<Drive>,
    contact: Option<Contact>,
    /// Whether contact forces act from the instant at which they close a gap, instead of completing its step.
    massless: bool,
    /// Whether modes too fast for the step follow statically.
    follow: bool,
    /// Whether motion may decay to nothing.
    decays: bool,
    /// Bounds of the displacements, for a wheel that may touch something.
    bounds: Option<Bounds>,
    recorder: Recorder,
    /// Detection of motion that repeats, for a run that may end because of it.
    repetition: Option<Repetition>,
    statistics: RunStatistics,
    energy: EnergyAudit,
    /// Energy at the end of the last whole revolution.
    last_energy: Option<f64>,
}

/// Forces that act when a run begins.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Beginning {
    /// Run without forces at its beginning: the wheel touches nothing yet.
    Free,
    /// Run under the forces of the state that it begins with.
    UnderWay,
}

impl Stepper {
    pub(super) fn new(simulation: &Simulation<'_>) -> Self {
        Self::beginning_at(simulation, 0.0, simulation.casing.is_some())
    }

    /// Stepper of a simulation whose initial state is that after `revolutions`, and whose fast modes `follow` or not.
    pub(super) fn beginning_at(simulation: &Simulation<'_>, revolutions: f64, follow: bool) -> Self {
        let (wheel, scheme) = (simulation.wheel, simulation.scheme);
        let fourier = SectorFourier::new(wheel.sectors);
        let touching = simulation.casing.is_some();
        let mut oscillators = Oscillators::new(
            wheel,
            scheme,
            simulation.step_s(),
            simulation.damping,
            touching,
            follow,
            simulation.initial,
        );
        let contact =
            simulation.casing.map(|casing| Contact::new(simulation, casing, &oscillators, &fourier));
        let bounds = simulation.casing.map(|_| Bounds::new(simulation, &oscillators));
        let loaded = contact.as_ref().map(|contact| contact.loads().rows);
        let mut drive = Drive::new(
            wheel,
            simulation.contact_nodes.len(),
            &simulation.effects,
            &oscillators,
            &fourier,
            simulation.step_s(),
            loaded,
        );
        if let Some(drive) = &mut drive {
            drive.start(wheel, simulation.initial, &mut oscillators, revolutions);
        }
        let effects = drive.is_some() || contact.as_ref().is_some_and(Contact::is_affected);
        let repetition = simulation.repeats.map(|repeats| Repetition::new(simulation, repeats, &oscillators));
        Self {
            arch: rubmap_numerics::vectors::arch(),
            repetition,
            follow,
            massless: matches!(scheme, Scheme::MasslessBoundary { .. }),
            decays: effects || oscillators.dissipates(),
            recorder: Recorder::new(
                simulation,
                &oscillators,
                &fourier,
                contact.as_ref().map(|contact| contact.tally.interval()).unwrap_or_default(),
            ),
            statistics: RunStatistics::default(),
            energy: EnergyAudit::starting_at(oscillators.energy()),
            last_energy: None,
            fourier,
            oscillators,
            drive,
            contact,
            bounds,
        }
    }

    #[cfg(test)]
    pub(super) fn replace_restriction(&mut self, restriction: RestrictionTable) {
        if let Some(contact) = &mut self.contact {
            contact.gaps.restriction = Some(restriction);
        }
    }

    /// Runs on vectors of another kind than the widest of the processor.
    #[cfg(test)]
    pub(super) fn on(self, arch: Arch) -> Self {
        Self { arch, ..self }
    }

    /// Runs `simulation` to its end.
    pub(super) fn run(
        &mut self,
        simulation: &Simulation<'_>,
        beginning: Beginning,
        watch: &dyn Fn(f64) -> bool,
    ) -> Run {
        let begun = match beginning {
            Beginning::Free => Ok(()),
            Beginning::UnderWay => self.take_up(Instant::beginning(0)),
        };
        let ended = begun.and_then(|()| self.integrate(simulation, watch));
        let outcome = match ended {
            Ok(()) => Outcome::Completed(self.recorder.take()),
            Err(ended) => *ended,
        };
        self.statistics.casing_amplitude = self.flexible_casing().map(CasingMotion::largest_amplitude);
        let coating = self.contact.as_ref().and_then(Contact::coating).cloned();
        let contact = self.contact.as_ref().map(|contact| contact.tally.record().clone());
        let repeated = match &outcome {
            Outcome::Completed(history) => history.repeated,
            _ => None,
        };
        let run = Run { outcome, statistics: self.statistics, energy: self.energy, coating, contact };
        match repeated {
            Some(Repeated { after, period, .. }) => {
                let window = simulation.window_revolutions;
                run.repeated(period, after + window, window)
            }
            None => run,
        }
    }

    /// Finds the forces that act where a run takes up a motion. They are of the step before the first: nothing of them counts.
    fn take_up(&mut self, start: Instant) -> Result<(), Box<Outcome>> {
        if self.touches_at(start) {
            let (statistics, energy) = (self.statistics, self.energy);
            self.solve(start)?;
            (self.statistics, self.energy) = (statistics, energy);
            if let Some(contact) = &mut self.contact {
                contact.tally.sample(|_, _| 0.0, None);
            }
        }
        Ok(())
    }

    fn integrate(
        &mut self,
        simulation: &Simulation<'_>,
        watch: &dyn Fn(f64) -> bool,
    ) -> Result<(), Box<Outcome>> {
        let steps = simulation.steps_per_revolution;
        let sampling = steps / simulation.samples_per_revolution;
        if self.recorder.reads(0, false) {
            self.read(false);
        }
        let mut end = simulation.revolutions;
        let mut window = end - simulation.window_revolutions..end;
        let mut revolution = 0;
        while revolution < end {
            let windowed = window.contains(&revolution);
            if windowed && let Some(contact) = &mut self.contact {
                contact.tally.begin_window();
            }
            for before in (0..steps).step_by(sampling) {
                let range = StepRange { revolution, before, steps: sampling, per_revolution: steps };
                self.take(range, Observer::Recorder { windowed })?;
                let now = range.end();
                self.look_up(watch, range, now.revolutions / end as f64)?;
                self.record(now, windowed)?;
            }
            self.last_energy = Some(self.mechanical_energy());
            self.recorder.end_revolution(&self.oscillators);
            revolution += 1;
            if revolution < window.start
                && let Some(repeated) = self.repeats(revolution)
            {
                end = revolution + repeated.period;
                window = revolution..end;
                self.recorder.end_after(repeated);
                if self.recorder.reads(self.statistics.steps, false) {
                    self.read(false);
                }
            }
        }
        self.end(simulation, end);
        Ok(())
    }

    /// Takes steps from the state the oscillators are in, without recording anything but what touches. For scenes whose state is that of
    /// the oscillators.
    pub(super) fn flow(&mut self, range: StepRange, trace: &mut Trace) -> Result<(), Box<Outcome>> {
        let start = Instant::beginning(range.revolution);
        if self.touches_at(start) {
            self.solve(start)?;
            self.trace(0, trace);
        }
        self.take(range, Observer::Trace(trace))?;
        let revolutions = range.revolution as f64 + range.steps as f64 / range.per_revolution as f64;
        self.check_bounds(self.oscillators.energy(), revolutions)
    }

    /// Tells what the last solution has touch at the end of `step`.
    fn trace(&self, step: usize, trace: &mut Trace) {
        if let Some(contact) = &self.contact {
            contact.trace(step, trace);
        }
    }

    pub(super) fn oscillators(&self) -> &Oscillators {
        &self.oscillators
    }

    /// Whether effects act on the wheel or on contact.
    fn is_affected(&self) -> bool {
        self.drive.is_some() || self.contact.as_ref().is_some_and(Contact::is_affected)
    }

    /// Stiffness −∂f/∂z of mistuning between the Fourier columns of every family that it couples.
    pub(super) fn mistuned(&self) -> Vec<Mat<f64>> {
        self.drive.as_ref().map(Drive::mistuned).unwrap_or_default()
    }

    /// Adds the part of the drive, `revolutions` after the start, to increments that are those of free motion.
    pub(super) fn drive_from(
        &mut self,
        simulation: &Simulation<'_>,
        modes: &[InitialMode],
        revolutions: f64,
    ) {
        if let Some(drive) = &mut self.drive {
            drive.start(simulation.wheel, modes, &mut self.oscillators, revolutions);
        }
    }

    /// Puts modes and casing where another motion left them.
    pub(super) fn go_on_from(&mut self, from: &Stepped) {
        self.oscillators.go_on_from(&from.modes);
        if let Some(casing) = self.flexible_casing_mut() {
            casing.go_on_from(&from.casing);
        }
        self.energy = EnergyAudit::starting_at(self.mechanical_energy());
    }

    /// Now and then asks whether to go on, `done` being the share of work done after `range`.
    fn look_up(&self, watch: &dyn Fn(f64) -> bool, range: StepRange, done: f64) -> Result<(), Box<Outcome>> {
        let (steps, before) = (self.statistics.steps, self.statistics.steps - range.steps as u64);
        if steps / WATCHED_STEPS != before / WATCHED_STEPS && !watch(done) {
            return Err(Box::new(Outcome::Cancelled));
        }
        Ok(())
    }

    /// z and ż of all modes after `revolutions`, the end; increments are left as free motion would have them.
    fn modes_at_end(&mut self, simulation: &Simulation<'_>, revolutions: f64) -> Vec<InitialMode> {
        let follow = self.follow;
        let read = |oscillators: &Oscillators| modal_state(simulation, oscillators, follow);
        if let Some(drive) = &mut self.drive {
            drive.end(simulation.wheel, revolutions, &mut self.oscillators, read);
        }
        read(&self.oscillators)
    }

    /// Stores the state at the end, as free motion would have it.
    fn end(&mut self, simulation: &Simulation<'_>, revolutions: usize) {
        let modes = self.modes_at_end(simulation, revolutions as f64);
        let casing = self.flexible_casing().map(CasingMotion::stepped).unwrap_or_default();
        let steps = self.statistics.steps;
        self.recorder.end(simulation.wheel, &self.oscillators, &self.fourier, modes, casing, steps);
    }

    /// Motion that was found to repeat after `revolution`, if the run may end because of it.
    fn repeats(&mut self, revolution: usize) -> Option<Repeated> {
        let casing = self.contact.as_ref().and_then(Contact::casing);
        self.repetition.as_mut()?.look(revolution, &self.oscillators, casing)
    }

    fn mechanical_energy(&self) -> f64 {
        self.oscillators.energy() + self.flexible_casing().map_or(0.0, CasingMotion::energy)
    }

    pub(super) fn flexible_casing(&self) -> Option<&CasingMotion> {
        self.contact.as_ref()?.casing()
    }

    pub(super) fn flexible_casing_mut(&mut self) -> Option<&mut CasingMotion> {
        self.contact.as_mut()?.casing_mut()
    }
}

/// Displacements z and velocities ż of every mode, its increment being that of free motion.
fn modal_state(simulation: &Simulation<'_>, oscillators: &Oscillators, follow: bool) -> Vec<InitialMode> {
    let step = simulation.step_s();
    oscillators.modal_state(|harmonic, family, z, d| {
        let omega = simulation.wheel.harmonics[harmonic].omega[family];
        let zeta = simulation.damping.map_or(0.0, |damping| damping.ratio(harmonic, family));
        simulation.scheme.velocity(omega, zeta, step, z, d, follow)
    })
}
