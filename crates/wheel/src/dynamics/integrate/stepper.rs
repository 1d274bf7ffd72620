//! The step loop, top to bottom.
//!
//! With mass at the contact, a step predicts every modal oscillator (Eq. 8), reads the normal displacement of every
//! contact node and solves the complementarity problem of the gaps (Eqs 9, 10) for the forces that complete it; they are
//! applied together with the next step's prediction, in one pass over the mode shapes, or before the state is recorded.
//! Without mass at the contact, the forces of the last instant carry the modes to the next one, where the boundary then
//! finds its own equilibrium.
//!
//! What of this a scene and its scheme have is a [`Motion`], with a loop of its own each: scenes without effects do not
//! even ask for them.

mod stretch;

use faer::Mat;
use pulp::Simd;

#[cfg(test)]
use super::super::casing::RestrictionTable;
use super::super::energy::EnergyAudit;
use super::super::flexible_casing::CasingMotion;
use super::super::initial::{InitialMode, Stepped};
use super::super::oscillators::Oscillators;
use super::super::oscillators::driven::Drive;
use super::super::oscillators::rows::Rows;
use super::super::schemes::Scheme;
use super::super::statistics::RunStatistics;
use super::bounds::Bounds;
use super::instant::Instant;
use super::obstacle::Obstacle;
use super::recorder::Recorder;
use super::repetition::Repetition;
use super::revolutions::Repeated;
use super::run::{Divergence, Outcome, Run};
use super::simulation::Simulation;
use super::surroundings::Surroundings;
use super::trace::Trace;
use rubmap_numerics::sector_fourier::SectorFourier;

/// Steps between two looks at progress and cancellation: some tens of milliseconds.
const WATCHED_STEPS: u64 = 1 << 14;

/// Steps between two looks for motion that has decayed to nothing.
const QUENCHED_STEPS: u64 = 16;

/// Everything a step changes or reads; built before the loop, nothing is allocated in it.
#[derive(Debug)]
pub(super) struct Stepper {
    fourier: SectorFourier,
    oscillators: Oscillators,
    /// What else than contact moves the wheel.
    drive: Option<Drive>,
    obstacle: Option<Obstacle>,
    /// What effects make of the obstacle.
    surroundings: Option<Surroundings>,
    /// Whether contact forces act from the instant at which they close a gap, instead of completing its step.
    massless: bool,
    /// Whether modes too fast for the step follow statically.
    follow: bool,
    /// Whether motion may decay to nothing.
    decays: bool,
    /// Of a wheel that may touch something.
    bounds: Option<Bounds>,
    recorder: Recorder,
    /// Of a run that may end because its motion repeats.
    repetition: Option<Repetition>,
    statistics: RunStatistics,
    energy: EnergyAudit,
    /// Energy at the end of the last whole revolution.
    last_energy: Option<f64>,
}

/// Whether forces act when a run begins.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Beginning {
    /// None: the wheel touches nothing yet.
    Free,
    /// Those of the state it begins with.
    UnderWay,
}

impl Stepper {
    pub(super) fn new(simulation: &Simulation<'_>) -> Self {
        Self::beginning_at(simulation, 0.0, simulation.casing.is_some())
    }

