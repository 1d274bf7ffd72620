//! Settings beside those of the climb, each compared with a run of the climb that has at least as many modes and steps and keeps the mass.
//!
//! The error of that run is known from the climb; the error of a setting beside it is at most this error plus the difference. The sum
//! counts as at least `SAFETY` times the difference, as in every estimate, so that control runs show no larger error than the pilot runs.

use crate::accuracy::candidate::{Candidate, Price, setting};
use crate::accuracy::errors::errors;
use crate::accuracy::rung::{Pilots, Rung, SAFETY};
use crate::request::{AccuracyOf, SchemeChoice, Setting, SweepDirection};
use crate::resolved::TrialRequest;
use crate::result::{Errors, Pilot, Quantity, Trial};

/// Cheaper variant of a setting: its scheme and its share of the steps.
#[derive(Debug, Clone, Copy)]
pub(super) struct Way {
    pub(super) scheme: SchemeChoice,
    /// Share of the steps of the setting.
    pub(super) steps: f64,
    /// Approximate share of the computing time, before it is measured.
    pub(super) time: f64,
}

/// Cheaper variants, ascending in time. Times measured on the demo at 24,000 rpm with 40 modes and 2,080 steps; three quarters of the steps
/// would take 0.9.
pub(super) const WAYS: [Way; 3] = [
    Way { scheme: SchemeChoice::MasslessBoundary, steps: 0.5, time: 0.6 },
    Way { scheme: SchemeChoice::ExactModal, steps: 0.5, time: 0.8 },
    Way { scheme: SchemeChoice::MasslessBoundary, steps: 1.0, time: 0.8 },
];

/// Result of a setting tried beside a rung.
#[derive(Debug)]
pub(super) struct Beside {
    pub(super) candidate: Candidate,
    pub(super) pilots: Vec<Pilot>,
}

impl Pilots<'_, '_> {
    /// Setting that is cheaper than `modes` with `steps` in this `way`; none where the scene does not allow it.
    pub(super) fn cheaper(&self, way: Way, modes: u32, steps: u32) -> Option<Setting> {
        let massless = way.scheme == SchemeChoice::MasslessBoundary;
        if massless && !self.may_lose_mass() {
            return None;
        }
        let wanted = (way.steps * f64::from(steps)).max(self.least_steps());
        let taken = Setting::aligned_steps(wanted.ceil() as u32, self.request, self.sectors);
        // Steps are whole, and not below what the scene needs: two ways may be one, or none at all.
        let as_meant = taken < steps || way.steps == 1.0;
        as_meant.then(|| setting(modes, way.scheme, taken))
    }

    /// Whether the boundary may go without mass: the scene has contact, nothing in it depends on the scheme, and no speed starts from the
    /// end of another one, which would pass on only the kept modes.
    fn may_lose_mass(&self) -> bool {
        let scene = &self.request.scene;
        scene.contact.is_some()
            && scene.friction.is_none()
            && scene.flexible_casing.is_none()
            && scene.initial.is_none()
            && self.request.sweep == SweepDirection::Independent
    }

    /// Compares `setting` with the runs of `rung` with more modes at every pilot speed; or the missing runs. `controls` is the price of a
    /// run with as many modes by the scheme of the climb.
    pub(super) fn beside(
        &self,
        setting: Setting,
        rung: &Rung,
        controls: Price,
    ) -> Result<Beside, Vec<TrialRequest>> {
        let mut missing = Vec::new();
        let (mut largest, mut run_s, mut pilots) = (0.0_f64, 0.0, Vec::new());
        for &speed in &self.speeds {
            let finer = self.find(speed, self.setting(rung.finer, rung.steps));
            let (run, finer) = match (self.find(speed, setting), finer) {
                (Ok(run), Ok(finer)) => (run, finer),
                (run, finer) => {
                    missing.extend([run, finer].into_iter().filter_map(Result::err).map(|request| *request));
                    continue;
                }
            };
            let difference = difference(run, finer, self.of());
            largest = largest.max(difference.unwrap_or(0.0));
            run_s += self.run_s(run) / self.speeds.len() as f64;
            pilots.push(Pilot {
                difference: difference.filter(|difference| difference.is_finite()),
                ..self.pilot(speed, setting, run)
            });
        }
        if !missing.is_empty() {
            return Err(missing);
        }
        let finer = rung.finer();
        let of_finer = finer.error_of_modes + finer.error_of_steps;
        let candidate = Candidate {
            setting,
            difference: largest.max(SAFETY * largest - of_finer),
            price: rung.price.through(setting.steps_per_revolution, run_s),
            controls,
            ..finer
        };
        Ok(Beside { candidate, pilots })
    }
}

/// Difference of a run from the one with mass and more modes, scatter included; infinite where the runs are of different kinds or the run
/// could not begin, none where both began and neither was completed.
fn difference(run: &Trial, finer: &Trial, of: AccuracyOf) -> Option<f64> {
    match (run.is_completed(), finer.is_completed()) {
        (false, false) if run.unknowns > 0 => None,
        (true, true) if run.repeats() == finer.repeats() => {
            Some(errors(run, finer).and_then(|found| judged(&found, of)).unwrap_or(f64::INFINITY))
        }
        _ => Some(f64::INFINITY),
    }
}

fn judged(difference: &Errors, of: AccuracyOf) -> Option<f64> {
    match of {
        AccuracyOf::Response => {
            let amplitude = difference.judged(Quantity::Amplitude)?;
            Some(amplitude.max(difference.engine_orders.unwrap_or(0.0)))
        }
        AccuracyOf::Stress => difference.stress,
    }
}
