//! Error of a finished sweep, from some of its speeds simulated again at a finer setting.

use crate::accuracy::errors::Response;
use crate::accuracy::rung::{SAFETY, estimate, evenly_spread, finer_modes};
use crate::request::auto_or::MOST_STEPS;
use crate::request::{Accuracy, AccuracyOf, AutoOr, SchemeChoice, Setting};
use crate::resolved::{ResolvedSweep, TrialRequest};
use crate::result::{Control, ErrorEstimate, Point, PointError, PointStatus, SpeedSpectra, Trial};
use rubmap_wheel::response::critical_speed::peaks;

/// Speed of a sweep with its finer run.
#[derive(Debug, Clone, Copy)]
pub struct FinerRun<'a> {
    /// Index of the speed in the request.
    pub index: u32,
    /// Setting of the finer run.
    pub setting: Setting,
    /// Spectra of the speed in the sweep.
    pub spectra: &'a SpeedSpectra,
    /// Result of the finer run.
    pub trial: &'a Trial,
}

/// Control runs of a finished sweep: index of the speed, finer setting, run; from the points of all speeds. `most_modes` is the largest
/// reduction that memory allows, if known.
pub fn control_requests(
    request: &ResolvedSweep,
    sectors: u32,
    points: &[Point],
    most_modes: Option<u32>,
) -> Vec<(u32, Setting, TrialRequest)> {
    let mut ascending: Vec<&Point> =
        points.iter().filter(|point| point.status == PointStatus::Completed).collect();
    ascending.sort_by(|a, b| a.speed_rad_s.total_cmp(&b.speed_rad_s));
    let wanted = request.control_speeds().min(ascending.len());
    let level = |point: &&Point| Some(point.tip?.rms);
    let mut prominent = peaks(&ascending.iter().map(level).collect::<Vec<_>>(), 0.0);
    prominent.sort_by(|a, b| b.prominence.total_cmp(&a.prominence).then(a.index.cmp(&b.index)));
    let mut chosen: Vec<usize> = prominent.iter().take(wanted / 2).map(|peak| peak.index).collect();
    let others: Vec<usize> = (0..ascending.len()).filter(|index| !chosen.contains(index)).collect();
    chosen.extend(evenly_spread(&others, wanted - chosen.len()));
    chosen.sort_unstable();
    let finer = |index: usize| {
        let point = ascending[index];
        let setting = finer_setting(request, sectors, point, most_modes);
        let trial = TrialRequest::new(request, point.speed_rad_s, setting).with_stress_of(request);
        (point.index, setting, trial)
    };
    chosen.into_iter().map(finer).collect()
}

/// Setting with twice the modes, as far as memory allows, and twice the steps, by the exact propagator with mass.
fn finer_setting(request: &ResolvedSweep, sectors: u32, point: &Point, most_modes: Option<u32>) -> Setting {
    let steps = point.steps_per_revolution.saturating_mul(2).min(MOST_STEPS);
    Setting {
        modes_per_speed: finer_modes(request.modes_per_speed(), most_modes)
            .unwrap_or(request.modes_per_speed()),
        scheme: SchemeChoice::ExactModal,
        kept_modes: AutoOr::Auto,
        steps_per_revolution: Setting::aligned_steps(steps, request, sectors),
    }
}

