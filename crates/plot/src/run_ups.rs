//! Run-ups: amplitude of a sensor over the speed, at every rate.

use super::axis::label;
use super::colour::DISTINCT;
use super::drawing::Drawing;
use super::layer::{Curve, Mark, Marks, Stroke};
use super::marched;
use super::run_up_line::{Line, Step};
use super::run_up_rates as rates;
use super::run_up_words as told;
use super::run_ups_view::{LISTED, NONE, View};
use super::sketch::{Axis, Panel, Sketch};
use super::style::{Colour, Dash, Look, Pen, Symbol};
use super::svg::INK;
use rubmap_analysis::result::{Point, RunUps};
use serde_json::json;

/// Half the peak-to-peak displacement of a sensor in the frames of every run over the rotational speed, a colour for each rate; where
/// something touches the line is broad, and its highest point has a ring. `swept`: speeds of a sweep, as dots. In the drawing, runs of
/// several rates have their largest amplitudes over the rate in a small diagram beside.
pub fn run_ups(run_ups: &RunUps, sensor: usize, swept: &[Point]) -> Drawing<'static> {
    let view = View::new(run_ups, sensor, swept);
    let mut sketch = Sketch::new("run_ups", told::title(run_ups, sensor), told::words(run_ups));
    sketch = sketch.meta("units", json!({"x": "rpm", "y": view.unit})).meta("complete", run_ups.complete);
    if view.is_empty() {
        return sketch.nothing(if view.sensor.is_none() { "there is no such sensor" } else { NONE }).into();
    }
    let more = view.shown().len().saturating_sub(LISTED);
    sketch
        .more
        .extend((more > 0).then(|| format!("{more} more runs between are named under the pointer only")));
    let (x, y) = (Axis::speeds(view.x, 8.0), Axis::linear(view.height(), view.y, 8.0));
    let mut panel = Panel::new((92.0, sketch.top() + 24.0), (800.0, 560.0), x, y);
    fill(&view, &mut panel);
    let corner = (panel.diagram.right() + 78.0, panel.diagram.bottom() - 150.0);
    if let Some(rates) = rates::panel(&view, corner, |line| colour(&view, line).paper) {
        panel.push(rates);
    }
    let rates: Vec<_> = view.lines.iter().map(|line| line.rate_rad_s2).collect();
    sketch.with(panel).meta("sensor", view.sensor).meta("rates_rad_s2", rates).into()
}

/// Adds dots, lines and peaks, and their key.
fn fill(view: &View<'_>, panel: &mut Panel) {
    let [settled, unsettled] = marched::layers(&view.dots);
    let dots =
        [&settled, &unsettled].map(|dots| (dots.look.sample(), dots.name.clone(), dots.marks.is_empty()));
    panel.push(settled);
    panel.push(unsettled);
    let listed = view.listed();
    let shown = view.shown();
    let broad: Vec<Curve> = shown.iter().filter_map(|line| touching(view, line)).collect();
    let has_broad = !broad.is_empty();
    panel.layers.extend(broad.into_iter().map(Into::into));
    for line in shown.iter().rev() {
        let places = line.steps.iter().map(|step| Some(step.over_speed()));
        let each = line.steps.iter().map(|step| format!("{}: {}", line.title, step.words(view.unit)));
        let curve = Curve::new(&line.name, places, pen(view, line)).title(&line.title).each(each.collect());
        let curve = curve.class("run").group(group(line));
        let is_listed = listed.iter().any(|other| other.rank == line.rank);
        panel.push(if is_listed { curve } else { curve.unlisted() });
    }
    for line in &listed {
        panel.sample(pen(view, line).sample(), &line.name);
    }
    if shown.len() > LISTED {
        panel.note(&format!("and {} more runs between", shown.len() - LISTED));
    }
    panel.marks("largest half peak-to-peak", peaks(view));
    if has_broad {
        let broad = Pen::new(Colour::of(INK), Dash::Solid, 7.0).sample();
        panel.sample(broad.set("stroke-linecap", "round").set("opacity", "0.3"), TOUCHES);
    }
    for (sample, name, _) in dots.into_iter().filter(|(.., is_empty)| !is_empty) {
        panel.sample(sample, &name);
    }
}

const TOUCHES: &str = "something touches";

/// Colour of a run, by its rate.
fn colour(view: &View<'_>, line: &Line) -> Colour {
    match view.lines.len() {
        1 => Colour::of(DISTINCT[0]),
        count => Colour::ordinal(line.rank, count),
    }
}

fn pen(view: &View<'_>, line: &Line) -> Pen {
    Pen::new(colour(view, line), Dash::Solid, if view.lines.len() > LISTED { 1.2 } else { 2.0 })
}

/// Group of the legend of a run: its curves are shown and hidden together.
fn group(line: &Line) -> String {
    format!("run {}", line.rank)
}

/// Broad curve where something touches.
fn touching(view: &View<'_>, line: &Line) -> Option<Curve> {
    let stroke = |steps: &[Step]| Stroke {
        places: steps.iter().map(|step| Some(step.over_speed())).collect(),
        title: line.title.clone(),
    };
    let strokes: Vec<Stroke> = line.touching().map(stroke).collect();
    let pen = Pen { width: 7.0, ..pen(view, line) };
    let curve = Curve::of(TOUCHES, strokes, pen).class("contact").group(group(line));
    (!curve.strokes.is_empty()).then_some(Curve { opacity: 0.3, ..curve })
}

/// Marks of the largest amplitude of each run, the largest last, with the speed.
fn peaks(view: &View<'_>) -> Marks {
    let mut found: Vec<(&Line, Step)> =
        view.lines.iter().filter_map(|line| Some((line, line.largest?))).collect();
    found.sort_by(|a, b| b.1.half_peak_to_peak.total_cmp(&a.1.half_peak_to_peak));
    let labelled = if found.len() > LISTED { 1 } else { LISTED };
    let mark = |(place, (line, step)): (usize, &(&Line, Step))| {
        let words = format!("largest of {}: {}", line.title, step.words(view.unit));
        let label = if place < labelled { format!("{} rpm", label(step.rpm, 0)) } else { String::new() };
        let colour = Some(colour(view, line).paper);
        Mark { colour, ..Mark::new(step.over_speed(), words).label(label) }
    };
    let ring = Look::open(Symbol::Circle, (4.2, 10.0), Colour::neutral(INK)).with("white", INK, 1.8);
    Marks::new("largest half peak-to-peak", ring, found.iter().enumerate().rev().map(mark)).class("peak")
}
