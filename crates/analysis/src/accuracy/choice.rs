//! Which setting meets a target at the least cost, or is the most accurate that a budget pays for.
//!
//! Pilot runs at a few speeds of the scene climb two ladders that double: modes per speed and steps per revolution. At a setting
//! (k, S) the error of the modes is estimated from the difference to (2k, S), that of the steps from the difference to (k, 2S),
//! and whichever is larger is refined. Time is stepped by the exact propagator with mass, which converges to the finite-element
//! model as both are refined; a boundary without mass is cheaper at a few per cent (docs/accuracy.md), but has a limit of its own.
//!
//! [`next`] is a pure function of the runs known so far: it names the runs it misses, and ends with a choice or a refusal.

use crate::accuracy::rung::{Pilots, Rung, finer_modes, pilot_speeds};
use crate::error::Violation;
use crate::request::auto_or::MOST_STEPS;
use crate::request::{AccuracyOf, SweepDirection};
use crate::resolved::{Aim, Modes, ResolvedSweep, TrialRequest};
use crate::result::{Choice, Trial};

/// What comes next.
#[derive(Debug, Clone, PartialEq)]
pub enum Next {
    /// These runs are missing.
    Run(Vec<TrialRequest>),
    /// The choice.
    Take(Box<Choice>),
    /// It cannot be had.
    Refuse(Violation),
}

/// What a choice may use.
#[derive(Debug, Clone, PartialEq)]
pub struct Resources {
    /// Threads that compute speeds side by side.
    pub workers: usize,
    /// Wall time since the job began, s.
    pub spent_s: f64,
    /// `modes_per_speed` and wall time of the reductions that are stored, s.
    pub reductions: Vec<(u32, f64)>,
    /// Most `modes_per_speed` that memory allows, if that is known.
    pub most_modes: Option<u32>,
}

/// Last rung of the steps, as a power of two times the first.
const MOST_DOUBLINGS: u32 = 7;

/// Share of what is left of a budget that runs are planned for.
pub(super) const PLANNED_SHARE: f64 = 0.9;

/// Share of what is left of a budget that the next rung's pilot runs and reduction may take.
const PILOT_SHARE: f64 = 0.4;

/// Chooses for a resolved sweep of a wheel of `sectors`; `trial` looks up a run that is known.
pub fn next<'a>(
    request: &ResolvedSweep,
    sectors: u32,
    resources: &Resources,
    trial: &dyn Fn(&TrialRequest) -> Option<&'a Trial>,
) -> Next {
    let most_modes = resources.most_modes;
    let pilots = Pilots { request, sectors, most_modes, speeds: pilot_speeds(request), trial };
    let climb = Climb { request, resources, pilots };
    match request.modes {
        Modes::Sought(Aim::Accuracy(accuracy)) => climb.to_target(accuracy.target),
        Modes::Sought(Aim::Budget(budget)) => climb.within(budget.seconds),
        Modes::Given(_) => Next::Refuse(Violation::new("/accuracy", "there is no target and no budget")),
    }
}

/// A climb over settings.
struct Climb<'a, 'b> {
    request: &'b ResolvedSweep,
    resources: &'b Resources,
    pilots: Pilots<'a, 'b>,
}

impl Climb<'_, '_> {
    fn finer(&self, modes: u32) -> Option<u32> {
        finer_modes(modes, self.resources.most_modes)
    }

    /// The first setting on the way up that meets `target`.
    fn to_target(&self, target: f64) -> Next {
        let refuse = |message: String| Next::Refuse(Violation::new("/accuracy/target", message));
        let (mut modes, first) = (self.pilots.first_modes(), self.pilots.first_steps());
        let (mut steps, most_steps) = (first, u64::from(first) << MOST_DOUBLINGS);
        let mut tried: Vec<Rung> = Vec::new();
        loop {
            let Some(finer) = self.finer(modes) else {
                return refuse(self.nothing_finer(modes, tried.last()));
            };
            let below = tried.iter().rev().find(|rung| rung.modes < modes);
            let rung = match self.pilots.rung((modes, finer, steps), below) {
                Ok(rung) => rung,
                Err(missing) => return Next::Run(missing),
            };
            if let Some(message) = self.pilots.nothing_completed(&rung) {
                return refuse(message);
            }
            // Chaos leaves the level to chance. What beats has a level; a window that is no multiple of the beat shows it higher
            // or lower, whatever the setting.
            let mut beats = None;
            if rung.spread > target {
                match self.pilots.sensitivity(&rung) {
                    Ok(found) if found.chaotic => return refuse(self.too_rough(&rung, target, &found.words)),
                    Ok(found) => beats = Some(self.known_to(&rung, &found.words)),
                    Err(missing) => return Next::Run(vec![*missing]),
                }
            }
            tried.push(rung.clone());
            let counted = if beats.is_some() { 0.0 } else { rung.spread };
            if rung.error_of_setting() + counted <= target {
                let (estimated, all) = (rung.estimated(), self.pilots.speeds.len());
                let others = if estimated < all { "; no run was completed at the others" } else { "" };
                let reason = format!(
                    "the first setting on the way up whose estimated error{} at {estimated} of {all} pilot speeds is below \
                     {target}{others}{}",
                    if self.pilots.of() == AccuracyOf::Stress { " of the largest stress" } else { "" },
                    beats.map_or(String::new(), |beats| format!("; {beats}, which is not counted"))
                );
                return Next::Take(Box::new(self.choice(&rung, steps, rung.error_of_steps, &tried, reason)));
            }
            if rung.error_of_modes >= rung.error_of_steps {
                modes = finer;
            } else if 4 * u64::from(steps) <= most_steps.min(u64::from(MOST_STEPS)) {
                steps *= 2;
            } else {
                return refuse(
                    self.limit(&rung, &format!("{target} is not reached at {steps} steps per revolution")),
                );
            }
        }
    }

