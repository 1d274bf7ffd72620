//! Pilot runs at a setting and the finer ones beside it: the errors they show.

use crate::accuracy::candidate::{Candidate, Price, setting};
use crate::accuracy::errors::errors;
use crate::request::auto_or::MOST_STEPS;
use crate::request::{AccuracyOf, SchemeChoice, Setting};
use crate::resolve::limits;
use crate::resolved::{Aim, Modes, ResolvedSweep, TrialRequest};
use crate::result::{Errors, Pilot, Trial};
use crate::stepping::steps_for_contact;
use rubmap_wheel::response::sensitivity::Growth;

/// Factor from the difference to the estimated error, the difference being that from a level with twice the modes or steps. Of 24 random
/// scenes against eight times the modes, and 40 against four times the steps (others than those of `tests/accuracy`), the true error was
/// below the estimate in nine of ten.
pub(super) const SAFETY: f64 = 2.5;

/// Largest factor by which the error of the modes is taken to fall from one rung to the next, however small the difference.
const MOST_GAIN: f64 = 4.0;

/// First rung of the modes; the first of the steps is half of what `"auto"` gives contact.
const FIRST_MODES: u32 = 20;

/// Largest number of pilot speeds.
const PILOT_SPEEDS: usize = 4;

/// Least ratio of modes of a finer level: with fewer, the difference would say little of the error.
const LEAST_FINER: f64 = 1.5;

/// Selection of `count` of `values`, evenly spread, both ends included; all if there are no more.
pub(super) fn evenly_spread<T: Copy>(values: &[T], count: usize) -> Vec<T> {
    match (values.len(), count) {
        (_, 0) => Vec::new(),
        (n, count) if n <= count => values.to_vec(),
        (_, 1) => vec![values[values.len() / 2]],
        (n, count) => (0..count).map(|i| values[(i * (n - 1) + (count - 1) / 2) / (count - 1)]).collect(),
    }
}

/// Pilot speeds of a sweep, ascending: all, or evenly spread over the ascending speeds, both ends included.
pub fn pilot_speeds(request: &ResolvedSweep) -> Vec<f64> {
    let mut speeds = request.speeds.ascending();
    speeds.dedup();
    evenly_spread(&speeds, PILOT_SPEEDS)
}

/// Next rung above `modes`, twice as many if memory (`most`) and the limit of requests allow; none if what they allow is hardly finer.
pub(super) fn finer_modes(modes: u32, most: Option<u32>) -> Option<u32> {
    let finer = (2 * modes).min(limits::MODES_PER_SPEED).min(most.unwrap_or(u32::MAX));
    (f64::from(finer) >= LEAST_FINER * f64::from(modes)).then_some(finer)
}

/// Estimated error from the difference to a finer run. Levels of responses that do not repeat differ by chance: the part of the difference
/// within its standard error is not counted; a largest stress is of one revolution and has no such error, so all of its difference counts.
/// None for stress that was not recorded.
pub(super) fn estimate(difference: &Errors, of: AccuracyOf) -> Option<f64> {
    match of {
        AccuracyOf::Response => {
            let amplitude = (difference.amplitude - difference.amplitude_spread.unwrap_or(0.0)).max(0.0);
            Some(SAFETY * amplitude.max(difference.engine_orders.unwrap_or(0.0)))
        }
        AccuracyOf::Stress => Some(SAFETY * difference.stress?),
    }
}

/// Setting that was tried, with the largest errors over the pilot speeds.
#[derive(Debug, Clone)]
pub(super) struct Rung {
    pub(super) modes: u32,
    /// Modes of the finer runs.
    pub(super) finer: u32,
    pub(super) steps: u32,
    /// Estimated error of the modes; infinite where one run of a pair was completed and the other was not.
    pub(super) error_of_modes: f64,
    pub(super) error_of_steps: f64,
    /// Standard error of the level where a response does not repeat; `spread_at` is the speed where it is largest.
    pub(super) spread: f64,
    pub(super) spread_at: f64,
    /// Price of a run; `finer_price` is that of one with more modes.
    pub(super) price: Price,
    pub(super) finer_price: Price,
    pub(super) pilots: Vec<Pilot>,
}

