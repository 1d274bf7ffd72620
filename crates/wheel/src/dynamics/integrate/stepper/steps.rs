//! The step loop.
//!
//! One loop per [`Motion`], compiled for each kind of vectors. The loops of scenes without effects contain neither drive nor casing motion;
//! the shift of the gaps and the law of contact are options that [`super::Contact`] tests. What is rare in a step, or no part of its
//! arithmetic, is called from [`super::kernels`].

use pulp::{Simd, WithSimd};

use super::super::instant::Instant;
use super::super::run::Outcome;
use super::super::step_range::{Observer, StepRange};
use super::Stepper;

/// Steps between two looks for motion that has decayed to nothing.
const QUENCHED_STEPS: u64 = 16;

impl Stepper {
    /// Takes steps, the forces of the last of which are applied.
    pub(super) fn take(&mut self, range: StepRange, observer: Observer<'_>) -> Result<(), Box<Outcome>> {
        self.arch.dispatch(Take { stepper: self, range, observer })
    }

    /// Chooses the loop of the scene and its scheme.
    #[inline(always)]
    fn take_on<S: Simd>(
        &mut self,
        simd: S,
        range: StepRange,
        observer: Observer<'_>,
    ) -> Result<(), Box<Outcome>> {
        match &self.contact {
            _ if self.is_affected() => self.take_by::<S, Affected>(simd, range, observer),
            None => self.take_by::<S, Free>(simd, range, observer),
            Some(_) if self.massless => self.take_by::<S, Massless>(simd, range, observer),
            Some(_) => self.take_by::<S, Completing>(simd, range, observer),
        }
    }

    #[inline(always)]
    fn take_by<S: Simd, M: Motion>(
        &mut self,
        simd: S,
        range: StepRange,
        mut observer: Observer<'_>,
    ) -> Result<(), Box<Outcome>> {
        let (mut revolution, mut place) = (range.revolution, range.before);
        for step in 1..=range.steps {
            if place == range.per_revolution {
                (revolution, place) = (revolution + 1, 0);
            }
            place += 1;
            let now = Instant::new(revolution, place, range.per_revolution);
            M::predict(self, simd, now);
            let open = self.gaps::<S, M>(simd, now);
            if !open {
                self.solve(now)?;
            }
            match &mut observer {
                Observer::Trace(trace) if !open => self.trace(step, trace),
                Observer::Trace(_) => {}
                Observer::Recorder { windowed } => {
                    self.statistics.steps += 1;
                    self.quench();
                    // What the last one leads to is recorded with its forces.
                    if step < range.steps && self.recorder.reads(self.statistics.steps, *windowed) {
                        self.read(*windowed);
                    }
                }
            }
        }
        M::apply(self, simd);
        Ok(())
    }

    /// Predicts the gaps (Eq. 9); whether all are open.
    #[inline(always)]
    fn gaps<S: Simd, M: Motion>(&mut self, simd: S, now: Instant) -> bool {
        match &mut self.contact {
            Some(contact) if M::TOUCHES => contact.gaps.predict(simd, &self.fourier, now) >= 0.0,
            _ => true,
        }
    }

    /// Now and then brings to rest what has decayed to nothing.
    #[inline(always)]
    fn quench(&mut self) {
        if self.decays && self.statistics.steps.is_multiple_of(QUENCHED_STEPS) {
            self.oscillators.quench();
            if let Some(casing) = self.flexible_casing_mut() {
                casing.quench();
            }
        }
    }
}

/// The loop as a value, so that the whole of it is compiled for the widest vectors of the machine.
struct Take<'a, 'b> {
    stepper: &'a mut Stepper,
    range: StepRange,
    observer: Observer<'b>,
}

impl WithSimd for Take<'_, '_> {
    type Output = Result<(), Box<Outcome>>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Self::Output {
        self.stepper.take_on(simd, self.range, self.observer)
    }
}

/// Kind of step: the way in which contact forces move the wheel, and whether effects act. Chosen before the loop, which is compiled for each.
trait Motion {
    /// Whether there is anything to touch.
    const TOUCHES: bool = true;

    /// Takes the step that ends `now` (Eq. 8), up to the reading of the gaps, after the forces of the instant before were
    /// applied, or under them.
    fn predict<S: Simd>(stepper: &mut Stepper, simd: S, now: Instant);

    /// Applies the forces that complete the step (Eq. 10) at once, instead of with the next prediction.
    fn apply<S: Simd>(stepper: &mut Stepper, simd: S);
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
        let Stepper { fourier, oscillators, contact: Some(contact), energy, .. } = stepper else { return };
        let (loads, reading) = contact.loads_and_reading();
        energy.add(oscillators.complete_and_predict(simd, loads, reading));
        contact.clear_forces(fourier);
    }

    #[inline(always)]
    fn apply<S: Simd>(stepper: &mut Stepper, simd: S) {
        let Stepper { fourier, oscillators, contact: Some(contact), energy, .. } = stepper else { return };
        let loads = contact.loads();
        energy.add(oscillators.complete(simd, loads));
        contact.clear_forces(fourier);
    }
}

/// The force that closes a gap acts from then on, through the next step.
struct Massless;

impl Motion for Massless {
    #[inline(always)]
    fn predict<S: Simd>(stepper: &mut Stepper, simd: S, _: Instant) {
        let Stepper { fourier, oscillators, contact: Some(contact), energy, .. } = stepper else { return };
        let (loads, reading) = contact.loads_and_reading();
        energy.add(oscillators.advance_loaded(simd, loads, reading));
        contact.clear_forces(fourier);
    }

    #[inline(always)]
    fn apply<S: Simd>(_: &mut Stepper, _: S) {}
}

/// Step with effects of the scene, each tested at every step.
struct Affected;

impl Motion for Affected {
    #[inline(always)]
    fn predict<S: Simd>(stepper: &mut Stepper, simd: S, now: Instant) {
        let Stepper { fourier, oscillators, drive, contact, energy, massless, .. } = stepper;
        let work = energy.effects_mut();
        let Some(contact) = contact else {
            let exchange = match drive {
                Some(drive) => oscillators.advance_driven(simd, drive, None, now.before, None, work),
                None => oscillators.advance(simd),
            };
            return energy.add(exchange);
        };
        let (loads, reading) = contact.loads_and_reading();
        let exchange = match drive {
            None if *massless => oscillators.advance_loaded(simd, loads, reading),
            None => oscillators.complete_and_predict(simd, loads, reading),
            Some(drive) if *massless => {
                oscillators.advance_driven(simd, drive, Some(loads), now.before, Some(reading), work)
            }
            Some(drive) => {
                oscillators.complete_and_predict_driven(simd, drive, loads, now.before, reading, work)
            }
        };
        energy.add(exchange);
        if let Some(casing) = contact.casing_mut() {
            energy.add_casing(casing.complete());
            casing.predict();
        }
        contact.clear_forces(fourier);
    }

    #[inline(always)]
    fn apply<S: Simd>(stepper: &mut Stepper, simd: S) {
        let Stepper { fourier, oscillators, drive, contact, energy, massless, .. } = stepper;
        let Some(contact) = contact.as_mut().filter(|_| !*massless) else { return };
        let loads = contact.loads();
        let exchange = match drive {
            Some(drive) => oscillators.complete_driven(simd, drive, loads, energy.effects_mut()),
            None => oscillators.complete(simd, loads),
        };
        energy.add(exchange);
        if let Some(casing) = contact.casing_mut() {
            energy.add_casing(casing.complete());
        }
        contact.clear_forces(fourier);
    }
}
