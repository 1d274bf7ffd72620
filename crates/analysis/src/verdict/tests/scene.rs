//! Sweeps by hand: a response over speed, and what the request asks.

use serde_json::{Value, json};

use crate::request::{AutoOr, SchemeChoice, Setting, SweepRequest};
use crate::resolved::ResolvedSweep;
use crate::result::{ErrorEstimate, OpenKind, Point, SpeedSpectra, SweepVerdict, Trial, VerdictWord};
use crate::run::{FinerRun, error_estimate};
use crate::verdict::{Evidence, coverage_warnings, judge};
use rubmap_wheel::dynamics::sector::Units;
use rubmap_wheel::response::campbell::DrivenCrossing;

/// Sweep by hand, speeds in rad/s.
#[derive(Clone)]
pub(super) struct Scene {
    pub(super) speeds: Vec<f64>,
    /// Finished points by index, as JSON; null where a speed has no result.
    pub(super) points: Vec<Value>,
    pub(super) ranges: Value,
    pub(super) limits: Value,
    /// Relative errors, of the response and of stress, at all speeds.
    pub(super) errors: Option<(f64, Option<f64>)>,
    /// Control runs in place of `errors`: index of the speed, level of the finer run, and whether that repeats.
    pub(super) controls: Vec<(usize, f64, bool)>,
    /// Fields of the request in place of the usual ones.
    pub(super) request: Vec<(&'static str, Value)>,
    /// Linear critical speeds; none before the sweep has ended.
    pub(super) driven: Option<Vec<DrivenCrossing>>,
    /// Whether the job still runs.
    pub(super) unfinished: bool,
}

/// Finished point at `speed` with tip motion `tip`, a clearance of 1, and a force of 10 times the motion.
pub(super) fn point(index: usize, speed: f64, tip: f64) -> Value {
    json!({
        "index": index, "speed_rad_s": speed, "status": "completed", "responses": [],
        "steps_per_revolution": 1, "smallest_stable_steps_per_revolution": 1, "steps": 1, "contact_share": 0.0,
        "wall_time_s": 0.0, "version": "0", "settling": {"verdict": "periodic"},
        "tip": {"rms": 0.7 * tip, "half_peak_to_peak": tip, "contact_node": 0, "sector": 0, "component": "radial", "over_clearance": tip},
        "contact": {"mean_force": 0.0, "peak_force": 10.0 * tip, "peak_node_force": 10.0 * tip, "closings_per_revolution": 1.0,
            "clearance_consumption": tip, "clearance_contact_node": 0, "samples_per_revolution": 512},
        "validity": {"verdict": "linear", "checks": []},
    })
}

impl Scene {
    /// Sweep from 100 to 120 rad/s in steps of 1 with tip motion `level`, one range `run` from 105 to 115, and an error of 1 %.
    pub(super) fn of(level: impl Fn(f64) -> f64) -> Self {
        let speeds: Vec<f64> = (100..=120).map(f64::from).collect();
        let points = speeds.iter().enumerate().map(|(index, &speed)| point(index, speed, level(speed)));
        Self {
            points: points.collect(),
            speeds,
            ranges: json!([range("run", 105.0, 115.0, 0.0)]),
            limits: json!({"tip_motion": 1.0}),
            errors: Some((0.01, None)),
            controls: Vec::new(),
            request: Vec::new(),
            driven: Some(Vec::new()),
            unfinished: false,
        }
    }

    /// Flat response: no peak anywhere.
    pub(super) fn flat(level: f64) -> Self {
        Self::of(|_| level)
    }

    /// Response with a resolved peak of `height` at `speed`, above a level of 0.1.
    pub(super) fn peak(speed: f64, height: f64) -> Self {
        Self::of(|at| (height * (1.0 - 0.09 * (at - speed).abs())).max(0.1))
    }

    pub(super) fn limited(mut self, limits: Value) -> Self {
        self.limits = limits;
        self
    }

    pub(super) fn ranges(mut self, ranges: Value) -> Self {
        self.ranges = ranges;
        self
    }

    pub(super) fn asking(mut self, field: &'static str, value: Value) -> Self {
        self.request.push((field, value));
        self
    }

    pub(super) fn error(mut self, of_response: f64, of_stress: Option<f64>) -> Self {
        self.errors = Some((of_response, of_stress));
        self
    }

    /// Scene whose errors are estimated from control runs.
    pub(super) fn controlled(mut self, controls: &[(usize, f64, bool)]) -> Self {
        for point in &mut self.points {
            point["responses"] = responses(point["tip"]["rms"].as_f64().unwrap());
        }
        self.controls = controls.to_vec();
        self
    }

    /// Scene of a job that still runs, or else was cancelled.
    pub(super) fn unfinished(self, is_running: bool) -> Self {
        Self { driven: None, unfinished: is_running, ..self }
    }

    pub(super) fn without_errors(mut self) -> Self {
        self.errors = None;
        self
    }

