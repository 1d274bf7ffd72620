//! Run-ups as they are stored and run.

use serde::Serialize;

use crate::error::Violation;
use crate::request::{
    AutoOr, HIGHEST_SPEED, LOWEST_SPEED, RunUpSettings, RunUpSpeed, SpeedCourse, SpeedPoint, SpeedUnit,
};
use crate::resolved::sweep::ResolvedSweep;
use rubmap_wheel::dynamics::run_up::profile::SpeedProfile;

/// Run-ups: a scene whose speed changes; written as [`RunUpSettings`].
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(into = "RunUpSettings")]
pub struct ResolvedRunUps {
    pub(crate) sweep: ResolvedSweep,
    pub(crate) speed: ResolvedCourse,
    pub(crate) euler_force: bool,
    pub(crate) angle_tolerance_rad: f64,
    pub(crate) frame_revolutions: AutoOr,
    pub(crate) limit: Option<f64>,
}

/// Course of the speed, in rad/s.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum ResolvedCourse {
    /// One run for each rate; rates have no sign.
    Rates { from: f64, to: f64, rates: Vec<f64>, hold_s: f64 },
    /// One run through points of time and speed.
    Points { points: Vec<(f64, f64)>, course: SpeedCourse },
}

/// Largest number of frames of a run where their length is chosen.
const FRAMES: u64 = 1000;

/// Revolutions of a frame where their number is chosen; longer frames are multiples of it.
pub(crate) const FRAME: u64 = 8;

/// Shortest time in which a speed changes, s: a shorter one is a jump.
const SHORTEST_S: f64 = 1e-6;

/// Largest number of runs, and of points of a run.
const RUNS: usize = 100;
const POINTS: usize = 10_000;

impl ResolvedRunUps {
    /// Reads run-ups that were resolved and stored before.
    ///
    /// # Errors
    /// Violations, if the run-ups were never resolved.
    pub fn stored(written: RunUpSettings) -> Result<Self, Vec<Violation>> {
        let RunUpSettings { sweep, speed, euler_force, angle_tolerance_rad, frame_revolutions, limit } =
            written;
        let (sweep, speed) = (ResolvedSweep::stored(sweep, 0)?, ResolvedCourse::of(speed)?);
        Ok(Self { sweep, speed, euler_force, angle_tolerance_rad, frame_revolutions, limit })
    }

    /// Scene at the lowest and the highest speed, as a sweep.
    pub fn sweep(&self) -> &ResolvedSweep {
        &self.sweep
    }

    /// Whether the Euler force acts.
    pub fn has_euler_force(&self) -> bool {
        self.euler_force
    }

    /// Number of runs.
    pub fn runs(&self) -> u32 {
        self.speed.runs()
    }

    /// Revolutions of a frame, in a run of so many `revolutions`.
    pub(crate) fn frame_revolutions(&self, revolutions: f64) -> u64 {
        match self.frame_revolutions {
            AutoOr::Fixed(frame) => u64::from(frame),
            AutoOr::Auto => FRAME * ((revolutions as u64).div_ceil(FRAME * FRAMES)).max(1),
        }
    }
}

