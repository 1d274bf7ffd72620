//! Climb over settings: its resources, its outcome, and the wall time of speeds and reductions.

use crate::accuracy::candidate::Candidate;
use crate::accuracy::rung::{Pilots, Rung, finer_modes};
use crate::error::Violation;
use crate::request::SweepDirection;
use crate::resolved::{ResolvedSweep, TrialRequest};
use crate::result::{Choice, Pilot};

/// Next step of a choice.
#[derive(Debug, Clone, PartialEq)]
pub enum Next {
    /// Runs that are missing.
    Run(Vec<TrialRequest>),
    /// Choice, at the end of the climb.
    Take(Box<Choice>),
    /// Refusal: no setting meets the request.
    Refuse(Violation),
}

/// Resources of a choice.
#[derive(Debug, Clone, PartialEq)]
pub struct Resources {
    /// Threads that compute speeds side by side.
    pub workers: usize,
    /// Wall time since the job began, s.
    pub spent_s: f64,
    /// Stored reductions: `modes_per_speed` and wall time, s.
    pub reductions: Vec<(u32, f64)>,
    /// Most `modes_per_speed` that memory allows, if known.
    pub most_modes: Option<u32>,
}

/// Last rung of the steps, as a power of two times the first.
pub(super) const MOST_DOUBLINGS: u32 = 7;

/// Share of the remaining budget that runs are planned for.
pub(super) const PLANNED_SHARE: f64 = 0.9;

/// Largest ratio of computing times of a run with twice the modes.
pub(super) const MODES_DOUBLED: f64 = 2.0;

/// Climb over settings, with the pilot runs known so far.
pub(super) struct Climb<'a, 'b> {
    pub(super) request: &'b ResolvedSweep,
    pub(super) resources: &'b Resources,
    pub(super) pilots: Pilots<'a, 'b>,
}

impl Climb<'_, '_> {
    pub(super) fn finer(&self, modes: u32) -> Option<u32> {
        finer_modes(modes, self.resources.most_modes)
    }

    pub(super) fn choice(&self, taken: &Candidate, pilots: Vec<Pilot>, reason: String) -> Choice {
        let (_, accuracy, budget) = self.request.modes.fields();
        Choice {
            accuracy,
            budget,
            setting: taken.setting,
            estimated_error: taken.error(),
            error_of_modes: taken.error_of_modes,
            error_of_steps: taken.error_of_steps,
            difference: taken.difference,
            spread: taken.spread,
            estimated_at: taken.estimated as u32,
            expected_wall_time_s: self.sweep_wall(taken),
            spent_s: self.resources.spent_s,
            reason,
            pilot_speeds_rad_s: self.pilots.speeds.clone(),
            pilots,
        }
    }

    /// Wall time of `runs` that take `seconds` each.
    pub(super) fn wall(&self, runs: usize, seconds: f64) -> f64 {
        runs.div_ceil(self.resources.workers) as f64 * seconds
    }

    /// Wall time of all speeds and of the control runs with twice the modes and steps, with the reduction for these.
    pub(super) fn sweep_wall(&self, taken: &Candidate) -> f64 {
        let speeds = self.request.speeds.rad_s().len();
        let controls = self.request.control_speeds().min(speeds);
        let steps = taken.setting.steps_per_revolution;
        let run = taken.price.of_run(steps);
        let all = match self.request.sweep {
            SweepDirection::Independent => self.wall(speeds, run),
            // One after the other.
            SweepDirection::Up | SweepDirection::Down => speeds as f64 * run,
        };
        let finer = self.finer(taken.setting.modes_per_speed).filter(|_| controls > 0);
        let reduction = finer.map_or(0.0, |finer| self.reduction_s(finer));
        all + self.wall(controls, MODES_DOUBLED * taken.controls.of_run(2 * steps)) + reduction
    }

    /// Expected wall time of the reduction with `modes`, s: 0 if it is stored, otherwise scaled from the largest stored one.
    pub(super) fn reduction_s(&self, modes: u32) -> f64 {
        let stored = &self.resources.reductions;
        if stored.iter().any(|&(k, _)| k == modes) {
            return 0.0;
        }
        let largest = stored.iter().max_by_key(|(k, _)| *k);
        largest.map_or(0.0, |&(k, seconds)| seconds * (f64::from(modes) / f64::from(k)).max(1.0))
    }

    pub(super) fn nothing_finer(&self, modes: u32, last: Option<&Rung>) -> String {
        let end =
            format!("{modes} modes per speed are the most that there is something finer to compare with");
        match last {
            Some(rung) => self.limit(&rung.itself(), &end),
            None => format!("{end}: give the knobs yourself, or the service more memory"),
        }
    }

    pub(super) fn limit(&self, last: &Candidate, end: &str) -> String {
        let number =
            |error: f64| if error.is_finite() { format!("{error:.1e}") } else { "unknown".to_owned() };
        format!(
            "{end}: with {} modes and {} steps the estimated error is {} from the modes and {} from the steps; ask for a larger \
             target, or give the knobs yourself",
            last.setting.modes_per_speed,
            last.setting.steps_per_revolution,
            number(last.error_of_modes),
            number(last.error_of_steps)
        )
    }
}

/// Pilot runs of all rungs, in the order in which they were tried.
pub(super) fn pilots(tried: &[Rung]) -> Vec<Pilot> {
    tried.iter().flat_map(|rung| rung.pilots.clone()).collect()
}