    /// Scene with a field of the points in `indices` changed.
    pub(super) fn with(
        mut self,
        indices: impl IntoIterator<Item = usize>,
        field: &str,
        value: &Value,
    ) -> Self {
        for index in indices {
            *self.points[index].pointer_mut(field).unwrap_or_else(|| panic!("{field}")) = value.clone();
        }
        self
    }

    /// Scene with a field added to the points in `indices`.
    pub(super) fn adding(
        mut self,
        indices: impl IntoIterator<Item = usize>,
        field: &str,
        value: &Value,
    ) -> Self {
        for index in indices {
            self.points[index][field] = value.clone();
        }
        self
    }

    /// Request of the scene, resolved.
    fn request(&self) -> ResolvedSweep {
        let mut request = json!({
            "model": "m", "speeds": {"values": self.speeds, "unit": "rad_s"}, "scene": {"contact": {}},
            "sensors": [],
        });
        if !self.ranges.is_null() {
            request["operation"] = json!({"ranges": self.ranges});
        }
        if !self.limits.is_null() {
            request["limits"] = self.limits.clone();
        }
        for (field, value) in &self.request {
            request[*field] = value.clone();
        }
        let request: SweepRequest = serde_json::from_value(request).unwrap();
        ResolvedSweep::stored(request, 0).unwrap()
    }

    /// Warnings of the plan about ranges without speeds.
    pub(super) fn warnings(&self) -> Vec<String> {
        coverage_warnings(&self.request())
    }

    pub(super) fn verdict(&self) -> SweepVerdict {
        let request = self.request();
        let finished = self.points.iter().filter(|point| !point.is_null());
        let points: Vec<Point> =
            finished.map(|point| serde_json::from_value(point.clone()).unwrap()).collect();
        let errors = self.errors.map(|(of_response, of_stress)| {
            let of_point = |point: &Point| {
                json!({"index": point.index, "estimated_error": of_response, "estimated_stress_error": of_stress, "controlled": false})
            };
            let all: Vec<Value> = points.iter().map(of_point).collect();
            serde_json::from_value::<ErrorEstimate>(json!({"controls": [], "points": all, "message": ""})).unwrap()
        });
        let estimated = (!self.controls.is_empty()).then(|| self.estimated(&request, &points));
        let errors = estimated.or(errors);
        let units = |text: &str| text.to_owned();
        let units = Units { length: units("mm"), force: units("N"), time: units("s"), mass: units("t") };
        judge(
            &request,
            &units,
            Evidence {
                points: &points,
                errors: errors.as_ref(),
                driven: self.driven.as_deref(),
                unfinished: self.unfinished,
            },
        )
    }

    /// Errors from the control runs.
    fn estimated(&self, request: &ResolvedSweep, points: &[Point]) -> ErrorEstimate {
        let trial = |&(index, level, repeats): &(usize, f64, bool)| {
            let mut point = self.points[index].clone();
            point["responses"] = responses(level);
            point["settling"] = json!({"verdict": if repeats { "periodic" } else { "aperiodic" }});
            let trial = json!({
                "point": point, "unknowns": 1, "lines": [[0.0]], "levels": [], "history": [], "samples_per_revolution": 1,
                "cost": {"set_up_s": 0.0, "per_revolution_s": 0.0, "repetitions": 1},
            });
            serde_json::from_value::<Trial>(trial).unwrap()
        };
        let trials: Vec<Trial> = self.controls.iter().map(trial).collect();
        let setting = Setting {
            modes_per_speed: 80,
            scheme: SchemeChoice::ExactModal,
            kept_modes: AutoOr::Auto,
            steps_per_revolution: 1000,
        };
        let spectra = SpeedSpectra { engine_orders: Vec::new(), sensors: Vec::new() };
        let finer = trials.iter().map(|trial| FinerRun {
            index: trial.point.index,
            setting,
            spectra: &spectra,
            trial,
        });
        error_estimate(request, None, points, &finer.collect::<Vec<_>>())
    }

    pub(super) fn word(&self) -> VerdictWord {
        self.verdict().verdict
    }

    /// Kinds of the open questions, each once.
    pub(super) fn open(&self) -> Vec<OpenKind> {
        let mut kinds: Vec<OpenKind> = self.verdict().would_decide.iter().map(|open| open.what).collect();
        kinds.sort_unstable();
        kinds.dedup();
        kinds
    }
}

/// Response of one sensor at a level.
fn responses(level: f64) -> Value {
    json!([{"sensor": {"contact_node": 0, "component": "radial"}, "mean": 0.0, "rms": level, "half_peak_to_peak": level}])
}

/// Range of a request, in rad/s.
pub(super) fn range(name: &str, from: f64, to: f64, separation_percent: f64) -> Value {
    json!({"name": name, "from": from, "to": to, "unit": "rad_s", "separation_percent": separation_percent})
}
