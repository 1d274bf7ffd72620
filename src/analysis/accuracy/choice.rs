//! Which setting meets a target at the least cost, or is the most accurate that a budget pays for.
//!
//! Pilot runs at a few speeds of the scene climb two ladders that double: modes per speed and steps per revolution. At a setting
//! (k, S) the error of the modes is estimated from the difference to (2k, S), that of the steps from the difference to (k, 2S),
//! and whichever is larger is refined. Time is stepped by the exact propagator with mass: the scheme that the others are held
//! against, and at equal error the cheapest (see the work–precision picture in the README).
//!
//! [`next`] is a pure function of the runs known so far: it names the runs it misses, and ends with a choice or a refusal.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use super::errors::errors;
use super::trial::{Setting, Trial, TrialRequest};
use crate::analysis::auto_or::AutoOr;
use crate::analysis::error::Violation;
use crate::analysis::request::{SchemeChoice, SweepRequest};
use crate::analysis::resolve::limits;
use crate::analysis::result::{PointStatus, Verdict};
use crate::analysis::stepping::{MOST_STEPS, steps_for_contact};

/// The setting that pilot runs chose, and why.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct Choice {
    /// The setting.
    pub setting: Setting,
    /// Estimated relative error of the steady response, the largest of the pilot speeds: of modes and steps together.
    pub estimated_error: f64,
    /// Part of it that more modes would remove.
    pub error_of_modes: f64,
    /// Part of it that more steps would remove.
    pub error_of_steps: f64,
    /// Expected wall time of all speeds and of those that are simulated again, s.
    pub expected_wall_time_s: f64,
    /// Why, in words.
    pub reason: String,
    /// Speeds of the pilot runs, rad/s.
    pub pilot_speeds_rad_s: Vec<f64>,
    /// What they showed, setting by setting as they were tried.
    pub pilots: Vec<Pilot>,
}

/// Errors of one setting at one pilot speed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct Pilot {
    /// Ω, rad/s.
    pub speed_rad_s: f64,
    /// Fixed-interface modes kept per stiffness speed and nodal diameter.
    pub modes_per_speed: u32,
    /// Time steps per revolution.
    pub steps_per_revolution: u32,
    /// Steady-state verdict; absent where the run was not completed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub verdict: Option<Verdict>,
    /// Estimated error that more modes would remove; absent where a run was not completed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub error_of_modes: Option<f64>,
    /// Estimated error that more steps would remove; absent where a run was not completed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub error_of_steps: Option<f64>,
    /// Computing time of this run, s.
    pub time_s: f64,
}

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
    /// Wall time that the job has taken so far, s.
    pub spent_s: f64,
    /// `modes_per_speed` and wall time of the reductions that are stored, s.
    pub reductions: Vec<(u32, f64)>,
    /// Most `modes_per_speed` that memory allows, if that is known.
    pub most_modes: Option<u32>,
}

/// The estimate of an error is this many times the difference from a level with twice the modes or steps. Of 24 random scenes
/// against eight times the modes, and 40 against four times the steps, nine in ten differences were off by less.
pub(super) const SAFETY: f64 = 2.5;

/// A difference that falls by more than this factor from one level to the next is not believed to have fallen farther.
const MOST_GAIN: f64 = 4.0;

/// First rung of the modes; that of the steps is half of what `"auto"` gives contact.
const FIRST_MODES: u32 = 20;

/// Last rung of the steps, as a multiple of the first.
const MOST_DOUBLINGS: u32 = 7;

/// Most pilot speeds.
const PILOT_SPEEDS: usize = 4;

/// Share of what is left of a budget that runs are planned for.
const PLANNED_SHARE: f64 = 0.9;

/// Share of what is left of a budget that the next rung's pilot runs and reduction may take.
const PILOT_SHARE: f64 = 0.3;

/// Pilot speeds of a sweep, ascending: all, or evenly spread over the ascending speeds, both ends included.
pub fn pilot_speeds(request: &SweepRequest) -> Vec<f64> {
    spread(&request.speeds.ascending().unwrap_or_default(), PILOT_SPEEDS)
}

/// `count` of `values`, evenly spread, both ends included; all if there are no more.
pub(super) fn spread<T: Copy>(values: &[T], count: usize) -> Vec<T> {
    match (values.len(), count) {
        (_, 0) => Vec::new(),
        (n, count) if n <= count => values.to_vec(),
        (_, 1) => vec![values[values.len() / 2]],
        (n, count) => (0..count).map(|i| values[(i * (n - 1) + (count - 1) / 2) / (count - 1)]).collect(),
    }
}

