//! Run-ups: amplitude of a sensor over the speed, at every rate.

use serde_json::json;

use super::attributes::{Marker, Scatter};
use super::document::{Figure, axis, speeds};
use super::marched::dots;
use super::marks::{line, marks, silent, words};
use super::palette::{NEUTRAL, colour};
use crate::run_up_line::{Line, Step};
use crate::run_up_words as told;
use crate::run_ups_view::{LISTED, NONE, View};
use rubmap_analysis::result::{Point, RunUps};

/// Half the peak-to-peak displacement of a sensor in the frames of every run over the rotational speed, a colour for each rate, broad where
/// something touches, with the largest of every run; `swept`: speeds of a sweep, as dots.
pub fn run_ups(run_ups: &RunUps, sensor: usize, swept: &[Point]) -> Figure {
    let view = View::new(run_ups, sensor, swept, ((0.0, 0.0), (1.0, 1.0)));
    let listed: Vec<usize> = view.listed().iter().map(|line| line.rank).collect();
    let more = view.shown().len() - listed.len();
    let mut paragraphs = told::words(run_ups);
    paragraphs
        .extend((more > 0).then(|| format!("{more} more runs between are named under the pointer only")));
    let figure = Figure::new("run_ups", &told::title(run_ups, sensor), &paragraphs)
        .meta("units", json!({"x": "rpm", "y": view.unit}))
        .meta("complete", run_ups.complete);
    if view.is_empty() {
        return figure.empty(if view.sensor.is_none() { "there is no such sensor" } else { NONE });
    }
    figure
        .high(560)
        .with_all(dots(&view.dots))
        .with_all(touching(&view))
        .with_all(view.shown().into_iter().rev().map(|of| line_of(&view, of, listed.contains(&of.rank))))
        .with_all(peaks(&view))
        .axis("xaxis", speeds().range(<[f64; 2]>::from(view.diagram.x.values)))
        .axis("yaxis", axis(&view.height()).range(<[f64; 2]>::from(view.diagram.y.values)))
        .meta("sensor", view.sensor)
        .meta("rates_rad_s2", view.lines.iter().map(|line| line.rate_rad_s2).collect::<Vec<_>>())
}

/// Trace of a run.
fn line_of(view: &View<'_>, of: &Line, is_listed: bool) -> Scatter {
    let told = of.steps.iter().map(|step| format!("{}: {}", of.title, step.words(view.unit))).collect();
    let places = of.steps.iter().map(|step| Some(step.over_speed()));
    let width = if view.lines.len() > LISTED { 1.2 } else { 2.0 };
    let pen = (&*colour(of.rank, view.lines.len()), "solid", width);
    let trace = words(line(&of.name, places, pen), told).showlegend(is_listed).legendgroup(group(of));
    // A line through one point is invisible.
    if of.steps.len() == 1 { trace.mode("lines+markers") } else { trace }
}

/// Broad traces of the stretches in contact; the first of them explains the width in the legend.
fn touching(view: &View<'_>) -> Vec<Scatter> {
    const WIDTH: u16 = 8;
    let touching: Vec<&Line> =
        view.shown().into_iter().filter(|line| line.touching().next().is_some()).collect();
    let trace = |(index, of): (usize, &&Line)| {
        let stretch = |steps: &[Step]| {
            let places: Vec<_> = steps.iter().map(|step| Some(step.over_speed())).collect();
            places.into_iter().chain([None])
        };
        let colour = colour(of.rank, view.lines.len());
        let pen = (&*colour, "solid", f64::from(WIDTH));
        let trace = silent("something touches", of.touching().flat_map(stretch), pen).opacity(0.3);
        let trace = trace.legendgroup(group(of)).showlegend(index == 0);
        let has_one_alone = of.touching().any(|steps| steps.len() == 1);
        if has_one_alone {
            trace.mode("lines+markers").marker(Marker::default().size(f64::from(WIDTH)).color(colour))
        } else {
            trace
        }
    };
    touching.iter().enumerate().map(trace).collect()
}

/// Legend group of a run: its traces are shown and hidden together.
fn group(of: &Line) -> String {
    format!("run {}", of.rank)
}

/// Marks of the largest amplitude of each run.
fn peaks(view: &View<'_>) -> Option<Scatter> {
    let of = view.lines.iter().filter_map(|line| {
        let step = line.largest?;
        Some((step.over_speed(), format!("largest of {}: {}", line.title, step.words(view.unit))))
    });
    marks("largest half peak-to-peak", of, ("circle-open", 10, NEUTRAL))
}
