//! Choice of the cheapest setting that meets a target.
//!
//! Nothing here looks at a clock: the same scene has the same choice on every machine.

use crate::accuracy::beside::WAYS;
use crate::accuracy::candidate::Candidate;
use crate::accuracy::climb::{Climb, MOST_DOUBLINGS, Next, pilots};
use crate::accuracy::rung::Rung;
use crate::error::Violation;
use crate::request::auto_or::MOST_STEPS;
use crate::request::{AccuracyOf, SchemeChoice};
use crate::resolved::TrialRequest;
use crate::result::Pilot;

/// Least number of speeds per pilot speed for cheaper settings to be tried: all of them take about two runs at each pilot speed, and the
/// dearest saves a fifth of one at every speed.
const WORTH_TRYING: usize = 10;

impl Climb<'_, '_> {
    /// Chooses the first setting of the climb that meets `target`, or a cheaper one beside it that meets it too.
    pub(super) fn to_target(&self, target: f64) -> Next {
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
            let meets = |candidate: &Candidate| candidate.error_of_setting() + counted <= target;
            if let Some(found) = self.of_climb(&rung).into_iter().find(meets) {
                let mut pilots = pilots(&tried);
                return match self.cheapest(&rung, found, &meets, &mut pilots) {
                    Ok(taken) => {
                        let reason = self.reason(&taken, target, beats);
                        Next::Take(Box::new(self.choice(&taken, pilots, reason)))
                    }
                    Err(missing) => Next::Run(missing),
                };
            }
            if rung.error_of_modes >= rung.error_of_steps {
                modes = finer;
            } else if 4 * u64::from(steps) <= most_steps.min(u64::from(MOST_STEPS)) {
                steps *= 2;
            } else {
                return refuse(self.limit(
                    &rung.itself(),
                    &format!("{target} is not reached at {steps} steps per revolution"),
                ));
            }
        }
    }

    /// Candidates of a rung: its own setting, and the finer one if there is something still finer to control it with.
    pub(super) fn of_climb(&self, rung: &Rung) -> Vec<Candidate> {
        let finer = Some(rung.finer()).filter(|_| self.finer(rung.finer).is_some());
        [rung.itself()].into_iter().chain(finer).collect()
    }

    /// First cheaper setting beside `rung` that `meets` the target; `found` itself if there is none; or the missing runs.
    fn cheapest(
        &self,
        rung: &Rung,
        found: Candidate,
        meets: &dyn Fn(&Candidate) -> bool,
        pilots: &mut Vec<Pilot>,
    ) -> Result<Candidate, Vec<TrialRequest>> {
        if self.request.speeds.rad_s().len() < WORTH_TRYING * self.pilots.speeds.len() {
            return Ok(found);
        }
        for way in WAYS {
            let Some(setting) = self.pilots.cheaper(way, found.setting.modes_per_speed, rung.steps) else {
                continue;
            };
            let beside = self.pilots.beside(setting, rung, found.price)?;
            pilots.extend(beside.pilots);
            if meets(&beside.candidate) {
                return Ok(beside.candidate);
            }
        }
        Ok(found)
    }

    fn reason(&self, taken: &Candidate, target: f64, beats: Option<String>) -> String {
        let (estimated, all) = (taken.estimated, self.pilots.speeds.len());
        let others = if estimated < all { "; no run was completed at the others" } else { "" };
        let of = if self.pilots.of() == AccuracyOf::Stress { " of the largest stress" } else { "" };
        let held = match (taken.difference > 0.0, taken.setting.scheme) {
            (false, _) => "",
            (true, SchemeChoice::MasslessBoundary) => {
                "; the boundary may go without mass, since runs that keep it, with at least as many modes and steps, differ by no more than that"
            }
            (true, _) => "; it was held against runs with at least as many modes and steps",
        };
        let beats = beats.map_or(String::new(), |beats| format!("; {beats}, which is not counted"));
        format!(
            "the cheapest setting tried whose estimated error{of} at {estimated} of {all} pilot speeds is below {target}{held}{others}{beats}"
        )
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
}