/// The next rung above `modes`, at most `most`.
pub(super) fn finer_modes(modes: u32, most: Option<u32>) -> u32 {
    (2 * modes).min(limits::MODES_PER_SPEED).min(most.unwrap_or(u32::MAX)).max(modes)
}

/// Chooses for a resolved sweep of a wheel of `sectors`; `trial` looks up a run that is known.
pub fn next<'a>(
    request: &SweepRequest,
    sectors: u32,
    resources: &Resources,
    trial: &dyn Fn(&TrialRequest) -> Option<&'a Trial>,
) -> Next {
    let climb = Climb { request, sectors, resources, trial, speeds: pilot_speeds(request) };
    let (fewest, field) =
        (climb.first_modes(), if request.accuracy.is_some() { "/accuracy" } else { "/budget" });
    if finer_modes(fewest, resources.most_modes) <= fewest {
        let message = format!(
            "memory allows reductions of {fewest} modes per speed, and there is nothing finer to tell their error from: give the \
             knobs yourself, or the service more memory"
        );
        return Next::Refuse(Violation::new(field, message));
    }
    match (&request.accuracy, &request.budget) {
        (Some(accuracy), _) => climb.to_target(accuracy.target),
        (None, Some(budget)) => climb.within(budget.seconds),
        (None, None) => Next::Refuse(Violation::new("/accuracy", "there is no target and no budget")),
    }
}

/// A climb over settings.
struct Climb<'a, 'b> {
    request: &'b SweepRequest,
    sectors: u32,
    resources: &'b Resources,
    trial: &'b dyn Fn(&TrialRequest) -> Option<&'a Trial>,
    speeds: Vec<f64>,
}

/// A setting that was tried.
#[derive(Debug, Clone)]
struct Rung {
    modes: u32,
    steps: u32,
    error_of_modes: f64,
    error_of_steps: f64,
    /// Spread of the level where a response does not repeat, and the speed where it is largest.
    spread: f64,
    spread_at: f64,
    /// Mean times of a pilot run, s: set-up and of one step.
    set_up_s: f64,
    step_s: f64,
    pilots: Vec<Pilot>,
}

impl Rung {
    fn error(&self) -> f64 {
        self.error_of_modes + self.error_of_steps
    }
}

