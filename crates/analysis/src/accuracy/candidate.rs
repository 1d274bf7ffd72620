//! A setting that could be taken, with its estimated error and what it would cost.

use crate::request::{AutoOr, SchemeChoice, Setting};

/// Computing time of a run at any number of steps, the mean of the pilot speeds.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Price {
    /// Before the first step, s.
    pub(super) set_up_s: f64,
    /// One step of each of its revolutions, s.
    pub(super) step_s: f64,
}

impl Price {
    /// Of a run with so many steps per revolution, s.
    pub(super) fn of_run(self, steps: u32) -> f64 {
        self.set_up_s + self.step_s * f64::from(steps)
    }

    /// With one of `count` prices added to their mean.
    pub(super) fn plus(self, one: Self, count: usize) -> Self {
        let share = 1.0 / count as f64;
        Self { set_up_s: self.set_up_s + share * one.set_up_s, step_s: self.step_s + share * one.step_s }
    }

    /// Between this one and another.
    pub(super) fn mean(self, other: Self) -> Self {
        Self { set_up_s: 0.5 * (self.set_up_s + other.set_up_s), step_s: 0.5 * (self.step_s + other.step_s) }
    }
}

/// A setting that could be taken.
#[derive(Debug, Clone)]
pub(super) struct Candidate {
    pub(super) setting: Setting,
    /// What more modes and more steps would remove; of a setting held against another one, of that.
    pub(super) error_of_modes: f64,
    pub(super) error_of_steps: f64,
    /// What the difference from the setting that it was held against adds.
    pub(super) difference: f64,
    /// Standard error of levels that do not repeat.
    pub(super) spread: f64,
    /// Pilot speeds that carry the estimate.
    pub(super) estimated: usize,
    pub(super) price: Price,
    /// Of a run with its modes by the scheme of the control runs.
    pub(super) controls: Price,
}

impl Candidate {
    /// What another setting would remove.
    pub(super) fn error_of_setting(&self) -> f64 {
        self.error_of_modes + self.error_of_steps + self.difference
    }

    pub(super) fn error(&self) -> f64 {
        self.error_of_setting() + self.spread
    }

    /// With more steps: their error falls with the first order, to be safe.
    pub(super) fn with_steps(&self, steps: u32) -> Self {
        let gain = f64::from(self.setting.steps_per_revolution) / f64::from(steps);
        Self {
            setting: Setting { steps_per_revolution: steps, ..self.setting },
            error_of_steps: gain * self.error_of_steps,
            ..self.clone()
        }
    }
}

/// A setting of a scheme that integrates as many modes as its step carries.
pub(super) fn setting(modes_per_speed: u32, scheme: SchemeChoice, steps_per_revolution: u32) -> Setting {
    Setting { modes_per_speed, scheme, kept_modes: AutoOr::Auto, steps_per_revolution }
}