    /// The most accurate setting that all speeds can be run at in what is left of `seconds`.
    fn within(&self, seconds: f64) -> Next {
        let refuse = |message: String| Next::Refuse(Violation::new("/budget/seconds", message));
        let left = seconds - self.resources.spent_s;
        let steps = self.pilots.first_steps();
        let mut modes = self.pilots.first_modes();
        let mut tried: Vec<Rung> = Vec::new();
        while let Some(finer) = self.finer(modes) {
            match self.pilots.rung((modes, finer, steps), tried.last()) {
                Ok(rung) => tried.push(rung),
                Err(missing) => {
                    let needed = missing.first().map_or(modes, |request| request.sweep.modes_per_speed());
                    let reduction = self.reduction_s(needed);
                    if reduction <= PLANNED_SHARE * left {
                        return Next::Run(missing);
                    }
                    return refuse(format!(
                        "after {:.1} s the reduction with {needed} modes per speed, which pilot runs need, would take about \
                         {reduction:.1} s more: give more than that, or the knobs",
                        self.resources.spent_s
                    ));
                }
            }
            let rung = &tried[tried.len() - 1];
            if let Some(message) = self.pilots.nothing_completed(rung) {
                return Next::Refuse(Violation::new("/budget", message));
            }
            if rung.error_of_modes <= rung.error_of_steps || !self.pays_for_more(rung, finer, left) {
                break;
            }
            modes = finer;
        }
        let Some(cheapest) = tried.first() else { return refuse(self.nothing_finer(modes, None)) };
        let options = tried.iter().filter(|rung| self.sweep_wall(rung, steps) <= PLANNED_SHARE * left);
        let options = options.map(|rung| self.enough_steps(rung, left));
        let error = |(rung, _, of_steps): &(&Rung, u32, f64)| rung.error_of_modes + rung.spread + of_steps;
        let Some((rung, taken, of_steps)) = options.min_by(|a, b| error(a).total_cmp(&error(b))) else {
            let least = self.resources.spent_s + self.sweep_wall(cheapest, steps) / PLANNED_SHARE;
            return refuse(format!(
                "the cheapest setting ({} modes per speed, {steps} steps per revolution) would take about {least:.1} s with the \
                 pilot runs: give at least that, or ask for fewer speeds or revolutions",
                cheapest.modes
            ));
        };
        if !error(&(rung, taken, of_steps)).is_finite() {
            return refuse(self.limit(rung, "no error could be estimated of what fits"));
        }
        let reason = format!(
            "the smallest estimated error of what fits into {seconds} s, {:.0} s of which had passed when it was chosen",
            self.resources.spent_s
        );
        Next::Take(Box::new(self.choice(rung, taken, of_steps, &tried, reason)))
    }

    /// Whether the next rung's pilot runs are known, or they and the sweep there fit into the `left` seconds.
    fn pays_for_more(&self, rung: &Rung, finer: u32, left: f64) -> bool {
        let Some(finest) = self.finer(finer) else { return false };
        if self.pilots.rung((finer, finest, rung.steps), Some(rung)).is_ok() {
            return true;
        }
        let dearer = Rung { step_s: rung.finer_step_s, ..rung.clone() };
        // At every pilot speed two more runs, of twice the steps and of twice the modes, and the reduction for those.
        let runs = self.wall(4 * self.pilots.speeds.len(), self.run_s(&dearer, rung.steps));
        let climb = runs + self.reduction_s(finest);
        climb <= PILOT_SHARE * left && climb + self.sweep_wall(&dearer, rung.steps) <= PLANNED_SHARE * left
    }

