//! Spectra of one speed.

use serde_json::json;

use super::attributes::{Axis, Scatter};
use super::document::{Figure, axis};
use super::marks::{bars, marks};
use super::palette::{CURVE, colour, symbol};
use crate::axis::label;
use crate::cells::rpm;
use crate::spectrum::{self as drawing, Frame, Lines, MOST, Shown};
use rubmap_analysis::result::{Point, SensorSpectrum, SpeedSpectra};
use rubmap_wheel::dynamics::sector::Units;

/// Spectra of the sensor of index `sensor` at one speed: in the rotating frame its amplitude above those of the wheel's nodal diameters, in
/// the fixed frame the latter where they may be seen, a name for each nodal diameter. Amplitudes are logarithmic over four decades.
pub(crate) fn spectrum(
    spectra: &SpeedSpectra,
    point: &Point,
    units: &Units,
    sensor: usize,
    frame: Frame,
) -> Figure {
    let Some(found) = spectra.sensors.get(sensor) else {
        let title = format!("Spectrum, {} rpm", label(rpm(point.speed_rad_s), 0));
        return Figure::new("spectrum", &title, &[]).empty(&format!("there is no sensor of index {sensor}"));
    };
    let unit = found.sensor.unit(units);
    let lines = Lines::of(spectra, found, frame);
    let shown = lines.shown();
    let mut words = drawing::words(point, frame);
    words.extend(
        shown
            .as_ref()
            .filter(|shown| !shown.all)
            .map(|_| format!("the {} largest lines", label(MOST as f64, 0))),
    );
    let figure = Figure::new("spectrum", &drawing::title(point, found, frame), &words)
        .meta("sensor", found.sensor)
        .meta("units", json!({"x": "engine_order", "y": unit}))
        .meta("speed_index", point.index)
        .meta("speed_rpm", rpm(point.speed_rad_s));
    let Some(shown) = shown else { return figure.empty(drawing::ALL_STILL) };
    let x = axis(lines.axis()).range([0.0, lines.widest() + 0.5]);
    let y = upwards(&format!("nodal diameters, {unit}"), shown.range);
    let figure = figure.high(if frame == Frame::Rotating { 680 } else { 520 });
    let figure = figure.with_all(by_diameter(&lines, &shown, point, unit));
    match (frame, drawing::whole_lines(spectra, found)) {
        (Frame::Rotating, Some((range, largest))) => {
            let y2 = upwards(&format!("amplitude, {unit}"), range).domain([0.56, 1.0]).anchor("x");
            figure
                .with_all(whole(found, &largest, range.0, point, unit))
                .axis("xaxis", x.anchor("y"))
                .axis("yaxis", y.domain([0.0, 0.47]))
                .axis("yaxis2", y2)
        }
        _ => figure.axis("xaxis", x).axis("yaxis", y),
    }
}

/// Logarithmic axis of amplitudes.
fn upwards(title: &str, range: (f64, f64)) -> Axis {
    axis(title).kind("log").range([range.0.log10(), range.1.log10()]).exponentformat("e")
}

/// Frequency of a line seen at this multiple of the rotational frequency, in words that follow others.
fn hertz(order: f64, point: &Point) -> String {
    format!(", {} Hz", label(order * rpm(point.speed_rad_s) / 60.0, 1))
}

/// Adds stems down to the foot of the axis, drawn as error bars with one end there.
fn stems(trace: Scatter, heights: Vec<f64>, foot: f64, colour: &str) -> Scatter {
    let down: Vec<f64> = heights.iter().map(|height| height - foot).collect();
    let bars = bars().array(vec![0.0; heights.len()]).arrayminus(down).symmetric(false);
    trace.error_y(bars.color(colour.to_owned()).thickness(1.5).width(0))
}

/// Trace of the sensor itself.
fn whole(
    found: &SensorSpectrum,
    lines: &[(f64, f64)],
    foot: f64,
    point: &Point,
    unit: &str,
) -> Option<Scatter> {
    let told = |(order, amplitude): &(f64, f64)| {
        let words = drawing::whole_words(*order, *amplitude, unit);
        ((*order, *amplitude), format!("{words}{}", hertz(*order, point)))
    };
    let trace = marks(&found.sensor.to_string(), lines.iter().map(told), (symbol(0, true), 4, CURVE))?;
    Some(stems(trace, lines.iter().map(|line| line.1).collect(), foot, CURVE).yaxis("y2"))
}

/// Traces of the lines of every nodal diameter, one for each direction of travel.
fn by_diameter(lines: &Lines, shown: &Shown, point: &Point, unit: &str) -> Vec<Scatter> {
    let of = |(i, forward): (usize, bool)| {
        let here = shown.lines.iter().filter(|line| line.nodal_diameter == i && line.forward == forward);
        let heights: Vec<f64> = here.clone().map(|line| line.amplitude).collect();
        let told = here.map(|line| {
            let words = format!("{}{}", lines.words(line, unit), hertz(line.seen, point));
            ((line.seen, line.amplitude), words)
        });
        let colour = colour(i, lines.harmonics);
        let name =
            if forward { format!("nodal diameter {i}") } else { format!("nodal diameter {i}, |k−n|") };
        let trace = marks(&name, told, (symbol(i, forward), 8, &colour))?;
        Some(stems(trace, heights, shown.range.0, &colour))
    };
    (0..lines.harmonics).flat_map(|i| [(i, true), (i, false)]).filter_map(of).collect()
}
