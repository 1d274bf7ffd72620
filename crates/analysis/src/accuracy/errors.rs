//! Differences of a run from a finer one.

use crate::accuracy::trial::lines;
use crate::resolved::ResolvedSweep;
use crate::result::trial::repeats;
use crate::result::{Errors, Point, PointStress, SpeedSpectra, Trial};

/// Steady response of a completed run, as it is compared.
pub(super) struct Response<'a> {
    /// Root mean square, `[sensor]`.
    pub(super) rms: Vec<f64>,
    /// Amplitudes, `[sensor][engine order]`.
    pub(super) lines: Vec<Vec<f64>>,
    /// Levels of the parts of the window, `[sensor][block]`; empty where they were not recorded.
    pub(super) levels: &'a [Vec<f64>],
    pub(super) repeats: bool,
    /// Contact impulse over the whole run; `mean_force` is the mean force over the window.
    impulse: f64,
    mean_force: f64,
    /// Whether the run took all the revolutions asked for.
    took_all: bool,
    /// Stress, where it was recorded.
    pub(super) stress: Option<&'a PointStress>,
}

impl<'a> Response<'a> {
    /// Response of a trial, if it was completed.
    pub(super) fn of_trial(trial: &'a Trial) -> Option<Self> {
        (!trial.lines.is_empty()).then(|| Self {
            lines: trial.lines.clone(),
            levels: &trial.levels,
            ..Self::of_point(&trial.point)
        })
    }

    /// Response of a speed of a sweep.
    pub(super) fn of_speed(point: &'a Point, spectra: &SpeedSpectra, request: &ResolvedSweep) -> Self {
        Self { lines: lines(spectra, request), ..Self::of_point(point) }
    }

    fn of_point(point: &'a Point) -> Self {
        Self {
            rms: point.responses.iter().map(|response| response.rms).collect(),
            lines: Vec::new(),
            levels: &[],
            repeats: repeats(point),
            impulse: point.contact_impulse.unwrap_or(0.0),
            mean_force: point.contact.as_ref().map_or(0.0, |contact| contact.mean_force),
            took_all: point.march.is_none() && !point.is_solved(),
            stress: point.stress.as_ref(),
        }
    }

    /// Differences from a finer response.
    pub(super) fn errors(&self, finer: &Response) -> Errors {
        let largest = finer.rms.iter().copied().fold(0.0, f64::max);
        let differences = self.rms.iter().zip(&finer.rms).map(|(a, b)| (a - b).abs());
        let repeat = self.repeats && finer.repeats;
        // Sums over a run can be compared where both runs have the same revolutions.
        let (impulse, finer_impulse) = match self.took_all && finer.took_all {
            true => (self.impulse, finer.impulse),
            false => (self.mean_force, finer.mean_force),
        };
        Errors {
            history: None,
            amplitude: relative(differences.fold(0.0, f64::max), largest),
            amplitude_spread: (!repeat).then(|| {
                // Levels that were not kept vary as the finer ones do.
                let levels = if self.levels.is_empty() { finer.levels } else { self.levels };
                relative(standard_error(levels).hypot(standard_error(finer.levels)), largest)
            }),
            engine_orders: repeat.then(|| self.error_of_lines(finer)),
            impulse: (impulse != 0.0 || finer_impulse != 0.0)
                .then(|| relative((impulse - finer_impulse).abs(), finer_impulse.abs())),
            stress: self
                .stress
                .zip(finer.stress)
                .map(|(a, b)| relative(a.difference(b), b.largest.von_mises)),
        }
    }

    fn error_of_lines(&self, finer: &Response) -> f64 {
        let norm = |squares: &mut dyn Iterator<Item = f64>| squares.sum::<f64>().sqrt();
        let largest =
            finer.lines.iter().map(|line| norm(&mut line.iter().map(|a| a * a))).fold(0.0, f64::max);
        let sensors = self.lines.iter().zip(&finer.lines);
        let error = sensors.map(|(a, b)| norm(&mut a.iter().zip(b).map(|(a, b)| (a - b).powi(2))));
        relative(error.fold(0.0, f64::max), largest)
    }
}

/// Differences of a trial from a finer one; none unless both were completed.
pub fn errors(trial: &Trial, finer: &Trial) -> Option<Errors> {
    let steady = Response::of_trial(trial)?.errors(&Response::of_trial(finer)?);
    Some(Errors { history: history_error(trial, finer), ..steady })
}

/// Relative difference of histories, ‖x − y‖/‖y‖ over the first revolutions, all sensors together; none without histories at the same
/// instants of motions that begin alike.
pub(crate) fn history_error(trial: &Trial, finer: &Trial) -> Option<f64> {
    // One that was solved for begins on its response, one that was marched where its scene begins.
    if trial.point.is_solved() != finer.point.is_solved() {
        return None;
    }
    let lengths = |trial: &Trial| trial.history.iter().map(Vec::len).collect::<Vec<_>>();
    if trial.history.first()?.is_empty() || lengths(trial) != lengths(finer) {
        return None;
    }
    let pairs = || trial.history.iter().flatten().zip(finer.history.iter().flatten());
    let difference: f64 = pairs().map(|(x, y)| (x - y).powi(2)).sum();
    let size: f64 = pairs().map(|(_, y)| y * y).sum();
    Some(relative(difference.sqrt(), size.sqrt()))
}

