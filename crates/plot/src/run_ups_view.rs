//! Contents of run-ups over the speed.

use super::cells::rpm;
use super::marched::{self, Dot};
use super::run_up_line::Line;
use rubmap_analysis::request::{RunUpSpeed, Sensor};
use rubmap_analysis::result::{Point, RunUp, RunUps};

/// Approximate number of steps of all lines together: what a screen shows.
const STEPS: usize = 24_000;

/// Least number of steps of a line.
const LEAST_STEPS: usize = 200;

/// Largest number of runs that a key lists, and whose largest amplitudes have labels.
pub(super) const LISTED: usize = 12;

/// Message where there is no frame.
pub(super) const NONE: &str = "no frame of a run can be drawn";

/// Envelopes of all runs, with speeds of a sweep beside them.
pub(super) struct View<'a> {
    pub(super) sensor: Option<&'a Sensor>,
    pub(super) unit: &'a str,
    /// Ranges of speeds and amplitudes.
    pub(super) x: (f64, f64),
    pub(super) y: (f64, f64),
    /// Lines of the runs, the slowest first.
    pub(super) lines: Vec<Line>,
    pub(super) dots: Vec<Dot>,
}

impl<'a> View<'a> {
    /// Reads the runs at the sensor of this index.
    pub(super) fn new(run_ups: &'a RunUps, index: usize, swept: &[Point]) -> Self {
        let sensor = run_ups.sensors.get(index);
        let unit = sensor.map_or("", |sensor| sensor.unit(&run_ups.units));
        let mut runs: Vec<&RunUp> = run_ups.runs.iter().collect();
        runs.sort_by(|a, b| rate(a).total_cmp(&rate(b)).then(a.run.cmp(&b.run)));
        let most = (STEPS / runs.len().max(1)).max(LEAST_STEPS);
        let line = |(rank, run): (usize, &&RunUp)| Line::of(run, index, rank, most);
        let lines: Vec<Line> = runs.iter().enumerate().map(line).collect();
        let x = speeds(&run_ups.settings.speed, &lines);
        let dots = sensor.map_or_else(Vec::new, |sensor| marched::dots(swept, sensor, unit, x));
        let swings = lines.iter().filter_map(|line| Some(line.largest?.half_peak_to_peak));
        let highest = swings.chain(dots.iter().map(|dot| dot.place.1)).fold(0.0, f64::max);
        let y = (0.0, if highest > 0.0 { (1.1 * highest).min(f64::MAX) } else { 1.0 });
        Self { sensor, unit, x, y, lines, dots }
    }

    /// Whether there is no line to draw.
    pub(super) fn is_empty(&self) -> bool {
        self.lines.iter().all(|line| line.steps.is_empty())
    }

    /// Lines that have steps.
    pub(super) fn shown(&self) -> Vec<&Line> {
        self.lines.iter().filter(|line| !line.steps.is_empty()).collect()
    }

    /// Lines that the key lists: if there are more than [`LISTED`], evenly from the slowest to the fastest.
    pub(super) fn listed(&self) -> Vec<&Line> {
        let shown = self.shown();
        let rows = shown.len().min(LISTED);
        let of = |row: usize| shown[row * (shown.len() - 1) / rows.saturating_sub(1).max(1)];
        (0..rows).map(of).collect()
    }

    /// Title of the vertical axis.
    pub(super) fn height(&self) -> String {
        match self.unit {
            "" => "half peak to peak".to_owned(),
            unit => format!("half peak to peak, {unit}"),
        }
    }
}

fn rate(run: &RunUp) -> f64 {
    run.rate_rad_s2.unwrap_or(0.0)
}

/// Range of the requested speeds and of those that were run, in rpm.
fn speeds(asked: &RunUpSpeed, lines: &[Line]) -> (f64, f64) {
    let through = asked.points.iter().flatten().map(|point| point.speed);
    let asked = asked.from.into_iter().chain(asked.to).chain(through).map(rpm);
    let run = lines.iter().flat_map(|line| &line.steps).map(|step| step.rpm);
    let (low, high) = asked
        .chain(run)
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), speed| (low.min(speed), high.max(speed)));
    match low <= high {
        true if high - low > 1e-6 * high => (low, high),
        true => (0.99 * low, 1.01 * high.max(1.0)),
        false => (0.0, 1.0),
    }
}