    /// As many steps as `left` seconds pay for and the modes are worth, with their error: of first order, to be safe.
    fn enough_steps<'r>(&self, rung: &'r Rung, left: f64) -> (&'r Rung, u32, f64) {
        let of_steps = |taken: u32| rung.error_of_steps * f64::from(rung.steps) / f64::from(taken);
        let worth = 0.25 * (rung.error_of_modes + rung.spread).max(f64::EPSILON);
        let mut taken = rung.steps;
        while of_steps(taken) > worth
            && taken < rung.steps << MOST_DOUBLINGS
            && 2 * taken <= MOST_STEPS
            && self.sweep_wall(rung, 2 * taken) <= PLANNED_SHARE * left
        {
            taken *= 2;
        }
        (rung, taken, of_steps(taken))
    }

    fn choice(&self, rung: &Rung, steps: u32, error_of_steps: f64, tried: &[Rung], reason: String) -> Choice {
        let (_, accuracy, budget) = self.request.modes.fields();
        Choice {
            accuracy,
            budget,
            setting: self.pilots.setting(rung.modes, steps),
            estimated_error: rung.error_of_modes + error_of_steps + rung.spread,
            error_of_modes: rung.error_of_modes,
            error_of_steps,
            spread: rung.spread,
            estimated_at: rung.estimated() as u32,
            expected_wall_time_s: self.sweep_wall(rung, steps),
            reason,
            pilot_speeds_rad_s: self.pilots.speeds.clone(),
            pilots: tried.iter().flat_map(|rung| rung.pilots.clone()).collect(),
        }
    }

    /// Computing time of a run at a rung's modes.
    fn run_s(&self, rung: &Rung, steps: u32) -> f64 {
        rung.set_up_s + rung.step_s * f64::from(steps)
    }

    /// Wall time of `runs` that take `seconds` each.
    fn wall(&self, runs: usize, seconds: f64) -> f64 {
        runs.div_ceil(self.resources.workers) as f64 * seconds
    }

    /// Wall time of all speeds and of those that are simulated again with twice the modes and steps.
    fn sweep_wall(&self, rung: &Rung, steps: u32) -> f64 {
        let speeds = self.request.speeds.rad_s().len();
        let run = self.run_s(rung, steps);
        let control = self.wall(self.request.control_speeds().min(speeds), 4.0 * run);
        match self.request.sweep {
            SweepDirection::Independent => self.wall(speeds, run) + control,
            // One after the other.
            SweepDirection::Up | SweepDirection::Down => speeds as f64 * run + control,
        }
    }

    /// Expected wall time of the reduction with `modes`: none if it is stored, otherwise by those that are.
    fn reduction_s(&self, modes: u32) -> f64 {
        let stored = &self.resources.reductions;
        if stored.iter().any(|&(k, _)| k == modes) {
            return 0.0;
        }
        let largest = stored.iter().max_by_key(|(k, _)| *k);
        largest.map_or(0.0, |&(k, seconds)| seconds * (f64::from(modes) / f64::from(k)).max(1.0))
    }

    fn too_rough(&self, rung: &Rung, target: f64, words: &str) -> String {
        let window = f64::from(self.request.integration.window_revolutions);
        let needed = window * (rung.spread / target).powi(2);
        let known = self.known_to(rung, words);
        format!("{known}: ask for that, or for a window of some {needed:.0} revolutions")
    }

    fn known_to(&self, rung: &Rung, words: &str) -> String {
        let (Rung { spread, spread_at, .. }, window) = (rung, self.request.integration.window_revolutions);
        format!(
            "at {spread_at:.6} rad/s the response {words}; over a window of {window} revolutions its level is known to \
             {spread:.1e} only, whatever the modes and steps"
        )
    }

    fn nothing_finer(&self, modes: u32, last: Option<&Rung>) -> String {
        let end =
            format!("{modes} modes per speed are the most that there is something finer to compare with");
        match last {
            Some(rung) => self.limit(rung, &end),
            None => format!("{end}: give the knobs yourself, or the service more memory"),
        }
    }

    fn limit(&self, rung: &Rung, end: &str) -> String {
        let number =
            |error: f64| if error.is_finite() { format!("{error:.1e}") } else { "unknown".to_owned() };
        format!(
            "{end}: with {} modes and {} steps the estimated error is {} from the modes and {} from the steps; ask for a larger \
             target, or give the knobs yourself",
            rung.modes,
            rung.steps,
            number(rung.error_of_modes),
            number(rung.error_of_steps)
        )
    }
}