/// Largest standard error of a sensor's level, from the levels of the parts of the window.
fn standard_error(levels: &[Vec<f64>]) -> f64 {
    let error = |parts: &Vec<f64>| {
        let n = parts.len() as f64;
        let mean = parts.iter().sum::<f64>() / n;
        let variance = parts.iter().map(|level| (level - mean).powi(2)).sum::<f64>() / (n - 1.0);
        (variance / n).sqrt()
    };
    levels.iter().filter(|parts| parts.len() > 1).map(error).fold(0.0, f64::max)
}

/// Ratio of `difference` to `size`: 1 where `size` is 0 and the difference is not.
fn relative(difference: f64, size: f64) -> f64 {
    match (difference == 0.0, size == 0.0) {
        (true, _) => 0.0,
        (false, true) => 1.0,
        (false, false) => difference / size,
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;
    use crate::result::{Cost, Quantity};

    fn response(rms: &[f64], lines: &[&[f64]], levels: &[Vec<f64>], repeats: bool) -> Errors {
        let of = |rms: Vec<f64>, lines: Vec<Vec<f64>>| Response {
            rms,
            lines,
            levels,
            repeats,
            impulse: 2.0,
            mean_force: 0.5,
            took_all: true,
            stress: None,
        };
        let run = of(rms.to_vec(), lines.iter().map(|line| line.to_vec()).collect());
        run.errors(&of(vec![1.0, 4.0], vec![vec![0.0, 1.0], vec![3.0, 4.0]]))
    }

    #[test]
    fn differences_are_relative_to_the_largest_sensor() {
        let found = response(&[1.2, 4.0], &[&[0.0, 1.0], &[3.3, 4.4]], &[], true);
        assert!((found.amplitude - 0.05).abs() < 1e-12 && found.amplitude_spread.is_none());
        assert!((found.engine_orders.unwrap() - 0.1).abs() < 1e-12 && found.impulse == Some(0.0));
    }

    #[test]
    fn histories_begin_alike_or_are_not_compared() {
        let of = |history: f64, solved: bool| {
            let steady = solved.then(|| json!({"taken": true, "revolutions": 9.0}));
            let point = json!({"index": 0, "speed_rad_s": 1.0, "status": "completed", "responses": [],
                "steps_per_revolution": 1, "smallest_stable_steps_per_revolution": 1, "steps": 1, "contact_share": 0.0,
                "steady": steady, "wall_time_s": 0.0, "version": "0"});
            Trial {
                point: serde_json::from_value(point).unwrap(),
                unknowns: 1,
                lines: Vec::new(),
                levels: Vec::new(),
                history: vec![vec![history; 2]],
                samples_per_revolution: 2,
                sensitivity: None,
                cost: Cost::default(),
            }
        };
        assert_eq!(history_error(&of(3.0, true), &of(2.0, true)), Some(0.5));
        assert_eq!(history_error(&of(3.0, false), &of(2.0, false)), Some(0.5));
        assert_eq!(history_error(&of(3.0, true), &of(2.0, false)), None);
        assert_eq!(history_error(&of(3.0, false), &of(2.0, true)), None);
    }

    #[test]
    fn impulses_of_runs_that_end_by_themselves_are_those_of_their_windows() {
        let of = |impulse: f64, mean_force: f64, took_all: bool| Response {
            rms: vec![1.0],
            lines: Vec::new(),
            levels: &[],
            repeats: true,
            impulse,
            mean_force,
            took_all,
            stress: None,
        };
        let error = |run: &Response, finer: &Response| run.errors(finer).impulse.unwrap();
        // Twenty-two revolutions and twenty-five of the same contact.
        assert_eq!(error(&of(22.0, 1.0, false), &of(25.0, 1.0, false)), 0.0);
        assert_eq!(error(&of(50.0, 1.1, true), &of(25.0, 1.0, false)), relative(1.1f64 - 1.0, 1.0));
        assert_eq!(error(&of(51.0, 1.1, true), &of(50.0, 1.0, true)), 0.02);
    }

    #[test]
    fn a_response_that_never_repeats_is_known_to_the_spread_of_its_level() {
        let levels = [vec![1.0; 4], vec![3.8, 4.2, 3.8, 4.2]];
        let found = response(&[1.0, 4.0], &[&[0.0, 1.0], &[9.0, 9.0]], &levels, false);
        let expected = 2f64.sqrt() * (0.04f64 * 4.0 / 3.0 / 4.0).sqrt() / 4.0;
        assert!(found.engine_orders.is_none() && (found.amplitude_spread.unwrap() - expected).abs() < 1e-12);
        assert_eq!(found.judged(Quantity::Amplitude), found.amplitude_spread);
    }
}
