//! Curves above the spectrogram of a run.

use super::axis::label;
use super::layer::{Curve, Mark, Marks};
use super::run_up_line::{Line, Step};
use super::sketch::{Axis, Panel};
use super::spectrogram_view::{Over, View};
use super::style::{Colour, Dash, Look, Pen, Symbol};
use rubmap_analysis::result::RunUps;

/// Number of steps of a curve: what a screen shows.
const STEPS: usize = 3_000;

/// Curve above the map.
pub(super) struct Strip {
    axis: String,
    y: (f64, f64),
    places: Vec<(f64, f64)>,
    /// Points that stand out, with words.
    marks: Vec<((f64, f64), String)>,
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
    /// Panel with the curve and its marks.
    pub(super) fn panel(self, x: Axis, corner: (f64, f64), size: (f64, f64)) -> Panel<'static> {
        let mut panel = Panel::new(corner, size, x, Axis::linear(&self.axis, self.y, 3.0));
        let pen = Pen::new(Colour::curve(), Dash::Solid, 1.6);
        let curve = Curve::new(&self.axis, self.places.into_iter().map(Some), pen).class("curve");
        panel.push(curve.over("", "%{x:.4~g}: %{y:.4~g}").unlisted());
        let look = Look::filled(Symbol::Circle, (3.2, 8.0), Colour::curve());
        let marks = self.marks.into_iter().map(|(place, words)| Mark::new(place, words.clone()).label(words));
        panel.push(Marks::new("largest", look, marks).class("peak").unlisted());
        panel
    }
}
