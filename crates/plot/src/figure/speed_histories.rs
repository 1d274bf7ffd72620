//! Histories of one speed over its revolutions.

use super::document::{Figure, axis};
use super::marks::{line, template};
use super::palette::{CURVE, colour, dash};
use super::text::escaped;
use super::thinned;
use crate::cells::rpm;
use crate::speed_histories::{self as drawing, HistoryQuantity, NOT_RECORDED, REVOLUTIONS};
use rubmap_analysis::result::SpeedHistories;

/// Histories of one speed over revolutions. `index` counts sensors for displacements and velocities and contact nodes for forces; the
/// wheel's contact and energy have none.
pub fn speed_histories(histories: &SpeedHistories, what: HistoryQuantity, index: usize) -> Figure {
    let panels = drawing::panels(histories, what, index);
    let step = 1.0 / f64::from(histories.samples_per_revolution.max(1));
    let begin = f64::from(histories.revolutions[0]);
    let all: usize = panels.iter().map(|panel| panel.curves.len()).sum();
    let mut together = 1;
    let (mut traces, mut axes) = (Vec::new(), Vec::new());
    for (place, panel) in panels.iter().enumerate() {
        let (name, short) = match place {
            0 => ("yaxis".to_owned(), "y".to_owned()),
            _ => (format!("yaxis{}", place + 1), format!("y{}", place + 1)),
        };
        // Panels stand from the top down, with room between them.
        let height = 1.0 / panels.len() as f64;
        let foot = 1.0 - height * (place + 1) as f64;
        let room = if place + 1 < panels.len() { 0.05 } else { 0.0 };
        axes.push((name, axis(&panel.axis).domain([foot + room, foot + height])));
        for (index, curve) in panel.curves.iter().enumerate() {
            let at = |(j, value): (usize, &f64)| (begin + (j + 1) as f64 * step, *value);
            let (places, here) = thinned::thinned(curve.values.iter().enumerate().map(at).collect(), all);
            together = together.max(here);
            let count = panel.curves.len();
            let colour = if count == 1 { CURVE.to_owned() } else { colour(index, count) };
            let told = match curve.words.as_str() {
                "" => "%{x:.4f} revolutions: %{y:.4~g}".to_owned(),
                words => format!("{}<br>%{{x:.4f}} revolutions: %{{y:.4~g}}", escaped(words)),
            };
            let name = if curve.words.is_empty() { &panel.axis } else { &curve.words };
            let trace = line(name, places.into_iter().map(Some), (&colour, dash(index), 1.5));
            traces.push(trace.hovertemplate(template(&told)).yaxis(&short).showlegend(count > 1));
        }
    }
    let paragraphs: Vec<String> =
        [drawing::words(histories, what)].into_iter().chain(thinned::words(together)).collect();
    let figure = Figure::new("speed_histories", &drawing::title(histories, what, index), &paragraphs)
        .meta("speed_index", histories.index)
        .meta("speed_rpm", rpm(histories.speed_rad_s));
    if panels.is_empty() {
        return figure.empty(NOT_RECORDED);
    }
    let last = if panels.len() > 1 { format!("y{}", panels.len()) } else { "y".to_owned() };
    let figure = figure.high(360 + 140 * panels.len()).with_all(traces);
    let figure = axes.into_iter().fold(figure, |figure, (name, axis)| figure.axis(&name, axis));
    figure.axis("xaxis", axis(REVOLUTIONS).anchor(&last))
}
