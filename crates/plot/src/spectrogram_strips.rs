//! Curves above the spectrogram of a run.

use super::axis::{label, ticks};
use super::diagram::Diagram;
use super::labels::{Labels, traced};
use super::run_up_line::{Line, Step};
use super::spectrogram_view::{Over, View};
use super::svg::{Element, group, polyline};
use rubmap_analysis::result::RunUps;

/// Number of steps of a curve: what a screen shows.
const STEPS: usize = 3_000;

const COLOUR: &str = "#1f4e79";

/// Curve above the map.
pub(super) struct Strip {
    pub(super) axis: String,
    pub(super) y: (f64, f64),
    pub(super) places: Vec<(f64, f64)>,
    /// Points that stand out, with words.
    pub(super) marks: Vec<((f64, f64), String)>,
}

/// Curves above a spectrogram: the amplitude of the sensor; over time the speed as well.
pub(super) fn strips(run_ups: &RunUps, view: &View<'_>, sensor: usize) -> Vec<Strip> {
    let curves = Line::of(view.run, sensor, 0, STEPS);
    let along = |step: &Step| match view.over {
        Over::Speed => step.rpm,
        Over::Time => step.time_s,
    };
    let strip = |axis: String, value: fn(&Step) -> f64, marked: Option<Step>| {
        let places: Vec<(f64, f64)> = curves.steps.iter().map(|step| (along(step), value(step))).collect();
        let highest = places.iter().map(|place| place.1).fold(0.0, f64::max);
        let y = (0.0, if highest > 0.0 { (1.15 * highest).min(f64::MAX) } else { 1.0 });
        let marks =
            marked.iter().map(|step| ((along(step), value(step)), format!("{} rpm", label(step.rpm, 0))));
        Strip { axis, y, places, marks: marks.collect() }
    };
    let unit = view.sensor.unit(&run_ups.units);
    let swing = strip(format!("½ p–p, {unit}"), |step| step.half_peak_to_peak, curves.largest);
    let speed = (view.over == Over::Time).then(|| strip("Ω, rpm".to_owned(), |step| step.rpm, None));
    speed.into_iter().chain([swing]).collect()
}

impl Strip {
    /// Draws the curve with its axis to the left.
    pub(super) fn draw(&self, diagram: &Diagram) -> Element {
        let y = ticks(diagram.y.values, 3.0);
        let curve = polyline(self.places.iter().map(|(x, y)| diagram.inside(*x, *y)));
        let mut labels = Labels::inside(diagram);
        let line = traced(self.places.iter().filter_map(|(x, y)| diagram.inside(*x, *y)));
        let marks = self.marks.iter().filter_map(|((x, y), words)| {
            let at = diagram.inside(*x, *y)?;
            let dot = Element::new("circle").number("cx", at.0).number("cy", at.1).number("r", 3.2);
            let label = labels.beside_off(&line, at, 5.0, words, 11.0);
            let mark = group().set("class", "peak").child(dot.set("fill", COLOUR).title(words));
            Some(mark.children(label.map(|label| label.rimmed("white"))))
        });
        let marks: Vec<Element> = marks.collect();
        group()
            .child(diagram.background("white"))
            .child(diagram.grid(&ticks(diagram.x.values, 9.0), &y))
            .child(curve.set("class", "curve").set("stroke", COLOUR).set("stroke-width", "1.6"))
            .children(marks)
            .child(diagram.frame())
            .child(diagram.y_axis(&y, &self.axis, 64.0))
    }
}
