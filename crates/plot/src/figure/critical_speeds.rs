//! Critical speeds beside the linear prediction.

use serde_json::json;

use super::attributes::Scatter;
use super::document::{Figure, axis, speeds};
use super::marks::{bars, line, marks, strokes, words};
use super::palette::{CURVE, NEUTRAL, WARNING};
use crate::cells::rpm;
use crate::critical_speeds::{self as drawing, Kind, Row, linear_row, nearest_words, peak_words};
use crate::marks::known_to;
use crate::{map_view, validity};
use rubmap_analysis::result::{CriticalSpeed, CriticalSpeeds};

/// Peaks of the response over speed with their errors, and below them the crossings of the linear prediction, a row for each superharmonic;
/// each peak is tied to the crossing nearest to it. `customdata` of a peak is the index of its speed.
pub fn critical_speeds(critical: &CriticalSpeeds) -> Figure {
    let rows = drawing::rows(critical);
    let unit = critical.sensor.unit(&critical.units);
    let count = rows.len().max(1) as f64;
    let heights: Vec<f64> = (0..rows.len()).map(|row| row as f64).collect();
    let names: Vec<String> = rows.iter().map(|row| super::text::escaped(&row.name)).collect();
    let below = axis("").tickvals(heights).ticktext(names).range([count - 0.4, -0.6]).zeroline(false);
    let figure = Figure::new("critical_speeds", &drawing::title(critical), &drawing::words(critical))
        .high(420 + 34 * rows.len())
        .with_all(ties(critical, &rows))
        .with_all([true, false].into_iter().filter_map(|resolved| peaks(critical, resolved)))
        .with_all(validity::MARKED.into_iter().filter_map(|verdict| {
            let of = critical.critical_speeds.iter().filter(|peak| peak.validity == Some(verdict));
            let told =
                of.map(|peak| ((rpm(peak.speed_rad_s), peak.rms), validity::words(verdict).to_owned()));
            marks(validity::words(verdict), told, ("circle-open", 16, WARNING))
        }))
        .with_all(crossings(&rows))
        .axis("xaxis", speeds().anchor("y2"))
        .axis(
            "yaxis",
            axis(&format!("level at the peak, {unit} rms"))
                .rangemode("tozero")
                .domain([0.42, 1.0])
                .anchor("x"),
        )
        .axis("yaxis2", below.domain([0.0, 0.36]))
        .meta("sensor", critical.sensor)
        .meta("units", json!({"x": "rpm", "y": unit}))
        .meta("speed_indices", critical.critical_speeds.iter().map(|peak| peak.index).collect::<Vec<u32>>());
    match critical.critical_speeds.is_empty() {
        false => figure,
        true => figure.attribute(
            "annotations",
            json!([{"text": drawing::NONE, "xref": "paper", "yref": "paper", "x": 0.5, "y": 0.7, "showarrow": false}]),
        ),
    }
}

/// Trace of the peaks, open where the speeds of the sweep do not resolve them, with bars to the neighbouring speeds and of the level's
/// error.
fn peaks(critical: &CriticalSpeeds, resolved: bool) -> Option<Scatter> {
    let of: Vec<&CriticalSpeed> =
        critical.critical_speeds.iter().filter(|peak| peak.resolved == resolved).collect();
    let told = |peak: &&CriticalSpeed| {
        let nearest = nearest_words(peak).map(|words| format!("; {words}")).unwrap_or_default();
        let words = format!("{}{}{nearest}", peak_words(peak), known_to(peak));
        ((rpm(peak.speed_rad_s), peak.rms), words)
    };
    let (name, symbol) = match resolved {
        true => ("critical speed", "circle"),
        false => ("peak not resolved", "circle-open"),
    };
    let bars = |values: Vec<f64>| bars().array(values).color(CURVE).thickness(1.3).width(4);
    let speeds = of.iter().map(|peak| rpm(peak.speed_error_rad_s)).collect();
    let levels =
        of.iter().map(|peak| peak.amplitude_error.map_or(f64::NAN, |error| peak.rms * error)).collect();
    let trace =
        marks(name, of.iter().map(told), (symbol, 10, CURVE))?.error_x(bars(speeds)).error_y(bars(levels));
    Some(trace.customdata(of.iter().map(|peak| peak.index as usize).collect::<Vec<usize>>()))
}

/// Traces of the ties: from each peak down to its axis, and from there to the nearest crossing.
fn ties(critical: &CriticalSpeeds, rows: &[Row]) -> Vec<Scatter> {
    let tied = critical.critical_speeds.iter().filter_map(|peak| {
        let nearest = peak.nearest_crossing.as_ref()?;
        let row = rows.iter().position(|row| row.name == linear_row(nearest.superharmonic))?;
        Some((peak, rpm(nearest.speed_rad_s), row as f64, nearest_words(peak)?))
    });
    let tied: Vec<_> = tied.collect();
    if tied.is_empty() {
        return Vec::new();
    }
    let name = "to the nearest crossing";
    let down = tied.iter().map(|(peak, ..)| rpm(peak.speed_rad_s)).zip(&tied);
    let down = down.map(|(rpm, (peak, ..))| [(rpm, peak.rms), (rpm, 0.0)]);
    let across = tied.iter().map(|(peak, nearest, row, _)| [(rpm(peak.speed_rad_s), -0.6), (*nearest, *row)]);
    let told = tied.iter().flat_map(|(.., words)| vec![words.clone(); 3]).collect();
    let pen = || (NEUTRAL, "dot", 1.2);
    let across = words(line(name, strokes(across), pen()), told).yaxis("y2");
    let down = super::marks::silent(name, strokes(down), pen()).showlegend(false);
    vec![across.legendgroup(name), down.legendgroup(name)]
}

/// Traces of the crossings in their rows.
fn crossings(rows: &[Row]) -> Vec<Scatter> {
    let of = |kind: Kind| {
        let here = rows.iter().enumerate().filter(move |(_, row)| row.kind == kind);
        let told = here.flat_map(|(y, row)| {
            row.marks.iter().map(move |mark| ((mark.rpm, y as f64), mark.title.clone()))
        });
        let style = match kind {
            Kind::Linear => ("circle-open", 10, NEUTRAL),
            Kind::Driven => ("diamond", 10, map_view::DRIVEN),
            Kind::Casing => ("square", 9, "#009e73"),
        };
        Some(marks(kind.words(), told, style)?.yaxis("y2"))
    };
    [Kind::Linear, Kind::Driven, Kind::Casing].into_iter().filter_map(of).collect()
}
