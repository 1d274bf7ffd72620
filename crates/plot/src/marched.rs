//! Speeds of a sweep as dots beside results of another method.

use super::axis::{label, significant};
use super::branch_line::Place;
use super::cells::rpm;
use super::layer::{Mark, Marks};
use super::style::{Colour, Look, Symbol};
use rubmap_analysis::request::Sensor;
use rubmap_analysis::result::{Point, PointStatus, Verdict};

/// Flag whether a speed has settled, and the name of its dots.
const KINDS: [(bool, &str); 2] = [(true, "speed of the sweep"), (false, "the same, not settled")];

/// Dot of a speed of a sweep.
#[derive(Debug)]
pub(super) struct Dot {
    /// Speed in rpm, and half the peak-to-peak displacement.
    pub(super) place: Place,
    settled: bool,
    title: String,
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

/// Layers of the speeds of a sweep: of those that have settled, and of those that have not.
pub(super) fn layers(dots: &[Dot]) -> [Marks; 2] {
    KINDS.map(|(settled, name)| {
        let colour = Colour::neutral("#999999");
        let look = match settled {
            true => Look::filled(Symbol::Circle, (2.8, 6.0), colour).with("#999999", "#999999", 1.0),
            false => Look::open(Symbol::Circle, (2.8, 6.0), colour).with("white", "#999999", 1.0),
        };
        let here = dots.iter().filter(|dot| dot.settled == settled);
        Marks::new(name, look, here.map(|dot| Mark::new(dot.place, dot.title.clone()))).class("marched")
    })
}

/// Largest amplitude of the speeds that have settled.
pub(super) fn highest(dots: &[Dot]) -> Option<f64> {
    dots.iter().filter(|dot| dot.settled).map(|dot| dot.place.1).reduce(f64::max)
}
