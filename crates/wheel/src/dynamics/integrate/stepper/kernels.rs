//! Kernels called from steps or between them, compiled once for each kind of vectors and not again in each loop.

use pulp::{Simd, WithSimd};

use super::super::super::oscillators::driven::Drive;
use super::super::super::oscillators::rows::Rows;
use super::super::instant::Instant;
use super::super::run::{Divergence, Outcome};
use super::Stepper;

impl Stepper {
    /// Finds the forces that close the gaps (Eqs 9, 10).
    #[inline(never)]
    pub(super) fn solve(&mut self, now: Instant) -> Result<(), Box<Outcome>> {
        self.arch.dispatch(Solve { stepper: self, now })
    }

    /// Whether forces act from `start` on: they belong to the state there, as those that complete a step do not.
    pub(super) fn touches_at(&mut self, start: Instant) -> bool {
        let open = self.arch.dispatch(Look { stepper: self, now: start });
        !open && self.massless
    }

    /// Reads the sensors after the last step.
    #[inline(never)]
    pub(super) fn read(&mut self, windowed: bool) {
        self.arch.dispatch(Read { stepper: self, windowed });
    }

    /// Holds the state against what contact and energy promise, records it, and ends the run where it left its bounds.
    pub(super) fn record(&mut self, now: Instant, windowed: bool) -> Result<(), Box<Outcome>> {
        self.arch.dispatch(Record { stepper: self, now, windowed })
    }

    /// Ends the run where tips or energy have left their bounds.
    pub(super) fn check_bounds(&mut self, energy: f64, revolutions: f64) -> Result<(), Box<Outcome>> {
        self.arch.dispatch(CheckBounds { stepper: self, energy, revolutions })
    }

    #[inline(always)]
    fn read_on<S: Simd>(&mut self, simd: S, windowed: bool) {
        let force = self.contact.as_ref().map(|contact| contact.force.as_slice());
        let step = self.statistics.steps;
        self.recorder.read(simd, &self.oscillators, &self.fourier, force, step, windowed);
    }

    #[inline(always)]
    fn check_bounds_on<S: Simd>(
        &mut self,
        simd: S,
        energy: f64,
        revolutions: f64,
    ) -> Result<(), Box<Outcome>> {
        let force = self.contact.as_ref().map_or(&[][..], |contact| contact.force.as_slice());
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

struct Solve<'a> {
    stepper: &'a mut Stepper,
    now: Instant,
}

impl WithSimd for Solve<'_> {
    type Output = Result<(), Box<Outcome>>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Self::Output {
        let Self { stepper, now } = self;
        let Stepper { fourier, oscillators, drive, contact: Some(contact), .. } = stepper else {
            return Ok(());
        };
        let swing = drive.as_ref().map_or(oscillators.swung(), Drive::swung);
        let read = |rows: &Rows, out: &mut [f64]| oscillators.project_of(simd, swing, rows, out);
        let (statistics, work) = (&mut stepper.statistics, stepper.energy.effects_mut());
        contact
            .solve(fourier, now, read, statistics, work)
            .map_err(|error| Box::new(Outcome::ContactFailed { revolutions: now.revolutions, error }))
    }
}

struct Look<'a> {
    stepper: &'a mut Stepper,
    now: Instant,
}

impl WithSimd for Look<'_> {
    type Output = bool;

    /// Whether all gaps are open.
    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> bool {
        let Stepper { oscillators, fourier, contact, .. } = self.stepper;
        contact.as_mut().is_none_or(|contact| contact.look(simd, oscillators, fourier, self.now))
    }
}

struct Read<'a> {
    stepper: &'a mut Stepper,
    windowed: bool,
}

impl WithSimd for Read<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        self.stepper.read_on(simd, self.windowed);
    }
}

struct Record<'a> {
    stepper: &'a mut Stepper,
    now: Instant,
    windowed: bool,
}

impl WithSimd for Record<'_> {
    type Output = Result<(), Box<Outcome>>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Self::Output {
        let Self { stepper, now, windowed } = self;
        let Stepper { oscillators, fourier, contact, statistics, recorder, .. } = stepper;
        if let Some(contact) = contact {
            let left = contact.penetration(simd, oscillators, fourier, now);
            statistics.largest_penetration = statistics.largest_penetration.max(left);
            contact.end_interval(fourier, recorder.contact_interval(statistics.steps));
        }
        let energy = stepper.mechanical_energy();
        stepper.energy.check(energy);
        let Stepper { drive, oscillators, .. } = &mut *stepper;
        let stored = drive.as_mut().and_then(|drive| drive.stiffening_energy(simd, oscillators));
        if let Some(stored) = stored {
            stepper.energy.check_stiffening(stored);
        }
        stepper.read_on(simd, windowed);
        let Stepper { oscillators, fourier, contact, statistics, recorder, .. } = stepper;
        let force = contact.as_ref().map(|contact| contact.force.as_slice());
        if windowed {
            recorder.look_at_tips(simd, oscillators, fourier, force);
        }
        recorder.keep_state(statistics.steps, oscillators, fourier, force);
        recorder.record(fourier, statistics.steps, &stepper.energy);
        stepper.check_bounds_on(simd, energy, now.revolutions)
    }
}

struct CheckBounds<'a> {
    stepper: &'a mut Stepper,
    energy: f64,
    revolutions: f64,
}

impl WithSimd for CheckBounds<'_> {
    type Output = Result<(), Box<Outcome>>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Self::Output {
        self.stepper.check_bounds_on(simd, self.energy, self.revolutions)
    }
}
