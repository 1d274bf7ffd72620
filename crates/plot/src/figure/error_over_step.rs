//! Errors over the time step: how fast a scheme converges.

use super::attributes::Marker;
use super::document::Figure;
use super::marks::{line, silent, words};
use super::palette::{NEUTRAL, dash};
use super::work_precision::{begin, logarithmic, mark, no_speed};
use crate::error_over_step::{self as drawing, Ladder, STEP, View, step};
use crate::scheme;
use crate::study_runs::{error_axis, extent, reason};
use rubmap_analysis::result::Quantity;
use rubmap_analysis::run::WorkPrecision;

/// Errors of one quantity over the time step at the speed of index `speed`, both on logarithmic axes: a line for each scheme and size of
/// the model, and beside them the slopes of first and second order.
pub fn error_over_step(study: &WorkPrecision, speed: usize, quantity: Quantity) -> Figure {
    let title = drawing::title(study, quantity);
    let Some(at) = study.speeds.get(speed) else { return no_speed("error_over_step", &title, speed) };
    let view = View::new(at, quantity, 0.0);
    let figure = begin("error_over_step", &title, (study, at), quantity);
    if view.ladders.is_empty() {
        return figure.empty(&reason(at, quantity));
    }
    let orders = view.orders().into_iter().enumerate().map(|(index, (ends, words))| {
        let dash = if index == 0 { "dot" } else { "dashdot" };
        silent(&format!("order {} ({words})", index + 1), ends.map(Some), (NEUTRAL, dash, 1.2))
    });
    let ladder = |ladder: &Ladder| {
        let rank = view.sizes.iter().position(|size| *size == ladder.modes_per_speed).unwrap_or(0);
        let colour = scheme::colour(ladder.scheme);
        let name = format!("{}, {} modes", scheme::words(ladder.scheme), ladder.modes_per_speed);
        let places = ladder.runs.iter().map(|drawn| Some((step(drawn), drawn.error)));
        let told = ladder.runs.iter().map(|drawn| drawn.title()).collect();
        let trace = words(line(&name, places, (colour, dash(rank), 1.6)), told);
        trace
            .mode("lines+markers")
            .marker(Marker::default().symbol(mark(ladder.scheme)).size(9.0).color(colour))
    };
    let runs = || view.ladders.iter().flat_map(|ladder| &ladder.runs);
    figure
        .with_all(orders)
        .with_all(view.ladders.iter().map(ladder))
        .axis("xaxis", logarithmic(STEP, extent(runs().map(step))))
        .axis("yaxis", logarithmic(&error_axis(quantity, study), extent(runs().map(|drawn| drawn.error))))
}
