//! The Campbell diagram in the rotating frame.

use super::attributes::Scatter;
use super::document::{Figure, axis, speeds};
use super::marks::{line, marks, silent, strokes, words};
use super::palette::{NEUTRAL, WARNING, colour, dash};
use crate::campbell::{self as drawing, Curve, HIGHEST_ORDER, Ray};
use crate::cells::rpm;
use crate::marks::{driven_words, linear_words};
use rubmap_analysis::result::{Campbell, Wave};

/// Natural frequencies over speed, those of a nodal diameter under one name, with engine orders and both kinds of crossings.
pub fn campbell(campbell: &Campbell) -> Figure {
    let diagram = drawing::diagram(campbell);
    let (harmonics, _) = drawing::counts(campbell);
    let linear = drawing::linear(campbell, &diagram)
        .map(|(found, _)| ((rpm(found.speed_rad_s), found.frequency_hz), linear_words(found)));
    let driven = drawing::driven(campbell, &diagram)
        .map(|(found, _)| ((rpm(found.speed_rad_s), found.frequency_hz), driven_words(found)));
    let driven_name = format!("driven, k ≤ {HIGHEST_ORDER} (i, j)");
    let rings = ("circle-open", 10, NEUTRAL);
    Figure::new("campbell", "Campbell diagram", &drawing::words(campbell))
        .high(600)
        .with_all(rays(campbell, drawing::rays(campbell, &diagram)))
        .with_all(curves(harmonics, drawing::curves(campbell)))
        .with_all(marks("linear (i, j, n)", linear, rings))
        .with_all(marks(&driven_name, driven, ("diamond", 10, WARNING)))
        .axis("xaxis", speeds().range(<[f64; 2]>::from(diagram.x.values)))
        .axis(
            "yaxis",
            axis("natural frequency in the rotating frame, Hz").range(<[f64; 2]>::from(diagram.y.values)),
        )
        .meta("units", serde_json::json!({"x": "rpm", "y": "Hz"}))
        .meta("speeds_rpm", campbell.speeds_rad_s.iter().map(|speed| rpm(*speed)).collect::<Vec<f64>>())
}

/// Traces of the modes: dashes show the family, forward waves are thin.
fn curves(harmonics: usize, curves: Vec<Curve>) -> Vec<Scatter> {
    let mut named = vec![false; harmonics];
    let curve = |curve: Curve| {
        let (i, told) = (curve.nodal_diameter, curve.words());
        let width = if curve.wave == Some(Wave::Forward) { 0.9 } else { 1.8 };
        let name = format!("nodal diameter {i}");
        let count = curve.places.len();
        let told = curve.places.iter().map(|place| match place {
            Some((rpm, hz)) => format!("{told}: {rpm:.0} rpm, {hz:.1} Hz"),
            None => String::new(),
        });
        let told: Vec<String> = told.collect();
        let pen = (colour(i, harmonics), dash(curve.family.min(3)));
        let trace = words(line(&name, curve.places, (&pen.0, pen.1, width)), told);
        let first = count > 0 && !std::mem::replace(&mut named[i], true);
        trace.legendgroup(name).showlegend(first)
    };
    curves.into_iter().map(curve).collect()
}

/// Traces of the engine orders; those that the lobes excite have their numbers.
fn rays(campbell: &Campbell, rays: Vec<Ray>) -> Vec<Scatter> {
    let (excited, others): (Vec<Ray>, Vec<Ray>) = rays.into_iter().partition(|ray| ray.excited);
    let mut traces = Vec::new();
    if !others.is_empty() {
        let lines = strokes(others.iter().map(|ray| ray.ends));
        traces.push(silent("other engine orders", lines, ("#b0b0b0", "dot", 0.8)));
    }
    if !excited.is_empty() {
        let lines = strokes(excited.iter().map(|ray| ray.ends));
        let number = |ray: &Ray| if ray.numbered { ray.order.to_string() } else { String::new() };
        let numbers = excited.iter().flat_map(|ray| [String::new(), number(ray), String::new()]);
        let trace = silent(&drawing::excited_words(campbell), lines, (NEUTRAL, "solid", 1.0));
        traces.push(
            trace.mode("lines+text").text(numbers.collect::<Vec<String>>()).textposition("bottom left"),
        );
    }
    traces
}