impl<'a> Climb<'a, '_> {
    fn setting(&self, modes_per_speed: u32, steps_per_revolution: u32) -> Setting {
        Setting {
            modes_per_speed,
            scheme: SchemeChoice::ExactModal,
            kept_modes: AutoOr::Auto,
            steps_per_revolution,
        }
    }

    fn first_modes(&self) -> u32 {
        FIRST_MODES.min(self.resources.most_modes.unwrap_or(u32::MAX))
    }

    fn first_steps(&self) -> u32 {
        let (automatic, _) = steps_for_contact(self.request);
        // No step may jump a rod of a coating.
        let least = if self.request.scene.abradable.is_some() { automatic } else { 0.5 * automatic };
        let least = least.max(f64::from(2 * self.request.max_engine_order + 1)).min(f64::from(MOST_STEPS));
        Setting::aligned_steps(least.ceil() as u32, self.request, self.sectors)
    }

    /// What the runs at (k, S), (2k, S) and (k, 2S) show at every pilot speed; or the missing ones. `below` is the rung with half
    /// the modes.
    fn rung(&self, modes: u32, steps: u32, below: Option<&Rung>) -> Result<Rung, Vec<TrialRequest>> {
        let settings = [
            self.setting(modes, steps),
            self.setting(finer_modes(modes, self.resources.most_modes), steps),
            self.setting(modes, 2 * steps),
        ];
        let mut missing: Vec<TrialRequest> = Vec::new();
        let mut rung = Rung {
            modes,
            steps,
            error_of_modes: 0.0,
            error_of_steps: 0.0,
            spread: 0.0,
            spread_at: 0.0,
            set_up_s: 0.0,
            step_s: 0.0,
            pilots: Vec::new(),
        };
        for (index, &speed) in self.speeds.iter().enumerate() {
            let requests = settings.map(|setting| TrialRequest::new(self.request, speed, setting));
            let found = requests.each_ref().map(|request| (self.trial)(request));
            let [Some(run), Some(more_modes), Some(more_steps)] = found else {
                for (request, found) in requests.into_iter().zip(found) {
                    if found.is_none() && !missing.contains(&request) {
                        missing.push(request);
                    }
                }
                continue;
            };
            let of_modes = errors(run, more_modes);
            let of_steps = errors(run, more_steps);
            let before = below.and_then(|below| below.pilots[index].error_of_modes).unwrap_or(0.0);
            let estimate = |amplitude: f64, lines: Option<f64>| SAFETY * amplitude.max(lines.unwrap_or(0.0));
            let error_of_modes = of_modes
                .map(|e| estimate(e.amplitude, e.engine_orders).max(before / MOST_GAIN).min(f64::MAX));
            let error_of_steps = of_steps.map(|e| estimate(e.amplitude, e.engine_orders));
            // A response that repeats with more modes is not known any less for not repeating with few.
            let rough = [run, more_modes].iter().all(|trial| !trial.repeats());
            let spread = of_modes.filter(|_| rough).and_then(|e| e.amplitude_spread).unwrap_or(0.0);
            if spread > rung.spread {
                (rung.spread, rung.spread_at) = (spread, speed);
            }
            rung.error_of_modes = rung.error_of_modes.max(error_of_modes.unwrap_or(0.0));
            rung.error_of_steps = rung.error_of_steps.max(error_of_steps.unwrap_or(0.0));
            let share = 1.0 / self.speeds.len() as f64;
            rung.set_up_s += share * run.cost.set_up_s;
            rung.step_s += share * run.cost.per_revolution_s / f64::from(steps);
            rung.pilots.push(Pilot {
                speed_rad_s: speed,
                modes_per_speed: modes,
                steps_per_revolution: steps,
                verdict: run.point.settling.as_ref().map(|settling| settling.verdict),
                error_of_modes,
                error_of_steps,
                time_s: run.cost.of_run(self.request.integration.revolutions),
            });
        }
        // Few modes first: what their reduction takes tells what the next one will.
        let fewest = missing.iter().map(|request| request.sweep.modes()).min();
        missing.retain(|request| Some(request.sweep.modes()) == fewest);
        if missing.is_empty() { Ok(rung) } else { Err(missing) }
    }

    /// The first setting on the way up that meets `target`.
    fn to_target(&self, target: f64) -> Next {
        let refuse = |message: String| Next::Refuse(Violation::new("/accuracy/target", message));
        let (mut modes, mut steps) = (self.first_modes(), self.first_steps());
        let most_steps = self.first_steps().saturating_mul(1 << MOST_DOUBLINGS).min(MOST_STEPS);
        let mut tried: Vec<Rung> = Vec::new();
        loop {
            let below = tried.iter().rev().find(|rung| rung.modes < modes);
            let rung = match self.rung(modes, steps, below) {
                Ok(rung) => rung,
                Err(missing) => return Next::Run(missing),
            };
            if let Some(message) = self.nothing_completed(&rung) {
                return refuse(message);
            }
            if rung.spread > target {
                return match self.sensitivity(&rung) {
                    Ok(words) => refuse(self.too_rough(&rung, target, &words)),
                    Err(missing) => Next::Run(vec![*missing]),
                };
            }
            tried.push(rung.clone());
            if rung.error() <= target {
                let reason = format!(
                    "the first setting on the way up whose estimated error at {} pilot speeds is below {target}",
                    self.speeds.len()
                );
                return Next::Take(Box::new(self.choice(&rung, steps, rung.error_of_steps, &tried, reason)));
            }
            let finer = finer_modes(modes, self.resources.most_modes);
            if rung.error_of_modes >= rung.error_of_steps {
                if finer_modes(finer, self.resources.most_modes) <= finer {
                    return refuse(self.limit(
                        &rung,
                        target,
                        &format!("{modes} modes per speed, with {finer} to compare"),
                    ));
                }
                modes = finer;
            } else {
                if u64::from(steps) * 4 > u64::from(most_steps) {
                    return refuse(self.limit(&rung, target, &format!("{steps} steps per revolution")));
                }
                steps *= 2;
            }
        }
    }

    /// The most accurate setting that all speeds can be run at in what is left of `seconds`.
    fn within(&self, seconds: f64) -> Next {
        let left = seconds - self.resources.spent_s;
        let too_short = |modes: u32, reduction: f64| {
            let message = format!(
                "the reduction with {modes} modes per speed, which pilot runs need, would take about {reduction:.0} s alone, and \
                 {left:.0} s are left: give more, or the knobs"
            );
            Next::Refuse(Violation::new("/budget/seconds", message))
        };
        let steps = self.first_steps();
        let mut modes = self.first_modes();
        let mut tried: Vec<Rung> = Vec::new();
        loop {
            match self.rung(modes, steps, tried.last()) {
                Ok(rung) => tried.push(rung),
                Err(missing) => {
                    let needed = missing.first().map_or(modes, |request| request.sweep.modes());
                    let reduction = self.reduction_s(needed);
                    return if reduction <= PLANNED_SHARE * left {
                        Next::Run(missing)
                    } else {
                        too_short(needed, reduction)
                    };
                }
            }
            let rung = &tried[tried.len() - 1];
            if let Some(message) = self.nothing_completed(rung) {
                return Next::Refuse(Violation::new("/budget", message));
            }
            let finer = finer_modes(modes, self.resources.most_modes);
            let finest = finer_modes(finer, self.resources.most_modes);
            // The next rung costs two more pilot runs per speed, of twice the steps or modes, and the reduction for them.
            let step_s = rung.step_s * f64::from(finer) / f64::from(modes);
            let pilots = self.wall(4 * self.speeds.len(), rung.set_up_s + self.steps_of_run(steps) * step_s);
            let climb = pilots + self.reduction_s(finest);
            let pays = rung.error_of_modes > rung.error_of_steps && finest > finer;
            let next = self.sweep_wall(rung.set_up_s, step_s, steps);
            let known = self.rung(finer, steps, Some(rung)).is_ok();
            let fits = climb <= PILOT_SHARE * left && climb + next <= PLANNED_SHARE * left;
            if !(pays && (known || fits)) {
                break;
            }
            modes = finer;
        }
        let affordable = |rung: &Rung, steps: u32| {
            self.sweep_wall(rung.set_up_s, rung.step_s, steps) <= PLANNED_SHARE * left
        };
        let options = tried.iter().filter(|rung| affordable(rung, steps)).map(|rung| {
            // Steps beyond what the modes are worth buy nothing. First order, to be safe.
            let mut taken = steps;
            let of_steps = |taken: u32| rung.error_of_steps * f64::from(steps) / f64::from(taken);
            while of_steps(taken) > 0.25 * rung.error_of_modes.max(f64::EPSILON)
                && affordable(rung, 2 * taken)
                && taken < steps << MOST_DOUBLINGS
            {
                taken *= 2;
            }
            (rung, taken, of_steps(taken))
        });
        let error = |option: &(&Rung, u32, f64)| option.0.error_of_modes.max(option.0.spread) + option.2;
        let Some((rung, taken, of_steps)) = options.min_by(|a, b| error(a).total_cmp(&error(b))) else {
            let rung = &tried[0];
            let least =
                self.resources.spent_s + self.sweep_wall(rung.set_up_s, rung.step_s, steps) / PLANNED_SHARE;
            return Next::Refuse(Violation::new(
                "/budget/seconds",
                format!(
                    "the cheapest setting ({} modes per speed, {steps} steps per revolution) would take about {least:.0} s with \
                     the pilot runs: give at least that, or ask for fewer speeds or revolutions",
                    rung.modes
                ),
            ));
        };
        let reason = format!(
            "the smallest estimated error of what fits into {seconds} s, of which {:.0} s went into reductions and pilot runs",
            self.resources.spent_s
        );
        Next::Take(Box::new(self.choice(rung, taken, of_steps, &tried, reason)))
    }

    fn choice(&self, rung: &Rung, steps: u32, error_of_steps: f64, tried: &[Rung], reason: String) -> Choice {
        Choice {
            setting: self.setting(rung.modes, steps),
            estimated_error: (rung.error_of_modes + error_of_steps).max(rung.spread),
            error_of_modes: rung.error_of_modes,
            error_of_steps,
            expected_wall_time_s: self.sweep_wall(rung.set_up_s, rung.step_s, steps),
            reason,
            pilot_speeds_rad_s: self.speeds.clone(),
            pilots: tried.iter().flat_map(|rung| rung.pilots.clone()).collect(),
        }
    }

    fn steps_of_run(&self, steps: u32) -> f64 {
        f64::from(steps) * f64::from(self.request.integration.revolutions)
    }

    /// Wall time of `runs` that take `seconds` each.
    fn wall(&self, runs: usize, seconds: f64) -> f64 {
        runs.div_ceil(self.resources.workers) as f64 * seconds
    }

    /// Wall time of all speeds and of those that are simulated again with twice the modes and steps.
    fn sweep_wall(&self, set_up_s: f64, step_s: f64, steps: u32) -> f64 {
        let speeds = self.request.speeds.resolve().map_or(0, |speeds| speeds.len());
        let run = set_up_s + self.steps_of_run(steps) * step_s;
        let control = self.wall(self.request.controls().min(speeds), 4.0 * run);
        match self.request.sweep {
            crate::analysis::request::SweepDirection::Independent => self.wall(speeds, run) + control,
            _ => speeds as f64 * run + control,
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

    fn nothing_completed(&self, rung: &Rung) -> Option<String> {
        let completed =
            rung.pilots.iter().any(|pilot| pilot.error_of_modes.is_some() && pilot.error_of_steps.is_some());
        let run = |&speed: &f64| {
            (self.trial)(&TrialRequest::new(self.request, speed, self.setting(rung.modes, rung.steps)))
        };
        let why = || {
            let message = self.speeds.iter().filter_map(run).find_map(|trial| trial.point.message.clone());
            message.unwrap_or_else(|| "runs with more modes or steps did not end".to_owned())
        };
        (!completed).then(|| {
            format!("no pilot run was completed from which an error could be estimated: {}; give the knobs yourself", why())
        })
    }

    /// What a tiny perturbation does where the level of the response varies most; or the missing run.
    fn sensitivity(&self, rung: &Rung) -> Result<String, Box<TrialRequest>> {
        let request = TrialRequest {
            twin: true,
            ..TrialRequest::new(self.request, rung.spread_at, self.setting(rung.modes, rung.steps))
        };
        let Some(trial) = (self.trial)(&request) else { return Err(Box::new(request)) };
        let chaotic = |s: &&crate::response::sensitivity::Sensitivity| s.chaotic;
        Ok(match (trial.sensitivity.as_ref().filter(chaotic), trial.point.status) {
            (Some(sensitivity), PointStatus::Completed) => match sensitivity.rate_per_revolution {
                Some(rate) => format!("is chaotic (a tiny perturbation grows by e^{rate:.2} a revolution)"),
                None => "is chaotic (a tiny perturbation grows)".to_owned(),
            },
            _ => "does not repeat".to_owned(),
        })
    }

    fn too_rough(&self, rung: &Rung, target: f64, words: &str) -> String {
        let window = f64::from(self.request.integration.window_revolutions);
        let needed = window * (rung.spread / target).powi(2);
        let Rung { spread, spread_at, .. } = rung;
        format!(
            "at {spread_at:.6} rad/s the response {words}; over a window of {window} revolutions its level is known to \
             {spread:.1e} only, whatever the modes and steps: ask for that, or for a window of some {needed:.0} revolutions"
        )
    }

    fn limit(&self, rung: &Rung, target: f64, limit: &str) -> String {
        let worst =
            |pilot: &&Pilot| pilot.error_of_modes.unwrap_or(0.0) + pilot.error_of_steps.unwrap_or(0.0);
        let at =
            rung.pilots.iter().max_by(|a, b| worst(a).total_cmp(&worst(b))).map_or(0.0, |p| p.speed_rad_s);
        format!(
            "{target} is not reached at {limit}: at {at:.6} rad/s the estimated error is {:.1e} from the modes and {:.1e} from the \
             steps; ask for a larger target, or give the knobs yourself",
            rung.error_of_modes, rung.error_of_steps
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pilots_are_spread_evenly_from_end_to_end() {
        let values: Vec<u32> = (0..120).collect();
        assert_eq!(spread(&values, 4), [0, 40, 79, 119]);
        assert_eq!(spread(&values[..3], 4), [0, 1, 2]);
        assert_eq!(spread(&values[..5], 4), [0, 1, 3, 4]);
        assert_eq!((spread(&values, 1), spread(&values, 0)), (vec![60], vec![]));
    }

    #[test]
    fn modes_double_up_to_what_is_allowed() {
        assert_eq!((finer_modes(20, None), finer_modes(320, None), finer_modes(500, None)), (40, 500, 500));
        assert_eq!((finer_modes(40, Some(60)), finer_modes(60, Some(60))), (60, 60));
    }
}