impl ResolvedCourse {
    /// Reads the course that is asked for; violations have pointers into the field `speed` of a request.
    pub(crate) fn of(asked: RunUpSpeed) -> Result<Self, Vec<Violation>> {
        let RunUpSpeed { unit, from, to, rates, hold_s, points, course } = asked;
        let unit = unit.rad_s();
        let mut found = Vec::new();
        let mut require = |holds: bool, pointer: &str, message: String| {
            if !holds {
                found.push(Violation::new(format!("/speed{pointer}"), message));
            }
        };
        let plausible = |speed: f64| (LOWEST_SPEED..=HIGHEST_SPEED).contains(&(speed * unit));
        let words = || format!("a speed between {LOWEST_SPEED:e} and {HIGHEST_SPEED:e} rad/s");
        let resolved = match (points, rates) {
            (Some(points), None) => {
                for (given, pointer) in
                    [(from.is_some(), "/from"), (to.is_some(), "/to"), (hold_s.is_some(), "/hold_s")]
                {
                    require(!given, pointer, "belongs to `rates`: leave it away beside `points`".to_owned());
                }
                let count = (2..=POINTS).contains(&points.len());
                require(count, "/points", format!("2 to {POINTS} points"));
                for (index, point) in points.iter().enumerate().take(POINTS) {
                    require(plausible(point.speed), &format!("/points/{index}/speed"), words());
                    let before = index.checked_sub(1).map(|before| points[before].time_s);
                    let ascends =
                        before.map_or(point.time_s == 0.0, |before| point.time_s - before >= SHORTEST_S);
                    require(
                        ascends && point.time_s.is_finite(),
                        &format!("/points/{index}/time_s"),
                        format!(
                            "0 for the first point, then at least {SHORTEST_S} s later than the one before"
                        ),
                    );
                }
                let points = points.iter().map(|point| (point.time_s, point.speed * unit)).collect();
                Self::Points { points, course: course.unwrap_or_default() }
            }
            (None, Some(rates)) => {
                require(
                    course.is_none(),
                    "/course",
                    "belongs to `points`: leave it away beside `rates`".to_owned(),
                );
                for (speed, pointer) in [(from, "/from"), (to, "/to")] {
                    require(speed.is_some_and(plausible), pointer, words());
                }
                require(from != to, "/to", "another speed than `from`".to_owned());
                require((1..=RUNS).contains(&rates.len()), "/rates", format!("1 to {RUNS} rates"));
                for (index, rate) in rates.iter().enumerate().take(RUNS) {
                    let pointer = format!("/rates/{index}");
                    let positive = rate.is_finite() && *rate > 0.0;
                    require(
                        positive,
                        &pointer,
                        "above 0: `from` and `to` say whether the speed rises".to_owned(),
                    );
                    require(
                        !rates[..index].contains(rate),
                        &pointer,
                        format!("{rate} is in the list already"),
                    );
                    let change = (to.unwrap_or_default() - from.unwrap_or_default()).abs();
                    let lasts = !positive || change / rate >= SHORTEST_S;
                    require(lasts, &pointer, format!("the speed changes within less than {SHORTEST_S} s"));
                }
                let hold_s = hold_s.unwrap_or(0.0);
                require(hold_s.is_finite() && hold_s >= 0.0, "/hold_s", "a time, 0 or more".to_owned());
                let in_unit = |speed: Option<f64>| speed.unwrap_or_default() * unit;
                let rates = rates.iter().map(|rate| rate * unit).collect();
                Self::Rates { from: in_unit(from), to: in_unit(to), rates, hold_s }
            }
            _ => {
                let message = "give either `from`, `to` and `rates`, or `points`".to_owned();
                require(false, "", message);
                return Err(found);
            }
        };
        if found.is_empty() { Ok(resolved) } else { Err(found) }
    }

    /// Number of runs.
    pub(crate) fn runs(&self) -> u32 {
        match self {
            Self::Rates { rates, .. } => rates.len() as u32,
            Self::Points { .. } => 1,
        }
    }

    /// Rate of a run, rad/s², without a sign; none for a run through points.
    pub(crate) fn rate(&self, run: u32) -> Option<f64> {
        match self {
            Self::Rates { rates, .. } => Some(rates[run as usize]),
            Self::Points { .. } => None,
        }
    }

    /// Speed of a run over time, Ω(t).
    pub(crate) fn profile(&self, run: u32) -> SpeedProfile {
        match self {
            Self::Rates { from, to, rates, hold_s } => {
                let changes = (hold_s + (to - from).abs() / rates[run as usize], *to);
                if *hold_s > 0.0 {
                    SpeedProfile::linear(&[(0.0, *from), (*hold_s, *from), changes])
                } else {
                    SpeedProfile::linear(&[(0.0, *from), changes])
                }
            }
            Self::Points { points, course: SpeedCourse::Straight } => SpeedProfile::linear(points),
            Self::Points { points, course: SpeedCourse::Smooth } => SpeedProfile::smooth(points),
        }
    }

    /// Lowest and highest speed, rad/s.
    pub(crate) fn range(&self) -> (f64, f64) {
        let speeds: Vec<f64> = match self {
            Self::Rates { from, to, .. } => vec![*from, *to],
            Self::Points { points, .. } => points.iter().map(|(_, speed)| *speed).collect(),
        };
        speeds.into_iter().fold((f64::INFINITY, 0.0), |(low, high), speed| (low.min(speed), high.max(speed)))
    }
}

impl From<ResolvedCourse> for RunUpSpeed {
    fn from(course: ResolvedCourse) -> Self {
        let empty = Self {
            unit: SpeedUnit::RadS,
            from: None,
            to: None,
            rates: None,
            hold_s: None,
            points: None,
            course: None,
        };
        match course {
            ResolvedCourse::Rates { from, to, rates, hold_s } => {
                Self { from: Some(from), to: Some(to), rates: Some(rates), hold_s: Some(hold_s), ..empty }
            }
            ResolvedCourse::Points { points, course } => {
                let points = points.into_iter().map(|(time_s, speed)| SpeedPoint { time_s, speed }).collect();
                Self { points: Some(points), course: Some(course), ..empty }
            }
        }
    }
}

impl From<ResolvedRunUps> for RunUpSettings {
    fn from(run_ups: ResolvedRunUps) -> Self {
        let ResolvedRunUps { sweep, speed, euler_force, angle_tolerance_rad, frame_revolutions, limit } =
            run_ups;
        let (sweep, speed) = (sweep.into(), speed.into());
        Self { sweep, speed, euler_force, angle_tolerance_rad, frame_revolutions, limit }
    }
}
