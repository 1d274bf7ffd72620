//! Run-ups: amplitude of a sensor over the speed, at every rate.

use super::axis::{label, ticks};
use super::colour::{DISTINCT, ordinal};
use super::heading;
use super::key::{Key, MARK_WIDTH};
use super::labels::{Labels, traced};
use super::marched;
use super::run_up_line::{Line, Step};
use super::run_up_rates as rates;
use super::run_up_words as told;
use super::run_ups_view::{LISTED, NONE, View};
use super::svg::{Element, INK, document, group, line, polyline};
use rubmap_analysis::result::{Point, RunUps};

const WIDTH: f64 = 1180.0;
const LEFT: f64 = 92.0;
const SIZE: (f64, f64) = (800.0, 560.0);

/// Draws half the peak-to-peak displacement of a sensor in the frames of every run, over the rotational speed, a colour for each rate;
/// where something touches the line is broad, and its highest point has a ring. `swept`: speeds of a sweep, as dots. Runs of several rates
/// have their largest amplitudes over the rate in a small diagram beside.
pub fn run_ups(run_ups: &RunUps, sensor: usize, swept: &[Point]) -> String {
    let title = told::title(run_ups, sensor);
    let (heading, bottom) = heading::heading(LEFT, &title, &told::words(run_ups));
    let view = View::new(run_ups, sensor, swept, ((LEFT, bottom + 24.0), SIZE));
    let mut content = vec![heading];
    content.extend(draw(&view));
    document(&title, WIDTH, view.diagram.bottom() + 64.0, content)
}

fn draw(view: &View<'_>) -> Vec<Element> {
    let diagram = &view.diagram;
    let (x, y) = (ticks(diagram.x.values, 8.0), ticks(diagram.y.values, 8.0));
    let mut content = vec![diagram.grid(&x, &y)];
    content.extend(view.dots.iter().filter_map(|dot| {
        let place = diagram.inside(dot.place.0, dot.place.1)?;
        Some(marched::mark(place, dot.settled).title(&dot.title))
    }));
    content.extend(view.shown().into_iter().rev().map(|line| envelope(view, line)));
    content.push(peaks(view));
    let nothing = if view.sensor.is_none() { "there is no such sensor" } else { NONE };
    content.extend(view.is_empty().then(|| diagram.words(nothing)));
    content.push(diagram.frame());
    content.push(diagram.x_axis(&x, "rotational speed Ω, rpm"));
    content.push(diagram.y_axis(&y, &view.height(), 68.0));
    content.push(key(view));
    content.extend(rates::panel(view, (diagram.right() + 78.0, diagram.bottom() - 150.0), |line| {
        colour(view, line)
    }));
    content
}

/// Colour of a run, by its rate.
fn colour(view: &View<'_>, line: &Line) -> String {
    match view.lines.len() {
        1 => DISTINCT[0].to_owned(),
        count => ordinal(line.rank, count),
    }
}

fn place(view: &View<'_>, step: &Step) -> Option<(f64, f64)> {
    let (x, y) = step.over_speed();
    view.diagram.inside(x, y)
}

/// Draws the line of a run: broad where something touches.
fn envelope(view: &View<'_>, line: &Line) -> Element {
    let colour = colour(view, line);
    let dot = |step: &Step, radius: f64| {
        let at = place(view, step);
        at.map(|(x, y)| Element::new("circle").number("cx", x).number("cy", y).number("r", radius))
    };
    let broad = line.touching().filter_map(|stretch| {
        let mark = match stretch {
            [alone] => dot(alone, 3.5)?.set("fill", &colour),
            _ => polyline(stretch.iter().map(|step| place(view, step)))
                .set("stroke", &colour)
                .set("stroke-width", "7")
                .set("stroke-linejoin", "round")
                .set("stroke-linecap", "round"),
        };
        Some(mark.set("class", "contact").set("opacity", "0.3"))
    });
    let drawn = match &line.steps[..] {
        [alone] => dot(alone, 2.4).map(|dot| dot.set("fill", &colour)),
        steps => Some(pen(polyline(steps.iter().map(|step| place(view, step))), view, &colour)),
    };
    group().set("class", "run").children(broad).children(drawn).title(&line.title)
}

fn pen(stroke: Element, view: &View<'_>, colour: &str) -> Element {
    let width = if view.lines.len() > LISTED { "1.1" } else { "1.9" };
    stroke.set("stroke", colour).set("stroke-width", width).set("stroke-linejoin", "round")
}

fn ring((x, y): (f64, f64), colour: &str) -> Element {
    let ring = Element::new("circle").number("cx", x).number("cy", y).number("r", 4.2);
    ring.set("fill", "white").set("stroke", colour).set("stroke-width", "1.8")
}

/// Draws a ring where each run swings most, with the speed where there is room.
fn peaks(view: &View<'_>) -> Element {
    let mut found: Vec<(&Line, Step, (f64, f64))> = view
        .lines
        .iter()
        .filter_map(|line| Some((line, line.largest?, place(view, &line.largest?)?)))
        .collect();
    found.sort_by(|a, b| b.1.half_peak_to_peak.total_cmp(&a.1.half_peak_to_peak));
    let mut labels = Labels::inside(&view.diagram);
    for (.., at) in &found {
        labels.keep_off(*at, 5.0);
    }
    let lines = view.lines.iter().map(|line| line.steps.iter().filter_map(|step| place(view, step)));
    let lines: Vec<(f64, f64)> = lines.flat_map(traced).collect();
    let mut drawn = group();
    for (line, step, at) in &found {
        let words = format!("largest of {}: {}", line.title, step.words(view.unit));
        drawn = drawn.child(group().set("class", "peak").child(ring(*at, &colour(view, line))).title(&words));
    }
    for (line, step, at) in found.iter().take(if found.len() > LISTED { 1 } else { LISTED }) {
        let words = format!("{} rpm", label(step.rpm, 0));
        let label = labels.beside_off(&lines, *at, 7.0, &words, 11.0);
        drawn = drawn.children(label.map(|label| label.set("fill", colour(view, line)).rimmed("white")));
    }
    drawn
}

fn key(view: &View<'_>) -> Element {
    let shown = view.shown();
    let middle = (0.5 * MARK_WIDTH, 0.0);
    let stroke = || line((0.0, 0.0), (MARK_WIDTH, 0.0));
    let mut key = Key::new(view.diagram.right() + 24.0, view.diagram.top + 8.0);
    for run in view.listed() {
        key = key.row(pen(stroke(), view, &colour(view, run)), &run.name);
    }
    if shown.len() > LISTED {
        key = key.note(&format!("and {} more runs between", shown.len() - LISTED));
    }
    if shown.iter().any(|line| line.largest.is_some()) {
        key = key.row(group().child(ring(middle, INK)), "largest half peak-to-peak");
    }
    if shown.iter().any(|line| line.touching().next().is_some()) {
        let broad = stroke().set("stroke", INK).set("stroke-width", "7").set("stroke-linecap", "round");
        key = key.row(broad.set("opacity", "0.3"), "something touches");
    }
    for (settled, words) in marched::KINDS {
        if view.dots.iter().any(|dot| dot.settled == settled) {
            key = key.row(marched::mark(middle, settled), words);
        }
    }
    key.draw()
}
