//! Time integration with contact (Eqs 8–10): inputs and results of a run. The loop is in `stepper`.

mod bounds;
mod carried;
mod contact;
mod decimation;
mod detail;
#[cfg(test)]
mod digests;
mod disc;
mod excursion;
mod gap_shift;
mod gaps;
mod instant;
mod law;
mod passage;
mod passage_error;
mod recorder;
mod recurrence;
mod repetition;
mod residual;
mod revolutions;
mod run;
mod second_order;
mod simulation;
mod states;
mod step_flexibility;
mod step_range;
mod stepper;
mod stretch;
mod tally;
mod tips;
mod trace;
mod unknowns;

pub use self::bounds::{TipComponent, TipDisplacement};
pub use self::detail::DetailHistory;
pub use self::excursion::Excursion;
pub use self::passage::Passage;
pub use self::passage_error::PassageError;
pub use self::recurrence::{comes_round, revolutions_over_lobe};
pub use self::repetition::LEAST_MARCHED;
pub use self::revolutions::{Repeated, Repeats, Revolutions};
pub use self::run::{Divergence, History, MAX_TABLE_VALUES, Outcome, Run};
pub use self::simulation::{DIVERGED_SHARE_OF_RADIUS, Detail, SensorRow, Simulation};
pub use self::states::ModalStates;
use self::stepper::{Beginning, Stepper};
pub use self::stretch::{Part, Stretch};
pub use self::tally::{ContactRecord, PairContact};
pub use self::tips::TipMotion;
pub use self::trace::{Touching, Trace};
pub use self::unknowns::{CasingUnknown, Unknown};
#[cfg(test)]
use super::casing::RestrictionTable;
use super::initial::Stepped;

impl Simulation<'_> {
    /// Runs the simulation. `watch` is called once all is set up, with 0, and now and then with the share of work done; `false`
    /// stops the run.
    ///
    /// # Panics
    /// If the sample count does not divide the step count, the window or the revolutions of [`Self::detail`] or [`Self::states`]
    /// exceed the run, or an initial mode is not integrated.
    pub fn run(&self, watch: &dyn Fn(f64) -> bool) -> Run {
        self.run_by(Stepper::new(self), Beginning::Free, watch)
    }

    /// Runs the simulation from a state that another motion has reached, instead of [`Self::initial`]: forces that act at its instant are
    /// part of it.
    ///
    /// # Panics
    /// As [`Self::run`].
    pub fn go_on(&self, from: &Stepped, watch: &dyn Fn(f64) -> bool) -> Run {
        let mut stepper = Stepper::new(self);
        stepper.go_on_from(from);
        self.run_by(stepper, Beginning::UnderWay, watch)
    }

    /// Runs part of a run from [`Self::initial`], the state where the part begins, with neither window nor detail. Forces that act at that
    /// instant are part of it where the scheme has them: of a boundary without mass.
    ///
    /// # Panics
    /// If the sample count does not divide the step count, or an initial mode is not integrated.
    pub fn stretch(&self, part: Part, watch: &dyn Fn(f64) -> bool) -> Stretch {
        assert!(self.steps_per_revolution.is_multiple_of(self.samples_per_revolution));
        let revolutions = part.first_sample as f64 / self.samples_per_revolution as f64;
        Stepper::beginning_at(self, revolutions, self.fast_modes_follow()).stretch(self, part, watch)
    }

    /// Runs on vectors of a given kind.
    #[cfg(test)]
    fn run_on(&self, arch: pulp::Arch, watch: &dyn Fn(f64) -> bool) -> Run {
        self.run_by(Stepper::new(self).on(arch), Beginning::Free, watch)
    }

    /// Runs against a restriction of any shape instead of the casing's lobes.
    #[cfg(test)]
    pub(super) fn run_against(&self, restriction: RestrictionTable, watch: &dyn Fn(f64) -> bool) -> Run {
        let mut stepper = Stepper::new(self);
        stepper.replace_restriction(restriction);
        self.run_by(stepper, Beginning::Free, watch)
    }

    fn run_by(&self, mut stepper: Stepper, beginning: Beginning, watch: &dyn Fn(f64) -> bool) -> Run {
        assert!(self.steps_per_revolution.is_multiple_of(self.samples_per_revolution));
        assert!(self.window_revolutions <= self.revolutions);
        let recorded = self.detail.map(|detail| detail.revolutions).into_iter().chain(self.states);
        recorded.for_each(|recorded| {
            let (from, to) = recorded.of(self.revolutions, None);
            assert!(from < to && to <= self.revolutions);
        });
        // A refusal is heard again after the first steps.
        watch(0.0);
        stepper.run(self, beginning, watch)
    }
}
