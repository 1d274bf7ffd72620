//! Campbell diagram as seen from beside the wheel.

use super::attributes::Scatter;
use super::document::{Figure, axis, speeds};
use super::marks::{line, marks, words};
use super::palette::{NEUTRAL, colour};
use crate::campbell_fixed_frame::{self as drawing, Curve, Seen};
use crate::cells::rpm;
use crate::marks::linear_words;
use rubmap_analysis::result::Campbell;

/// Frequencies at which waves of the wheel are seen from beside it, over speed; those of a nodal diameter are under one name. Where a line
/// falls to zero the wave stands still before the casing.
pub fn campbell_fixed_frame(campbell: &Campbell) -> Figure {
    let curves = drawing::curves(campbell);
    let diagram = drawing::diagram(campbell, &curves, 0.0);
    let standing = campbell.crossings.iter().filter_map(|crossing| {
        let place = (rpm(crossing.speed_rad_s), 0.0);
        diagram.inside(place.0, place.1).map(|_| (place, linear_words(crossing)))
    });
    let mut paragraphs = drawing::words(campbell);
    paragraphs.extend(kinds(&curves));
    Figure::new("campbell_fixed_frame", drawing::TITLE, &paragraphs)
        .high(640)
        .with_all(traces(campbell, &curves))
        .with_all(marks("stands still: (i, j, n)", standing, ("circle-open", 10, NEUTRAL)))
        .axis("xaxis", speeds().range(<[f64; 2]>::from(diagram.x.values)))
        .axis("yaxis", axis("frequency in the fixed frame, Hz").range(<[f64; 2]>::from(diagram.y.values)))
        .meta("units", serde_json::json!({"x": "rpm", "y": "Hz"}))
        .meta("speeds_rpm", campbell.speeds_rad_s.iter().map(|speed| rpm(*speed)).collect::<Vec<f64>>())
}

/// Line style for each kind of wave.
fn pen(seen: Seen) -> (&'static str, f64, &'static str) {
    match seen {
        Seen::Backward => ("solid", 1.8, "drawn through"),
        Seen::Forward => ("solid", 0.7, "thin"),
        Seen::Superharmonic(n) if n % 2 == 0 => ("dash", 1.0, "dashed"),
        Seen::Superharmonic(_) => ("dot", 1.0, "dotted"),
    }
}

/// Words for the kinds of waves that have lines, a paragraph each.
fn kinds(curves: &[Curve]) -> Vec<String> {
    let mut kinds: Vec<Seen> = Vec::new();
    for curve in curves {
        if !kinds.contains(&curve.seen) {
            kinds.push(curve.seen);
        }
    }
    kinds.into_iter().map(|seen| format!("{}: {}", pen(seen).2, seen.words())).collect()
}

fn traces(campbell: &Campbell, curves: &[Curve]) -> Vec<Scatter> {
    let mut named: Vec<usize> = Vec::new();
    let trace = |curve: &Curve| {
        let (i, told, (dash, width, _)) = (curve.nodal_diameter, curve.words(), pen(curve.seen));
        let places = curve.places(campbell);
        let told = places.iter().map(|place| match place {
            Some((rpm, hz)) => format!("{told}: {rpm:.0} rpm, {hz:.1} Hz"),
            None => String::new(),
        });
        let told = told.collect();
        let name = format!("nodal diameter {i}");
        let trace = words(line(&name, places, (&colour(i, curve.harmonics), dash, width)), told);
        let first = !named.contains(&i);
        if first {
            named.push(i);
        }
        trace.legendgroup(name).showlegend(first)
    };
    curves.iter().map(trace).collect()
}
