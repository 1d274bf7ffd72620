//! Runs of a convergence study: the settings of its grid at every speed, and the reference.

use crate::request::{AutoOr, SchemeChoice, Setting};
use crate::resolve::limits;
use crate::resolved::{ResolvedStudy, TrialRequest};

/// Refinement of the reference beyond the finest of a grid: factor of its steps and, where the grid has a single size, of its modes.
pub(crate) const FINER: u32 = 2;

impl ResolvedStudy {
    /// Settings of the grid, sizes first, on a wheel of `sectors`. Equal steps after alignment are taken once.
    pub(crate) fn settings(&self, sectors: u32) -> Vec<Setting> {
        let mut steps: Vec<u32> = self
            .grid
            .steps_per_revolution
            .iter()
            .map(|&s| Setting::aligned_steps(s, &self.sweep, sectors))
            .collect();
        steps.sort_unstable();
        steps.dedup();
        let mut settings = Vec::new();
        for &modes_per_speed in &self.grid.modes_per_speed {
            for &scheme in &self.grid.schemes {
                let kept: &[AutoOr] = match scheme {
                    SchemeChoice::MasslessBoundary => &self.grid.kept_modes,
                    _ => &[AutoOr::Auto],
                };
                for &kept_modes in kept {
                    let setting = |&steps_per_revolution| Setting {
                        modes_per_speed,
                        scheme,
                        kept_modes,
                        steps_per_revolution,
                    };
                    settings.extend(steps.iter().map(setting));
                }
            }
        }
        settings
    }

    /// Reference setting, one level finer than the finest of the grid: by the exact propagator with mass, which all schemes tend to as
    /// modes are added.
    pub(crate) fn reference(&self, sectors: u32) -> Setting {
        let mut modes = self.grid.modes_per_speed.clone();
        modes.sort_unstable();
        let largest = modes.last().copied().unwrap_or(1);
        let finer = match modes.iter().rev().find(|&&k| k < largest) {
            // The grid's own last ratio once more.
            Some(&next) => (u64::from(largest) * u64::from(largest)).div_ceil(next.into()) as u32,
            None => FINER * largest,
        };
        let steps = self.grid.steps_per_revolution.iter().copied().max().unwrap_or(1);
        Setting {
            modes_per_speed: finer.min(limits::MODES_PER_SPEED),
            scheme: SchemeChoice::ExactModal,
            kept_modes: AutoOr::Auto,
            steps_per_revolution: FINER * Setting::aligned_steps(steps, &self.sweep, sectors),
        }
    }

    /// Trials at `speed_rad_s`: the reference, which has the twin, and the grid.
    pub(crate) fn trials(&self, speed_rad_s: f64, sectors: u32) -> (TrialRequest, Vec<TrialRequest>) {
        let trial = |setting, twin| TrialRequest {
            history_revolutions: self.history_revolutions,
            twin,
            ..TrialRequest::new(&self.sweep, speed_rad_s, setting).with_stress_of(&self.sweep)
        };
        let reference = trial(self.reference(sectors), true);
        (reference, self.settings(sectors).into_iter().map(|setting| trial(setting, false)).collect())
    }

    /// Trials of a resolved study on a wheel of `sectors`, those of few modes first.
    pub fn all_trials(&self, sectors: u32) -> Vec<TrialRequest> {
        let mut trials = Vec::new();
        for &speed in self.speeds().rad_s() {
            let (reference, grid) = self.trials(speed, sectors);
            trials.extend(grid);
            trials.push(reference);
        }
        trials.sort_by_key(|trial| trial.sweep.modes_per_speed());
        trials
    }
}
