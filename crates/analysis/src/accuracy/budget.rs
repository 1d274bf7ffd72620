//! Choice of the most accurate setting within a budget.

use crate::accuracy::beside::{WAYS, Way};
use crate::accuracy::candidate::{Candidate, Price};
use crate::accuracy::climb::{Climb, MODES_DOUBLED, MOST_DOUBLINGS, Next, PLANNED_SHARE, pilots};
use crate::accuracy::rung::Rung;
use crate::error::Violation;
use crate::request::auto_or::MOST_STEPS;
use crate::request::{SchemeChoice, Setting};
use crate::resolved::TrialRequest;
use crate::result::Pilot;

/// Share of the remaining budget that the next pilot runs and their reduction may take.
const PILOT_SHARE: f64 = 0.4;

/// Least share of the error of the steps in all other errors; below it, more steps are not worth taking.
const LEAST_OF_STEPS: f64 = 0.01;

/// Share of the budget that a choice should use; below it, the reason says why it does not.
const USED_SHARE: f64 = 0.8;

/// Unchanged modes and steps of a rung or of its finer runs.
const AS_IT_IS: Way = Way { scheme: SchemeChoice::ExactModal, steps: 1.0, time: 1.0 };

impl Climb<'_, '_> {
    /// Chooses the most accurate setting with which all speeds fit into what is left of `seconds`.
    pub(super) fn within(&self, seconds: f64) -> Next {
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
            let with_enough_steps = self.enough_steps(&rung.itself(), left);
            let of_modes = rung.error_of_modes > with_enough_steps.error_of_steps;
            if !self.goes_on(rung, finer, of_modes, left) {
                break;
            }
            modes = finer;
        }
        let Some(last) = tried.last() else { return refuse(self.nothing_finer(modes, None)) };
        let mut candidates: Vec<Candidate> = tried.iter().flat_map(|rung| self.of_climb(rung)).collect();
        let mut pilots = pilots(&tried);
        if let Err(missing) = self.between(last, left, &mut candidates, &mut pilots) {
            return Next::Run(missing);
        }
        let options = candidates.iter().filter(|candidate| self.fits(candidate, left));
        let options = options.map(|candidate| self.enough_steps(candidate, left));
        let Some(taken) = options.min_by(|a, b| a.error().total_cmp(&b.error())) else {
            let walls = candidates.iter().map(|candidate| self.sweep_wall(candidate));
            let least = self.resources.spent_s + walls.fold(f64::INFINITY, f64::min) / PLANNED_SHARE;
            return refuse(format!(
                "the cheapest setting tried would take about {least:.1} s with the pilot runs: give at least that, or ask for fewer \
                 speeds or revolutions"
            ));
        };
        if !taken.error().is_finite() {
            return refuse(self.limit(&taken, "no error could be estimated of what fits"));
        }
        let spent = self.resources.spent_s;
        let used = spent + self.sweep_wall(&taken);
        let rest = if used < USED_SHARE * seconds {
            "; nothing finer that was tried fits into the rest of it, or more steps would say nothing more"
        } else {
            ""
        };
        let reason = format!(
            "the smallest estimated error of what fits into {seconds} s, {spent:.0} s of which had passed when it was chosen{rest}"
        );
        Next::Take(Box::new(self.choice(&taken, pilots, reason)))
    }

    fn fits(&self, candidate: &Candidate, left: f64) -> bool {
        self.sweep_wall(candidate) <= PLANNED_SHARE * left
    }

    /// Whether the next rung's pilot runs are known, or, where the error is `of_modes`, they and the sweep there fit into the `left`
    /// seconds.
    fn goes_on(&self, rung: &Rung, finer: u32, of_modes: bool, left: f64) -> bool {
        let Some(finest) = self.finer(finer) else { return false };
        if self.pilots.rung((finer, finest, rung.steps), Some(rung)).is_ok() {
            return true;
        }
        // At every pilot speed two more runs, of twice the steps and of twice the modes.
        let run = |steps| rung.finer_price.of_run(steps);
        let both = run(2 * rung.steps) + MODES_DOUBLED * run(rung.steps);
        let runs = self.wall(self.pilots.speeds.len(), both);
        of_modes && self.pays(runs + self.reduction_s(finest), &rung.finer(), left)
    }

    /// Whether pilot runs that take `pilots_s` with their reduction, and the sweep at the setting whose error they estimate, fit into the
    /// `left` seconds.
    fn pays(&self, pilots_s: f64, candidate: &Candidate, left: f64) -> bool {
        pilots_s <= PILOT_SHARE * left && pilots_s + self.sweep_wall(candidate) <= PLANNED_SHARE * left
    }

    /// Adds settings between the last rung and its runs with more modes, the finest first, until one fits into `left` seconds that is more
    /// accurate than the rung; or the missing runs of the next setting.
    fn between(
        &self,
        last: &Rung,
        left: f64,
        candidates: &mut Vec<Candidate>,
        pilots: &mut Vec<Pilot>,
    ) -> Result<(), Vec<TrialRequest>> {
        let halfway = (last.modes + last.finer) / 2;
        let [run_s, finer_s] = [last.price, last.finer_price].map(|price| price.of_run(last.steps));
        let sizes = [
            (last.finer, last.finer_price),
            (halfway, last.price.through(last.steps, 0.5 * (run_s + finer_s))),
            (last.modes, last.price),
        ];
        for (modes, price) in sizes {
            if self.finer(modes).is_none() {
                continue;
            }
            let of_climb = candidates.iter().find(|c| c.setting.modes_per_speed == modes);
            if of_climb.is_some_and(|candidate| self.fits(candidate, left)) {
                return Ok(());
            }
            let as_it_is = Some(AS_IT_IS).filter(|_| of_climb.is_none());
            for way in as_it_is.into_iter().chain(WAYS.into_iter().rev()) {
                let Some(setting) = self.pilots.cheaper(way, modes, last.steps) else { continue };
                match self.pilots.beside(setting, last, price) {
                    Ok(beside) => {
                        let better = beside.candidate.error() < last.itself().error() || modes == last.modes;
                        let found = better && self.fits(&beside.candidate, left);
                        candidates.push(beside.candidate);
                        pilots.extend(beside.pilots);
                        if found {
                            return Ok(());
                        }
                    }
                    Err(missing) => {
                        let expected = expected(last, setting, way, price);
                        let run = expected.price.of_run(setting.steps_per_revolution);
                        let pilots_s = self.wall(missing.len(), run) + self.reduction_s(modes);
                        if self.pays(pilots_s, &expected, left) {
                            return Err(missing);
                        }
                    }
                }
            }
        }
        Ok(())
    }

    /// Candidate with as many steps as `left` seconds pay for, as long as they reduce its error. Without mass at the boundary the steps
    /// stay, as the gain of more was not measured.
    fn enough_steps(&self, candidate: &Candidate, left: f64) -> Candidate {
        let steps = candidate.setting.steps_per_revolution;
        let unit = Setting::aligned_steps(1, self.request, self.pilots.sectors);
        let most = (u64::from(steps) << MOST_DOUBLINGS).min(u64::from(MOST_STEPS));
        let mut taken = candidate.clone();
        while candidate.setting.scheme == SchemeChoice::ExactModal
            && taken.error_of_steps > LEAST_OF_STEPS * (taken.error() - taken.error_of_steps)
        {
            let next = taken.setting.steps_per_revolution + unit;
            let finer = candidate.with_steps(next);
            if u64::from(next) > most || !self.fits(&finer, left) {
                break;
            }
            taken = finer;
        }
        taken
    }
}

/// Expected candidate for a setting that was not measured yet, if a run takes as long as this `way` should.
fn expected(last: &Rung, taken: Setting, way: Way, controls: Price) -> Candidate {
    let run_s = way.time * controls.of_run(last.steps);
    let price = controls.through(taken.steps_per_revolution, run_s);
    Candidate { setting: taken, price, controls, ..last.finer() }
}