impl Rung {
    /// Candidate at the rung's own setting.
    pub(super) fn itself(&self) -> Candidate {
        Candidate {
            setting: setting(self.modes, SchemeChoice::ExactModal, self.steps),
            error_of_modes: self.error_of_modes,
            error_of_steps: self.error_of_steps,
            error_at_steps: self.steps,
            difference: 0.0,
            spread: self.spread,
            estimated: self.estimated(),
            price: self.price,
            controls: self.price,
        }
    }

    /// Candidate at the setting of the runs with more modes. Of the estimated error, `SAFETY` times the difference, the difference itself
    /// is taken away, assuming that more modes converge from one side; the error of the steps is that of fewer modes.
    pub(super) fn finer(&self) -> Candidate {
        Candidate {
            setting: setting(self.finer, SchemeChoice::ExactModal, self.steps),
            error_of_modes: (1.0 - 1.0 / SAFETY) * self.error_of_modes,
            price: self.finer_price,
            controls: self.finer_price,
            ..self.itself()
        }
    }

    /// Number of pilot speeds with an estimate.
    pub(super) fn estimated(&self) -> usize {
        self.pilots.iter().filter(|pilot| pilot.error_of_modes.is_some()).count()
    }

    /// Adds a pilot speed: the run, and those with more modes and more steps. `before` is the error with fewer modes.
    fn add(&mut self, pilot: Pilot, [run, more_modes, more_steps]: [&Trial; 3], of: AccuracyOf, before: f64) {
        let error = |finer: &Trial| match (run.is_completed(), finer.is_completed()) {
            (true, true) => errors(run, finer).and_then(|difference| estimate(&difference, of)),
            // A speed that ends early at any setting has no response whose error could be told.
            (false, false) => None,
            _ => Some(f64::INFINITY),
        };
        // Where the sector has no more modes the two are the same.
        let exhausted = run.unknowns == more_modes.unknowns;
        let least = if exhausted { 0.0 } else { before / MOST_GAIN };
        let error_of_modes = error(more_modes).map(|error| error.max(least));
        let error_of_steps = error(more_steps);
        // A response that repeats with more modes is not known any less for not repeating with few.
        if !run.repeats() && !more_modes.repeats() {
            let spread = errors(run, more_modes).and_then(|e| e.amplitude_spread).unwrap_or(0.0);
            if spread > self.spread {
                (self.spread, self.spread_at) = (spread, pilot.speed_rad_s);
            }
        }
        self.error_of_modes = self.error_of_modes.max(error_of_modes.unwrap_or(0.0));
        self.error_of_steps = self.error_of_steps.max(error_of_steps.unwrap_or(0.0));
        let finite = |error: Option<f64>| error.filter(|error| error.is_finite());
        self.pilots.push(Pilot {
            error_of_modes: finite(error_of_modes),
            error_of_steps: finite(error_of_steps),
            ..pilot
        });
    }
}

/// Pilot runs of a sweep.
pub(super) struct Pilots<'a, 'b> {
    pub(super) request: &'b ResolvedSweep,
    pub(super) sectors: u32,
    /// Most modes that memory allows, if known.
    pub(super) most_modes: Option<u32>,
    pub(super) speeds: Vec<f64>,
    /// Looks up a known run.
    pub(super) trial: &'b dyn Fn(&TrialRequest) -> Option<&'a Trial>,
}

