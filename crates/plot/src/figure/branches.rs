//! Branches of periodic responses.

use serde_json::json;

use super::attributes::Scatter;
use super::document::{Figure, axis, speeds};
use super::marched::dots;
use super::marks::{line, marks, words};
use super::palette::NEUTRAL;
use crate::branch_line::{Fate, Place};
use crate::branches::{self as drawing, Curve, Mark, NONE, View};
use rubmap_analysis::request::BranchParameter;
use rubmap_analysis::result::{BifurcationKind, Branches, Point};

/// Amplitude of a sensor along branches, a line for the stable stretches of each and one for the unstable ones, with bifurcations and
/// maxima; `marched`: speeds of a sweep, as dots.
pub fn branches(branches: &Branches, sensor: usize, marched: &[Point]) -> Figure {
    let view = View::new(branches, sensor, marched, 0.0);
    let (title, told) = (drawing::title(branches, sensor), drawing::words(branches));
    let figure = Figure::new("branches", &title, &told)
        .meta("parameter", branches.head.parameter)
        .meta("units", json!({"x": view.over.unit(), "y": view.unit}))
        .meta("complete", branches.complete);
    if view.is_empty() {
        return figure.empty(if view.sensor.is_none() { "there is no such sensor" } else { NONE });
    }
    let x = match branches.head.parameter {
        BranchParameter::Speed => speeds(),
        _ => axis(view.over.axis()),
    };
    figure
        .high(560)
        .with_all(dots(&view.dots))
        .with_all(view.curves.iter().rev().flat_map(|curve| curves(&view, curve)))
        .with_all(Mark::ALL.into_iter().rev().filter_map(|mark| marked(&view, mark)))
        .axis("xaxis", x.range(<[f64; 2]>::from(view.diagram.x.values)))
        .axis("yaxis", axis(&view.height()).range(<[f64; 2]>::from(view.diagram.y.values)))
        .meta("sensor", view.sensor)
}

/// Traces of a branch, one for each stability.
fn curves(view: &View<'_>, curve: &Curve<'_>) -> Vec<Scatter> {
    let group = format!("branch {}", curve.branch.track.branch + 1);
    let of = |fate: Fate| {
        let runs = || curve.runs.iter().filter(|run| run.fate == fate);
        let at = |(place, point): &(Place, Option<usize>)| {
            let point = point.and_then(|index| curve.branch.points.get(index));
            (Some(*place), point.map_or_else(String::new, |point| view.point_words(curve.branch, point)))
        };
        let gap = || [(None, String::new())];
        let (places, told): (Vec<_>, Vec<_>) =
            runs().flat_map(|run| run.corners.iter().map(at).chain(gap())).unzip();
        let dash = match fate {
            Fate::Stable => "solid",
            Fate::Unstable => "dash",
            Fate::Undecided => "dot",
        };
        let width = if curve.branch.track.branch == 0 { 2.2 } else { 1.6 };
        let name = format!("{group}, {}", fate.words());
        let trace = words(line(&name, places, (curve.colour(), dash, width)), told);
        (runs().next().is_some()).then(|| trace.legendgroup(&group))
    };
    Fate::ALL.into_iter().filter_map(of).collect()
}

fn marked(view: &View<'_>, mark: Mark) -> Option<Scatter> {
    let (symbol, size) = match mark {
        Mark::Bifurcation(BifurcationKind::Fold) => ("triangle-up", 12),
        Mark::Bifurcation(BifurcationKind::Flip) => ("diamond", 11),
        Mark::Bifurcation(BifurcationKind::NeimarkSacker) => ("circle-open-dot", 12),
        Mark::Bifurcation(BifurcationKind::Branching) => ("square", 10),
        Mark::Maximum => ("circle-open", 10),
        Mark::End => ("x", 11),
    };
    let of = view.marked.iter().filter(|one| one.mark == mark);
    marks(mark.words(), of.map(|one| (one.place, one.title.clone())), (symbol, size, NEUTRAL))
}