    /// Of a simulation whose initial state is that after `revolutions`, and whose fast modes `follow` or not.
    pub(super) fn beginning_at(simulation: &Simulation<'_>, revolutions: f64, follow: bool) -> Self {
        let (wheel, scheme) = (simulation.wheel, simulation.scheme);
        let fourier = SectorFourier::new(wheel.sectors);
        let touching = simulation.casing.is_some();
        let mut oscillators = Oscillators::new(
            wheel,
            scheme,
            simulation.step_s(),
            simulation.damping,
            (touching, follow),
            simulation.initial,
        );
        let surroundings = Surroundings::new(simulation, &oscillators, &fourier);
        let obstacle = simulation
            .casing
            .map(|casing| Obstacle::new(simulation, casing, &oscillators, &fourier, surroundings.as_ref()));
        let bounds = simulation.casing.map(|_| Bounds::new(simulation, &oscillators));
        let loaded = obstacle.as_ref().map(|obstacle| obstacle.loads(surroundings.as_ref()).rows);
        let mut drive = Drive::new(
            wheel,
            simulation.contact_nodes.len(),
            &simulation.effects,
            &oscillators,
            &fourier,
            (simulation.step_s(), loaded),
        );
        if let Some(drive) = &mut drive {
            drive.start(wheel, simulation.initial, &mut oscillators, revolutions);
        }
        let effects = drive.is_some() || surroundings.is_some();
        let repetition = simulation.repeats.map(|repeats| Repetition::new(simulation, repeats, &oscillators));
        Self {
            repetition,
            follow,
            massless: matches!(scheme, Scheme::MasslessBoundary { .. }),
            decays: effects || oscillators.dissipates(),
            recorder: Recorder::new(
                simulation,
                &oscillators,
                &fourier,
                obstacle.as_ref().map(|obstacle| obstacle.tally.interval()).unwrap_or_default(),
            ),
            statistics: RunStatistics::default(),
            energy: EnergyAudit::starting_at(oscillators.energy()),
            last_energy: None,
            fourier,
            oscillators,
            drive,
            obstacle,
            surroundings,
            bounds,
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
        beginning: Beginning,
        watch: &dyn Fn(f64) -> bool,
    ) -> Run {
        let effects = self.is_affected();
        let begun = match beginning {
            Beginning::Free => Ok(()),
            Beginning::UnderWay if effects => self.take_up::<S, Affected>(simd),
            Beginning::UnderWay => self.take_up::<S, Massless>(simd),
        };
        let ended = match &self.obstacle {
            _ if begun.is_err() => begun,
            _ if effects => self.integrate::<S, Affected>(simd, simulation, watch),
            None => self.integrate::<S, Free>(simd, simulation, watch),
            Some(_) if self.massless => self.integrate::<S, Massless>(simd, simulation, watch),
            Some(_) => self.integrate::<S, Completing>(simd, simulation, watch),
        };
        let outcome = match ended {
            Ok(()) => Outcome::Completed(self.recorder.take()),
            Err(ended) => *ended,
        };
        self.statistics.casing_amplitude = self.flexible_casing().map(CasingMotion::largest_amplitude);
        let coating = self.surroundings.as_ref().and_then(Surroundings::coating).cloned();
        let contact = self.obstacle.as_ref().map(|obstacle| obstacle.tally.record().clone());
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

    /// Finds the forces that act when a run takes up a motion.
    #[inline(always)]
    fn take_up<S: Simd, M: Motion>(&mut self, simd: S) -> Result<(), Box<Outcome>> {
        let start = Instant::beginning(0);
        if self.touches_at::<S, M>(simd, start) {
            // Of the step before the first: nothing of it counts.
            let (statistics, energy) = (self.statistics, self.energy);
            self.solve::<S, M>(simd, start)?;
            (self.statistics, self.energy) = (statistics, energy);
            if let Some(obstacle) = &mut self.obstacle {
                obstacle.tally.sample(|_, _| 0.0, None);
            }
        }
        Ok(())
    }

    #[inline(always)]
    fn integrate<S: Simd, M: Motion>(
        &mut self,
        simd: S,
        simulation: &Simulation<'_>,
        watch: &dyn Fn(f64) -> bool,
    ) -> Result<(), Box<Outcome>> {
        let steps = simulation.steps_per_revolution;
        let sampling = steps / simulation.samples_per_revolution;
        if self.recorder.reads(0, false) {
            self.read(simd, false);
        }
        let mut end = simulation.revolutions;
        let mut window = end - simulation.window_revolutions..end;
        let mut revolution = 0;
        while revolution < end {
            let windowed = window.contains(&revolution);
            if windowed && let Some(obstacle) = &mut self.obstacle {
                obstacle.tally.begin_window();
            }
            for step in 1..=steps {
                let now = Instant::new(revolution, step, steps);
                M::predict(self, simd, now);
                let open = self.gaps::<S, M>(simd, now);
                if !open {
                    self.solve::<S, M>(simd, now)?;
                }
                self.statistics.steps += 1;
                self.quench::<M>();
                self.look_up(watch, now.revolutions / end as f64)?;
                if step % sampling == 0 {
                    M::apply(self, simd);
                    self.record::<S, M>(simd, now, windowed)?;
                } else if self.recorder.reads(self.statistics.steps, windowed) {
                    self.read(simd, windowed);
                }
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
                    self.read(simd, false);
                }
            }
        }
        self.end(simulation, end);
        Ok(())
    }

    /// Takes `steps` steps from the state the oscillators are in, the beginning of `revolution`, without recording anything but what
    /// touches. For scenes whose state is that of the oscillators.
    #[inline(always)]
    pub(super) fn flow<S: Simd>(
        &mut self,
        simd: S,
        (revolution, steps): (usize, usize),
        simulation: &Simulation<'_>,
        trace: &mut Trace,
    ) -> Result<(), Box<Outcome>> {
        match &self.obstacle {
            _ if self.is_affected() => {
                self.flow_by::<S, Affected>(simd, (revolution, steps), simulation, trace)
            }
            None => self.flow_by::<S, Free>(simd, (revolution, steps), simulation, trace),
            Some(_) if self.massless => {
                self.flow_by::<S, Massless>(simd, (revolution, steps), simulation, trace)
            }
            Some(_) => self.flow_by::<S, Completing>(simd, (revolution, steps), simulation, trace),
        }
    }

    #[inline(always)]
    fn flow_by<S: Simd, M: Motion>(
        &mut self,
        simd: S,
        (revolution, steps): (usize, usize),
        simulation: &Simulation<'_>,
        trace: &mut Trace,
    ) -> Result<(), Box<Outcome>> {
        let start = Instant::beginning(revolution);
        if self.touches_at::<S, M>(simd, start) {
            self.solve_tracing::<S, M>(simd, start, (0, trace))?;
        }
        for step in 1..=steps {
            let now = Instant::of_any(revolution, step, simulation.steps_per_revolution);
            M::predict(self, simd, now);
            if !self.gaps::<S, M>(simd, now) {
                self.solve_tracing::<S, M>(simd, now, (step, trace))?;
            }
        }
        M::apply(self, simd);
        let revolutions = revolution as f64 + steps as f64 / simulation.steps_per_revolution as f64;
        self.check_bounds(simd, self.oscillators.energy(), revolutions)
    }

    /// Whether forces act from `start` on: they belong to the state there, as those that complete a step do not.
    #[inline(always)]
    fn touches_at<S: Simd, M: Motion>(&mut self, simd: S, start: Instant) -> bool {
        let Self { oscillators, fourier, obstacle, surroundings, .. } = self;
        let surroundings = M::surroundings(surroundings);
        let open = obstacle
            .as_mut()
            .is_none_or(|obstacle| obstacle.look(simd, oscillators, fourier, (start, surroundings)));
        !open && self.massless
    }

    #[inline(always)]
    fn solve_tracing<S: Simd, M: Motion>(
        &mut self,
        simd: S,
        now: Instant,
        (step, trace): (usize, &mut Trace),
    ) -> Result<(), Box<Outcome>> {
        self.solve::<S, M>(simd, now)?;
        if let Some(obstacle) = &self.obstacle {
            obstacle.trace(step, M::surroundings(&mut self.surroundings), trace);
        }
        Ok(())
    }

    pub(super) fn oscillators(&self) -> &Oscillators {
        &self.oscillators
    }

    /// Whether there are effects.
    fn is_affected(&self) -> bool {
        self.drive.is_some() || self.surroundings.is_some()
    }

    /// −∂f/∂z of mistuning between the Fourier columns of every family that it couples.
    pub(super) fn mistuned(&self) -> Vec<Mat<f64>> {
        self.drive.as_ref().map(Drive::mistuned).unwrap_or_default()
    }

    /// Gives what drives the wheel its part in increments that are those of free motion, `revolutions` after the start.
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

    /// Has modes and casing where another motion left them.
    pub(super) fn go_on_from(&mut self, from: &Stepped) {
        self.oscillators.go_on_from(&from.modes);
        if let Some(casing) = self.flexible_casing_mut() {
            casing.go_on_from(&from.casing);
        }
        self.energy = EnergyAudit::starting_at(self.mechanical_energy());
    }

    /// Predicts the gaps (Eq. 9); whether all are open.
    #[inline(always)]
    fn gaps<S: Simd, M: Motion>(&mut self, simd: S, now: Instant) -> bool {
        match &mut self.obstacle {
            Some(obstacle) if M::TOUCHES => {
                let surroundings = M::surroundings(&mut self.surroundings);
                obstacle.predict_gaps(simd, &self.fourier, now, surroundings) >= 0.0
            }
            _ => true,
        }
    }

    /// Finds the forces that close the gaps (Eqs 9, 10).
    #[inline(always)]
    fn solve<S: Simd, M: Motion>(&mut self, simd: S, now: Instant) -> Result<(), Box<Outcome>> {
        let Self { fourier, oscillators, drive, obstacle: Some(obstacle), surroundings, .. } = self else {
            return Ok(());
        };
        let surroundings = M::surroundings(surroundings);
        let swing = drive.as_ref().map_or(oscillators.swung(), Drive::swung);
        let read = |rows: &Rows, out: &mut [f64]| oscillators.project_of(simd, swing, rows, out);
        let (statistics, work) = (&mut self.statistics, self.energy.effects_mut());
        obstacle
            .solve(fourier, now, (surroundings, read), statistics, work)
            .map_err(|error| Box::new(Outcome::ContactFailed { revolutions: now.revolutions, error }))
    }

    /// Now and then brings to rest what has decayed to nothing.
    #[inline(always)]
    fn quench<M: Motion>(&mut self) {
        if self.decays && self.statistics.steps.is_multiple_of(QUENCHED_STEPS) {
            self.oscillators.quench();
            let surroundings = M::surroundings(&mut self.surroundings);
            if let Some(casing) = surroundings.and_then(|surroundings| surroundings.casing.as_mut()) {
                casing.quench();
            }
        }
    }

    /// Now and then asks whether to go on, `done` being the share of work done.
    #[inline(always)]
    fn look_up(&self, watch: &dyn Fn(f64) -> bool, done: f64) -> Result<(), Box<Outcome>> {
        if self.statistics.steps.is_multiple_of(WATCHED_STEPS) && !watch(done) {
            return Err(Box::new(Outcome::Cancelled));
        }
        Ok(())
    }

    /// Holds the state against what contact and energy promise, records it, and ends the run where it left its bounds.
    #[inline(always)]
    fn record<S: Simd, M: Motion>(
        &mut self,
        simd: S,
        now: Instant,
        windowed: bool,
    ) -> Result<(), Box<Outcome>> {
        let Self { oscillators, fourier, obstacle, surroundings, statistics, recorder, .. } = self;
        if M::TOUCHES
            && let Some(obstacle) = obstacle
        {
            let left = obstacle.penetration(simd, oscillators, fourier, now, M::surroundings(surroundings));
            statistics.largest_penetration = statistics.largest_penetration.max(left);
            obstacle.end_interval(fourier, recorder.contact_interval(statistics.steps));
        }
        let energy = self.mechanical_energy();
        self.energy.check(energy);
        self.read(simd, windowed);
        let force = self.obstacle.as_ref().map(|obstacle| obstacle.force.as_slice());
        if windowed {
            self.recorder.look_at_tips(simd, &self.oscillators, &self.fourier, force);
        }
        self.recorder.keep_state(self.statistics.steps, &self.oscillators, &self.fourier, force);
        self.recorder.record(&self.fourier, self.statistics.steps, &self.energy);
        self.check_bounds(simd, energy, now.revolutions)
    }

    /// Reads the sensors after the last step.
    #[inline(always)]
    fn read<S: Simd>(&mut self, simd: S, windowed: bool) {
        let force = self.obstacle.as_ref().map(|obstacle| obstacle.force.as_slice());
        let when = (self.statistics.steps, windowed);
        self.recorder.read(simd, &self.oscillators, &self.fourier, force, when);
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

    /// Keeps the state at the end, as free motion would have it.
    fn end(&mut self, simulation: &Simulation<'_>, revolutions: usize) {
        let modes = self.modes_at_end(simulation, revolutions as f64);
        let casing = self.flexible_casing().map(CasingMotion::stepped).unwrap_or_default();
        let end = (modes, casing, self.statistics.steps);
        self.recorder.end(simulation.wheel, &self.oscillators, &self.fourier, end);
    }

    /// Whether the motion was found to repeat after `revolution`, if anybody wants to know.
    fn repeats(&mut self, revolution: usize) -> Option<Repeated> {
        let casing = self.surroundings.as_ref().and_then(|surroundings| surroundings.casing.as_ref());
        self.repetition.as_mut()?.look(revolution, &self.oscillators, casing)
    }

    fn mechanical_energy(&self) -> f64 {
        self.oscillators.energy() + self.flexible_casing().map_or(0.0, CasingMotion::energy)
    }

    pub(super) fn flexible_casing(&self) -> Option<&CasingMotion> {
        self.surroundings.as_ref()?.casing.as_ref()
    }

    pub(super) fn flexible_casing_mut(&mut self) -> Option<&mut CasingMotion> {
        self.surroundings.as_mut()?.casing.as_mut()
    }

    #[inline(always)]
    fn check_bounds<S: Simd>(&mut self, simd: S, energy: f64, revolutions: f64) -> Result<(), Box<Outcome>> {
        let force = self.obstacle.as_ref().map_or(&[][..], |obstacle| obstacle.force.as_slice());
        let tip = match &mut self.bounds {
            Some(bounds) => bounds.exceeded(simd, &self.oscillators, &self.fourier, energy, force),
            None => None,
        };
        if energy.is_finite() && tip.is_none() {
            return Ok(());
        }
        Err(Box::new(Outcome::Diverged(Divergence {
            revolutions,
            tip,
            energy_growth: self.last_energy.map(|last| energy / last),
        })))
    }
}

/// How contact forces move the wheel, and whether anything else does: decided before the loop, which is compiled for each.
trait Motion {
    /// Whether there is anything to touch.
    const TOUCHES: bool = true;
    /// Whether there are effects.
    const EFFECTS: bool = false;

    /// Takes the step that ends `now` (Eq. 8), up to the reading of the gaps, after the forces of the instant before were
    /// applied, or under them.
    fn predict<S: Simd>(stepper: &mut Stepper, simd: S, now: Instant);

    /// Applies the forces that complete the step (Eq. 10) at once, instead of with the next prediction.
    fn apply<S: Simd>(stepper: &mut Stepper, simd: S);

    /// What the loop asks for of the effects on contact.
    #[inline(always)]
    fn surroundings(of: &mut Option<Surroundings>) -> Option<&mut Surroundings> {
        if Self::EFFECTS { of.as_mut() } else { None }
    }
}

/// Nothing to touch.
struct Free;

impl Motion for Free {
    const TOUCHES: bool = false;

    #[inline(always)]
    fn predict<S: Simd>(stepper: &mut Stepper, simd: S, _: Instant) {
        stepper.energy.add(stepper.oscillators.advance(simd));
    }

    #[inline(always)]
    fn apply<S: Simd>(_: &mut Stepper, _: S) {}
}

/// The force that closes a gap completes the step.
struct Completing;

impl Motion for Completing {
    #[inline(always)]
    fn predict<S: Simd>(stepper: &mut Stepper, simd: S, _: Instant) {
        let Stepper { fourier, oscillators, obstacle: Some(obstacle), energy, .. } = stepper else { return };
        let (loads, reading) = obstacle.loads_and_reading(None);
        energy.add(oscillators.complete_and_predict(simd, loads, reading));
        obstacle.clear_forces(fourier);
    }

    #[inline(always)]
    fn apply<S: Simd>(stepper: &mut Stepper, simd: S) {
        let Stepper { fourier, oscillators, obstacle: Some(obstacle), energy, .. } = stepper else { return };
        let loads = obstacle.loads(None);
        energy.add(oscillators.complete(simd, loads));
        obstacle.clear_forces(fourier);
    }
}

/// The force that closes a gap acts from then on, through the next step.
struct Massless;

impl Motion for Massless {
    #[inline(always)]
    fn predict<S: Simd>(stepper: &mut Stepper, simd: S, _: Instant) {
        let Stepper { fourier, oscillators, obstacle: Some(obstacle), energy, .. } = stepper else { return };
        let (loads, reading) = obstacle.loads_and_reading(None);
        energy.add(oscillators.advance_loaded(simd, loads, reading));
        obstacle.clear_forces(fourier);
    }

    #[inline(always)]
    fn apply<S: Simd>(_: &mut Stepper, _: S) {}
}

/// Any of these under the effects of the scene, each asked for at every step.
struct Affected;

impl Motion for Affected {
    const EFFECTS: bool = true;

    #[inline(always)]
    fn predict<S: Simd>(stepper: &mut Stepper, simd: S, now: Instant) {
        let Stepper { fourier, oscillators, drive, obstacle, surroundings, energy, massless, .. } = stepper;
        let work = energy.effects_mut();
        let Some(obstacle) = obstacle else {
            let exchange = match drive {
                Some(drive) => oscillators.advance_driven(simd, drive, None, now.before, None, work),
                None => oscillators.advance(simd),
            };
            return energy.add(exchange);
        };
        let (loads, (rows, out)) = obstacle.loads_and_reading(surroundings.as_ref());
        let exchange = match drive {
            None if *massless => oscillators.advance_loaded(simd, loads, (rows, out)),
            None => oscillators.complete_and_predict(simd, loads, (rows, out)),
            Some(drive) if *massless => {
                let reading = Some((rows, out));
                oscillators.advance_driven(simd, drive, Some(loads), now.before, reading, work)
            }
            Some(drive) => {
                let ahead = (loads, now.before);
                oscillators.complete_and_predict_driven(simd, drive, ahead, (rows, out), work)
            }
        };
        energy.add(exchange);
        if let Some(casing) = surroundings.as_mut().and_then(|surroundings| surroundings.casing.as_mut()) {
            energy.add_casing(casing.complete());
            casing.predict();
        }
        obstacle.clear_forces(fourier);
    }

    #[inline(always)]
    fn apply<S: Simd>(stepper: &mut Stepper, simd: S) {
        let Stepper { fourier, oscillators, drive, obstacle, surroundings, energy, massless, .. } = stepper;
        let Some(obstacle) = obstacle.as_mut().filter(|_| !*massless) else { return };
        let loads = obstacle.loads(surroundings.as_ref());
        let exchange = match drive {
            Some(drive) => oscillators.complete_driven(simd, drive, loads, energy.effects_mut()),
            None => oscillators.complete(simd, loads),
        };
        energy.add(exchange);
        if let Some(casing) = surroundings.as_mut().and_then(|surroundings| surroundings.casing.as_mut()) {
            energy.add_casing(casing.complete());
        }
        obstacle.clear_forces(fourier);
    }
}

/// z and ż of every mode, its increment being that of free motion.
fn modal_state(simulation: &Simulation<'_>, oscillators: &Oscillators, follow: bool) -> Vec<InitialMode> {
    let step = simulation.step_s();
    oscillators.modal_state(|harmonic, family, z, d| {
        let omega = simulation.wheel.harmonics[harmonic].omega[family];
        let zeta = simulation.damping.map_or(0.0, |damping| damping.ratio(family));
        simulation.scheme.velocity(omega, zeta, step, z, d, follow)
    })
}
