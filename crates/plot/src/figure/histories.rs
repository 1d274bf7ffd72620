//! Displacements over the first revolutions, one line per size.

use super::document::{Figure, axis};
use super::marks::{line, template};
use super::palette::{NEUTRAL, colour, dash};
use super::text::escaped;
use super::thinned;
use crate::cells::rpm;
use crate::histories as drawing;
use rubmap_analysis::run::Histories;

/// Displacements of the sensor of index `sensor` over revolutions, one line per size of the model; the reference is thin and grey over the
/// others.
pub fn histories(histories: &Histories, sensor: usize) -> Figure {
    let curves = drawing::curves(histories, sensor);
    let step = 1.0 / f64::from(histories.samples_per_revolution.max(1));
    let mut together = 1;
    let mut traces = Vec::new();
    for (index, curve) in curves.iter().enumerate() {
        let place = |(j, value): (usize, &f64)| ((j + 1) as f64 * step, *value);
        let (places, here) =
            thinned::thinned(curve.displacement.iter().enumerate().map(place).collect(), curves.len());
        together = together.max(here);
        let colour = colour(index, curves.len());
        let pen = match curve.line.reference {
            true => (NEUTRAL, "solid", 1.0),
            false => (colour.as_str(), dash(index), 2.2),
        };
        let told = format!("{}<br>%{{x:.4f}} revolutions: %{{y:.4~g}}", escaped(&curve.title()));
        traces.push(line(&curve.size(), places.into_iter().map(Some), pen).hovertemplate(template(&told)));
    }
    let paragraphs: Vec<String> =
        [drawing::words(histories)].into_iter().chain(thinned::words(together)).collect();
    let figure = Figure::new("histories", &drawing::title(histories, sensor), &paragraphs)
        .meta("sensor", histories.sensors.get(sensor))
        .meta("speed_rpm", rpm(histories.speed_rad_s));
    if curves.is_empty() {
        return figure.empty(drawing::NOT_COMPLETED);
    }
    figure
        .high(520)
        .with_all(traces)
        .axis("xaxis", axis("revolutions"))
        .axis("yaxis", axis(&drawing::axis(histories, sensor)))
}