impl<'a> Pilots<'a, '_> {
    /// Setting of the climb with these modes and steps.
    pub(super) fn setting(&self, modes_per_speed: u32, steps_per_revolution: u32) -> Setting {
        setting(modes_per_speed, SchemeChoice::ExactModal, steps_per_revolution)
    }

    pub(super) fn first_modes(&self) -> u32 {
        FIRST_MODES.min(self.most_modes.unwrap_or(u32::MAX))
    }

    pub(super) fn first_steps(&self) -> u32 {
        let (automatic, _) = steps_for_contact(self.request);
        let first = (0.5 * automatic).max(self.least_steps());
        Setting::aligned_steps(first.ceil() as u32, self.request, self.sectors)
    }

    /// Fewest steps per revolution that resolve the scene.
    pub(super) fn least_steps(&self) -> f64 {
        let (automatic, _) = steps_for_contact(self.request);
        // No step may jump a rod of a coating.
        let least = if self.request.scene.abradable.is_some() { automatic } else { 1.0 };
        least.max(f64::from(2 * self.request.max_engine_order + 1)).min(f64::from(MOST_STEPS))
    }

    /// Quantity whose error is judged.
    pub(super) fn of(&self) -> AccuracyOf {
        match self.request.modes {
            Modes::Sought(Aim::Accuracy(accuracy)) => accuracy.of,
            Modes::Sought(Aim::Budget(_)) | Modes::Given(_) => AccuracyOf::Response,
        }
    }

    pub(super) fn find(&self, speed: f64, setting: Setting) -> Result<&'a Trial, Box<TrialRequest>> {
        let request = TrialRequest::new(self.request, speed, setting);
        let request = match self.of() {
            AccuracyOf::Response => request,
            AccuracyOf::Stress => request.with_stress_of(self.request),
        };
        (self.trial)(&request).ok_or_else(|| Box::new(request))
    }

    /// Rung from the runs at (k, S), (`finer`, S) and (k, 2S) at every pilot speed; or the missing runs. `below` is a rung with fewer
    /// modes.
    pub(super) fn rung(
        &self,
        (modes, finer, steps): (u32, u32, u32),
        below: Option<&Rung>,
    ) -> Result<Rung, Vec<TrialRequest>> {
        let settings =
            [self.setting(modes, steps), self.setting(finer, steps), self.setting(modes, 2 * steps)];
        let mut missing: Vec<TrialRequest> = Vec::new();
        let mut rung = Rung {
            modes,
            finer,
            steps,
            error_of_modes: 0.0,
            error_of_steps: 0.0,
            spread: 0.0,
            spread_at: 0.0,
            price: Price::default(),
            finer_price: Price::default(),
            pilots: Vec::new(),
        };
        let mut sums_s = [0.0; 3];
        for (index, &speed) in self.speeds.iter().enumerate() {
            let found = settings.map(|setting| self.find(speed, setting));
            if let [Ok(run), Ok(more_modes), Ok(more_steps)] = found {
                let before = below.and_then(|below| below.pilots[index].error_of_modes).unwrap_or(0.0);
                let pilot = self.pilot(speed, settings[0], run);
                rung.add(pilot, [run, more_modes, more_steps], self.of(), before);
                // A run that was not completed says nothing of what more steps take: as much again, to be safe.
                let doubled =
                    if more_steps.is_completed() { self.run_s(more_steps) } else { 2.0 * self.run_s(run) };
                let seconds = [self.run_s(run), doubled, self.run_s(more_modes)];
                for (sum, seconds) in sums_s.iter_mut().zip(seconds) {
                    *sum += seconds / self.speeds.len() as f64;
                }
            } else {
                missing.extend(found.into_iter().filter_map(Result::err).map(|request| *request));
            }
        }
        let [run_s, doubled_s, finer_s] = sums_s;
        rung.price = Price::of(steps, run_s, doubled_s);
        rung.finer_price = rung.price.through(steps, finer_s);
        // Few modes first: what their reduction takes tells what the next one will.
        let fewest = missing.iter().map(|request| request.sweep.modes_per_speed()).min();
        missing.retain(|request| Some(request.sweep.modes_per_speed()) == fewest);
        if missing.is_empty() { Ok(rung) } else { Err(missing) }
    }

    /// Report of a pilot run, without errors.
    pub(super) fn pilot(&self, speed_rad_s: f64, setting: Setting, run: &Trial) -> Pilot {
        Pilot {
            speed_rad_s,
            modes_per_speed: setting.modes_per_speed,
            scheme: setting.scheme,
            steps_per_revolution: setting.steps_per_revolution,
            verdict: run.point.settling.as_ref().map(|settling| settling.verdict),
            error_of_modes: None,
            error_of_steps: None,
            difference: None,
            time_s: run.cost.of_run(run.revolutions(&self.request.integration)),
        }
    }

    /// Computing time of a run like `run` in the sweep, s.
    pub(super) fn run_s(&self, run: &Trial) -> f64 {
        let integration = &self.request.integration;
        run.cost.of_run(match self.request.modes {
            // Other speeds may not repeat as soon as these, and a budget is kept.
            Modes::Sought(Aim::Budget(_)) => f64::from(integration.revolutions()),
            Modes::Sought(Aim::Accuracy(_)) | Modes::Given(_) => run.revolutions(integration),
        })
    }

    /// Reason why no pilot speed has an estimate; none if one has.
    pub(super) fn nothing_completed(&self, rung: &Rung) -> Option<String> {
        if rung.estimated() > 0 || rung.error_of_modes.is_infinite() || rung.error_of_steps.is_infinite() {
            return None;
        }
        let run = |&speed: &f64| self.find(speed, self.setting(rung.modes, rung.steps)).ok();
        let message = self.speeds.iter().filter_map(run).find_map(|trial| trial.point.message.clone());
        let why = message.unwrap_or_else(|| "none was completed".to_owned());
        Some(format!(
            "no pilot run gives an error to be estimated: {why}; change that, or give the knobs yourself"
        ))
    }

    /// Character of the response whose level varies most, from a tiny perturbation; or the missing run.
    pub(super) fn sensitivity(&self, rung: &Rung) -> Result<Roughness, Box<TrialRequest>> {
        let setting = self.setting(rung.modes, rung.steps);
        let request = TrialRequest { twin: true, ..TrialRequest::new(self.request, rung.spread_at, setting) };
        let Some(trial) = (self.trial)(&request) else { return Err(Box::new(request)) };
        let growth = trial.sensitivity.map_or(Growth::Undecided, |sensitivity| sensitivity.growth);
        let what = match growth {
            Growth::Chaotic => "is chaotic",
            Growth::QuasiPeriodic => "is quasi-periodic",
            Growth::Stable => "does not repeat, though it forgets a tiny perturbation",
            Growth::Undecided => "does not repeat, and the run is too short to say whether it is chaotic",
        };
        let rate = trial.sensitivity.and_then(|sensitivity| sensitivity.rate_in_words());
        let rate = rate.map_or(String::new(), |rate| format!(" (a tiny perturbation grows by {rate})"));
        Ok(Roughness { chaotic: growth == Growth::Chaotic, words: format!("{what}{rate}") })
    }
}