/// Estimates the errors of all completed speeds from the finer runs of some, each given with the spectra of the speed itself, and tells
/// whether they are within the accuracy asked for, if any.
pub fn error_estimate(
    request: &ResolvedSweep,
    accuracy: Option<Accuracy>,
    points: &[Point],
    controls: &[FinerRun<'_>],
) -> ErrorEstimate {
    let mut controls: Vec<Control> = controls
        .iter()
        .filter_map(|FinerRun { index, setting, spectra, trial }| {
            let point = points.iter().find(|point| point.index == *index)?;
            let differences = Response::of_trial(trial)
                .map(|finer| Response::of_speed(point, spectra, request).errors(&finer));
            Some(Control {
                index: *index,
                speed_rad_s: point.speed_rad_s,
                setting: *setting,
                steady: trial.point.steady.clone(),
                estimated_stress_error: differences.and_then(|d| estimate(&d, AccuracyOf::Stress)),
                estimated_error: differences.and_then(|d| {
                    Some(estimate(&d, AccuracyOf::Response)?.max(d.amplitude_spread.unwrap_or(0.0)))
                }),
                differences,
                message: trial.point.message.clone(),
            })
        })
        .collect();
    raise_stress_errors(&mut controls);
    let completed = points.iter().filter(|point| point.status == PointStatus::Completed).count();
    let points = point_errors(points, &controls);
    let largest = points.iter().map(|point| point.estimated_error).reduce(f64::max);
    let with_modes =
        controls.iter().all(|control| control.setting.modes_per_speed > request.modes_per_speed());
    let of_stress = points.iter().filter_map(|point| point.estimated_stress_error);
    let (known_of_stress, largest_of_stress) = (of_stress.clone().count(), of_stress.reduce(f64::max));
    let target_met = accuracy.and_then(|Accuracy { target, of, .. }| {
        let (known, largest) = match of {
            AccuracyOf::Response => (points.len(), largest),
            AccuracyOf::Stress => (known_of_stress, largest_of_stress),
        };
        let all_known = known == completed;
        let within = all_known && largest.is_none_or(|largest| largest <= target);
        (with_modes || !all_known).then_some(within)
    });
    let estimated = controls.iter().filter(|control| control.estimated_error.is_some()).count();
    let ended = match controls.len() - estimated {
        0 => String::new(),
        early => format!(
            "; {early} more of them were not completed at the finer setting, although they were in the sweep: what they and the speeds \
             beside them show is not known to be right"
        ),
    };
    let unrepeated = match controls.iter().filter(|control| !repeats(control)).count() {
        0 => String::new(),
        unrepeated => format!(
            "; the motion does not repeat at {unrepeated} of them, whose error tells nothing about other speeds: none is estimated at the \
             speeds beside them"
        ),
    };
    let message = match largest {
        None => format!(
            "the error of the amplitudes is not known: no control run gave an estimate{ended}{unrepeated}"
        ),
        Some(_) => format!(
            "relative error of the steady response{}: {SAFETY} times its difference from finer runs at {estimated} of the speeds, whose \
             settings are in `controls`; at the others the larger estimate of the nearest on either side{}{ended}{unrepeated}",
            if with_modes { "" } else { " from the steps alone, since no finer reduction could be made" },
            if largest_of_stress.is_some() { "; of the largest stress likewise" } else { "" }
        ),
    };
    ErrorEstimate { controls, points, largest, largest_of_stress, target_met, message }
}

/// Raises errors of stress below their median to it: two runs whose largest stresses agree better than their neighbours' do so by chance. Runs
/// that repeat and runs that do not have a median each.
fn raise_stress_errors(controls: &mut [Control]) {
    for alike in [true, false] {
        let mut errors: Vec<&mut f64> = (controls.iter_mut().filter(|control| repeats(control) == alike))
            .filter_map(|control| control.estimated_stress_error.as_mut())
            .collect();
        errors.sort_unstable_by(|a, b| a.total_cmp(b));
        let Some(median) = errors.get(errors.len() / 2).map(|median| **median) else { continue };
        errors.into_iter().for_each(|error| *error = error.max(median));
    }
}

/// Whether both runs of a control speed repeat, as far as they were completed.
fn repeats(control: &Control) -> bool {
    control.differences.is_none_or(|differences| differences.amplitude_spread.is_none())
}

fn point_errors(points: &[Point], controls: &[Control]) -> Vec<PointError> {
    let of = |point: &Point| {
        let told = |error: fn(&Control) -> Option<f64>| around(point, controls, error);
        Some(PointError {
            index: point.index,
            estimated_error: told(|control| control.estimated_error)?,
            estimated_stress_error: told(|control| control.estimated_stress_error),
            controlled: controls.iter().any(|control| control.index == point.index),
        })
    };
    points.iter().filter(|point| point.status == PointStatus::Completed).filter_map(of).collect()
}

/// Error of a point: that of its own control run, otherwise the larger of the nearest on either side; none where one of them is unknown, or is that
/// of a motion that does not repeat: chance makes it, not a setting that the neighbours share.
fn around(point: &Point, controls: &[Control], error: fn(&Control) -> Option<f64>) -> Option<f64> {
    if let Some(control) = controls.iter().find(|control| control.index == point.index) {
        return error(control);
    }
    let nearest = |side: fn(f64) -> bool| {
        let distance = |control: &&Control| (control.speed_rad_s - point.speed_rad_s).abs();
        let here = controls.iter().filter(|control| side(control.speed_rad_s - point.speed_rad_s));
        here.min_by(|a, b| distance(a).total_cmp(&distance(b)))
    };
    let beside = [nearest(|d| d <= 0.0), nearest(|d| d >= 0.0)].into_iter().flatten();
    let passed_on = |control: &Control| error(control).filter(|_| repeats(control));
    beside.map(passed_on).reduce(|a, b| Some(a?.max(b?)))?
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;
    use crate::result::Errors;

    fn points(count: u32) -> Vec<Point> {
        let point = |index: u32| {
            json!({"index": index, "speed_rad_s": 100.0 + f64::from(index), "status": "completed", "responses": [],
                "steps_per_revolution": 1, "smallest_stable_steps_per_revolution": 1, "steps": 1, "contact_share": 0.0,
                "wall_time_s": 0.0, "version": "0"})
        };
        (0..count).map(|index| serde_json::from_value(point(index)).unwrap()).collect()
    }

    fn control(index: u32, estimated_error: Option<f64>) -> Control {
        let setting = Setting {
            modes_per_speed: 40,
            scheme: SchemeChoice::ExactModal,
            kept_modes: AutoOr::Auto,
            steps_per_revolution: 1000,
        };
        let speed_rad_s = 100.0 + f64::from(index);
        Control {
            index,
            speed_rad_s,
            setting,
            steady: None,
            differences: None,
            estimated_error,
            estimated_stress_error: None,
            message: None,
        }
    }

    #[test]
    fn errors_between_controls_are_the_larger_ones_and_unknown_beside_the_unknown() {
        let mut controls = [control(1, Some(0.1)), control(4, Some(0.3)), control(7, None)];
        controls[0].estimated_stress_error = Some(0.9);
        let found = point_errors(&points(9), &controls);
        let of_stress: Vec<_> = found.iter().map(|p| p.estimated_stress_error).collect();
        assert_eq!(of_stress, [Some(0.9), Some(0.9), None, None, None], "4 tells none of its stress");
        let found: Vec<_> = found.iter().map(|p| (p.index, p.estimated_error, p.controlled)).collect();
        let expected = [(0, 0.1, false), (1, 0.1, true), (2, 0.3, false), (3, 0.3, false), (4, 0.3, true)];
        assert_eq!(found, expected, "5 to 8 lie beside a control run that ended early");
        assert!(point_errors(&points(3), &[]).is_empty());
    }

    #[test]
    fn runs_that_do_not_repeat_leave_the_median_of_the_others() {
        let stress =
            [(0.1, true), (0.2, true), (0.3, true), (4.0, false), (5.0, false), (6.0, false), (7.0, false)];
        let of = |(index, (error, repeats)): (u32, (f64, bool))| Control {
            estimated_stress_error: Some(error),
            differences: Some(Errors {
                history: None,
                amplitude: 0.0,
                amplitude_spread: (!repeats).then_some(0.0),
                engine_orders: None,
                impulse: None,
                stress: Some(error),
            }),
            ..control(index, Some(0.1))
        };
        let mut controls: Vec<Control> = (0..).zip(stress).map(of).collect();
        raise_stress_errors(&mut controls);
        let raised: Vec<f64> = controls.iter().filter_map(|control| control.estimated_stress_error).collect();
        assert_eq!(raised, [0.2, 0.2, 0.3, 6.0, 6.0, 6.0, 7.0]);
    }
}
