//! Speeds of a sweep as dots beside results of another method.

use super::axis::{label, significant};
use super::branch_line::Place;
use super::cells::rpm;
use super::svg::Element;
use rubmap_analysis::request::Sensor;
use rubmap_analysis::result::{Point, PointStatus, Verdict};

const COLOUR: &str = "#999999";

/// Flag whether a speed has settled, and the name of its dots.
pub(super) const KINDS: [(bool, &str); 2] = [(true, "speed of the sweep"), (false, "the same, not settled")];

/// Dot of a speed of a sweep.
#[derive(Debug)]
pub(super) struct Dot {
    /// Speed in rpm, and half the peak-to-peak displacement.
    pub(super) place: Place,
    pub(super) settled: bool,
    pub(super) title: String,
}

/// Dots of a sensor at the completed speeds within a range in rpm.
pub(super) fn dots(points: &[Point], sensor: &Sensor, unit: &str, (slow, fast): (f64, f64)) -> Vec<Dot> {
    let dot = |point: &Point| {
        let response = point.responses.iter().find(|response| response.sensor == *sensor)?;
        let place = (rpm(point.speed_rad_s), response.half_peak_to_peak);
        let seen = (slow..=fast).contains(&place.0) && place.1.is_finite();
        let settled = point.settling.as_ref().is_none_or(|found| found.verdict != Verdict::NotSettled);
        let what = if settled { "" } else { ", not settled" };
        let words = format!("{} rpm", label(place.0, 0));
        let title = format!("of the sweep, {words}: {} {unit}{what}", significant(place.1));
        seen.then_some(Dot { place, settled, title })
    };
    points.iter().filter(|point| point.status == PointStatus::Completed).filter_map(dot).collect()
}

/// A dot at a place of the drawing, open if its speed has not settled.
pub(super) fn mark((x, y): Place, settled: bool) -> Element {
    let dot = Element::new("circle").number("cx", x).number("cy", y).number("r", 2.8).set("class", "marched");
    dot.set("stroke", COLOUR).set("fill", if settled { COLOUR } else { "white" })
}
