//! Candidate settings, with their estimated error and price.

use crate::request::{AutoOr, SchemeChoice, Setting};

/// Computing time of a run with any number of steps per revolution, the mean of the pilot speeds. Much of the contact's share does not grow
/// with the steps.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Price {
    fixed_s: f64,
    step_s: f64,
}

impl Price {
    /// Price of a run that takes `seconds` with `steps`, and `doubled_s` with twice as many.
    pub(super) fn of(steps: u32, seconds: f64, doubled_s: f64) -> Self {
        // No time falls with the steps or grows faster than they do; what seems to was measured badly.
        let grown = (doubled_s - seconds).clamp(0.0, seconds);
        Self { fixed_s: seconds - grown, step_s: grown / f64::from(steps) }
    }

    /// Computing time of a run with `steps` per revolution, s.
    pub(super) fn of_run(self, steps: u32) -> f64 {
        self.fixed_s + self.step_s * f64::from(steps)
    }

    /// Price scaled to runs that take `seconds` with `steps`.
    pub(super) fn through(self, steps: u32, seconds: f64) -> Self {
        let factor = seconds / self.of_run(steps).max(f64::MIN_POSITIVE);
        Self { fixed_s: factor * self.fixed_s, step_s: factor * self.step_s }
    }
}

/// Candidate setting with its estimated error and price.
#[derive(Debug, Clone)]
pub(super) struct Candidate {
    pub(super) setting: Setting,
    /// Error that more modes and more steps would remove; for a setting compared with another one, the error of that one.
    pub(super) error_of_modes: f64,
    pub(super) error_of_steps: f64,
    /// Steps per revolution of which `error_of_steps` is the error; for a setting compared with another one, the steps of that one.
    pub(super) error_at_steps: u32,
    /// Error that the difference from the setting it was compared with adds.
    pub(super) difference: f64,
    /// Standard error of levels that do not repeat.
    pub(super) spread: f64,
    /// Number of pilot speeds with an estimate.
    pub(super) estimated: usize,
    pub(super) price: Price,
    /// Price of a run with the same modes by the scheme of the control runs.
    pub(super) controls: Price,
}

impl Candidate {
    /// Error that another setting would remove: all but the spread.
    pub(super) fn error_of_setting(&self) -> f64 {
        self.error_of_modes + self.error_of_steps + self.difference
    }

    pub(super) fn error(&self) -> f64 {
        self.error_of_setting() + self.spread
    }

    /// Candidate with more steps: the error of the steps falls with the first order, to be safe, above the steps it was measured with.
    pub(super) fn with_steps(&self, steps: u32) -> Self {
        let gain = (f64::from(self.error_at_steps) / f64::from(steps)).min(1.0);
        Self {
            setting: Setting { steps_per_revolution: steps, ..self.setting },
            error_of_steps: gain * self.error_of_steps,
            ..self.clone()
        }
    }
}

/// Setting of a scheme that integrates as many modes as its step carries.
pub(super) fn setting(modes_per_speed: u32, scheme: SchemeChoice, steps_per_revolution: u32) -> Setting {
    Setting { modes_per_speed, scheme, kept_modes: AutoOr::Auto, steps_per_revolution }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Candidate with 1,000 steps that was compared with a run of 2,000.
    #[test]
    fn the_error_of_steps_falls_beyond_those_it_was_measured_with() {
        let candidate = Candidate {
            setting: setting(20, SchemeChoice::ExactModal, 1000),
            error_of_modes: 0.01,
            error_of_steps: 0.02,
            error_at_steps: 2000,
            difference: 0.005,
            spread: 0.0,
            estimated: 4,
            price: Price::default(),
            controls: Price::default(),
        };
        for (steps, expected) in [(1000, 0.02), (1500, 0.02), (2000, 0.02), (4000, 0.01)] {
            assert_eq!(candidate.with_steps(steps).error_of_steps, expected, "{steps}");
        }
    }
}