/// Reason why the level of a response varies.
pub(super) struct Roughness {
    /// Whether the response is chaotic: its level varies by chance, at any setting.
    pub(super) chaotic: bool,
    /// Kind of response, with the growth rate of a tiny perturbation, in words.
    pub(super) words: String,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pilots_are_spread_evenly_from_end_to_end() {
        let values: Vec<u32> = (0..120).collect();
        assert_eq!(evenly_spread(&values, 4), [0, 40, 79, 119]);
        assert_eq!(evenly_spread(&values[..3], 4), [0, 1, 2]);
        assert_eq!(evenly_spread(&values[..5], 4), [0, 1, 3, 4]);
        assert_eq!((evenly_spread(&values, 1), evenly_spread(&values, 0)), (vec![60], vec![]));
    }

    #[test]
    fn a_rung_is_half_as_fine_again_at_least() {
        let finer = |modes, most| finer_modes(modes, most);
        assert_eq!((finer(20, None), finer(320, None), finer(400, None)), (Some(40), Some(500), None));
        assert_eq!((finer(40, Some(60)), finer(60, Some(60)), finer(20, Some(21))), (Some(60), None, None));
    }

    #[test]
    fn chance_is_not_taken_for_an_error() {
        let difference = |amplitude, spread| Errors {
            history: None,
            amplitude,
            amplitude_spread: spread,
            engine_orders: None,
            impulse: None,
            stress: None,
        };
        let of_response =
            |amplitude, spread| estimate(&difference(amplitude, spread), AccuracyOf::Response).unwrap();
        assert_eq!(of_response(0.02, Some(0.03)), 0.0);
        assert!((of_response(0.05, Some(0.03)) - 2.5 * 0.02).abs() < 1e-12);
        assert!((of_response(0.05, None) - 2.5 * 0.05).abs() < 1e-12);
        assert_eq!(estimate(&difference(0.05, None), AccuracyOf::Stress), None);
        let with_stress = Errors { stress: Some(0.04), ..difference(0.0, Some(0.1)) };
        assert_eq!(estimate(&with_stress, AccuracyOf::Stress), Some(2.5 * 0.04));
    }
}
