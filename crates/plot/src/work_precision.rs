//! Work and precision: error over computing time of every setting of a study.

use super::axis::{decades, label};
use super::cells::rpm;
use super::diagram::Diagram;
use super::heading::heading;
use super::key::{Key, MARK_WIDTH};
use super::labels::Labels;
use super::study_runs::{Drawn, error_axis, extent, left_out, origin, reason, words};
use super::svg::{Element, INK, group, line, polyline, text};
use super::{scheme, svg};
use rubmap_analysis::request::SchemeChoice;
use rubmap_analysis::result::{Quantity, SpeedStudy, front};
use rubmap_analysis::run::{Setting, WorkPrecision};
use rubmap_wheel::response::sensitivity::Growth;

const WIDTH: f64 = 1180.0;
const HEIGHT: f64 = 800.0;
const LEFT: f64 = 92.0;
const PLOT_WIDTH: f64 = 790.0;

/// Radii of the marks of the smallest and of the largest model.
const RADII: (f64, f64) = (3.6, 8.0);

/// Draws the errors of one quantity over computing time at the speed of index `speed`, both on logarithmic axes.
///
/// Every completed run is a mark: colour and shape say the scheme, its size the modes kept. A line joins those runs of a scheme
/// that no other run of it beats in time and error; rings and a step line are the Pareto front of all. Where trajectories are
/// chaotic, bars show the standard error of the amplitude. What has no place on logarithmic axes is counted below.
pub fn work_precision(study: &WorkPrecision, speed: usize, quantity: Quantity) -> String {
    let title = title(study, quantity);
    let Some(at) = study.speeds.get(speed) else {
        let (heading, _) = heading(LEFT, &title, &[format!("the study has no speed of index {speed}")]);
        return svg::document(&title, WIDTH, HEIGHT, vec![heading]);
    };
    let title = format!("{title}, {} rpm", label(rpm(at.speed_rad_s), 0));
    let (heading, bottom) = heading(LEFT, &title, &[at.message.clone(), origin(study, at)]);
    let view = View::new(study, at, quantity, bottom + 30.0);
    let mut content = vec![heading];
    content.extend(view.draw());
    svg::document(&title, WIDTH, HEIGHT, content)
}

/// Title: the quantity whose error is drawn.
pub(super) fn title(study: &WorkPrecision, quantity: Quantity) -> String {
    format!("Work and precision: {}", words(quantity, study))
}

/// Title of the horizontal axis.
pub(super) const TIME: &str = "CPU time of the whole run with set-up, without reduction, s";

/// Words for the Pareto front.
pub(super) const FRONT: &str = "no run is better in time and error";

/// Diagram of one quantity at one speed.
pub(super) struct View<'a> {
    study: &'a WorkPrecision,
    at: &'a SpeedStudy,
    quantity: Quantity,
    /// Whether bars show the standard error.
    pub(super) bars: bool,
    pub(super) runs: Vec<Drawn<'a>>,
    /// Modes per speed of the models, ascending.
    sizes: Vec<u32>,
    pub(super) diagram: Diagram,
}

impl<'a> View<'a> {
    /// Lays out the runs in a diagram that begins at `top`.
    pub(super) fn new(study: &'a WorkPrecision, at: &'a SpeedStudy, quantity: Quantity, top: f64) -> Self {
        let chaotic = at.sensitivity.is_some_and(|sensitivity| sensitivity.growth == Growth::Chaotic);
        let bars = chaotic && quantity == Quantity::Amplitude;
        let runs: Vec<Drawn> = at.runs.iter().filter_map(|run| Drawn::of(run, quantity)).collect();
        let mut sizes: Vec<u32> = at.runs.iter().map(|run| run.setting.modes_per_speed).collect();
        sizes.sort_unstable();
        sizes.dedup();
        let times = extent(runs.iter().map(|drawn| drawn.run.time_s));
        let tops = runs.iter().filter_map(|drawn| Some(drawn.error + drawn.spread.filter(|_| bars)?));
        let errors = extent(runs.iter().map(|drawn| drawn.error).chain(tops));
        let diagram = Diagram::logarithmic((LEFT, top), (PLOT_WIDTH, HEIGHT - 90.0 - top), times, errors);
        Self { study, at, quantity, bars, runs, sizes, diagram }
    }

    fn place(&self, drawn: &Drawn) -> (f64, f64) {
        self.diagram.point(drawn.run.time_s, drawn.error)
    }

    fn draw(&self) -> Vec<Element> {
        let diagram = &self.diagram;
        let note = text(LEFT, HEIGHT - 16.0, "start", &left_out(self.at, self.quantity));
        let note = note.set("class", "left-out").set("font-size", "12").set("fill", "#555555");
        if self.runs.is_empty() {
            return vec![diagram.frame(), diagram.words(&reason(self.at, self.quantity)), note];
        }
        let (x, y) = (decades(diagram.x.values, 14), decades(diagram.y.values, 20));
        let mut content = vec![diagram.grid(&x, &y), self.front_line()];
        content.extend(self.schemes().map(|scheme| self.scheme_line(scheme)));
        content.extend(self.runs.iter().filter_map(|drawn| self.bar(drawn)));
        // Small marks lie over large ones.
        for &size in self.sizes.iter().rev() {
            let here = self.runs.iter().filter(|drawn| drawn.run.setting.modes_per_speed == size);
            content.extend(here.map(|drawn| self.mark(drawn)));
        }
        content.extend(self.front().into_iter().map(|drawn| self.ring(drawn)));
        content.push(self.steps());
        content.extend([
            diagram.frame(),
            diagram.x_axis(&x, TIME),
            diagram.y_axis(&y, &error_axis(self.quantity, self.study), 64.0),
            self.key(),
            note,
        ]);
        content
    }

    /// Schemes that are in the drawing.
    pub(super) fn schemes(&self) -> impl Iterator<Item = SchemeChoice> {
        let drawn = |scheme: &SchemeChoice| self.runs.iter().any(|drawn| drawn.run.setting.scheme == *scheme);
        self.study.settings.grid.schemes.iter().copied().filter(drawn)
    }

    /// Radius of the marks of a model with these modes per speed.
    pub(super) fn radius(&self, modes_per_speed: u32) -> f64 {
        let rank = self.sizes.iter().position(|&size| size == modes_per_speed).unwrap_or(0);
        let steps = self.sizes.len().saturating_sub(1).max(1);
        RADII.0 + (RADII.1 - RADII.0) * rank as f64 / steps as f64
    }

    fn mark(&self, drawn: &Drawn) -> Element {
        let Setting { scheme, modes_per_speed, .. } = drawn.run.setting;
        scheme::mark(scheme, self.place(drawn), self.radius(modes_per_speed))
            .set("class", "run")
            .title(&drawn.title())
    }

    /// Bar from the standard error below the mark to that above it, cut off at the frame.
    fn bar(&self, drawn: &Drawn) -> Option<Element> {
        let (spread, x) = (drawn.spread.filter(|_| self.bars)?, self.place(drawn).0);
        let lowest = (drawn.error - spread).max(self.diagram.y.values.0);
        let (low, high) = (self.diagram.y.place(lowest), self.diagram.y.place(drawn.error + spread));
        let bar = line((x, low), (x, high)).set("class", "spread").set("stroke-width", "1.2");
        Some(bar.set("stroke", scheme::colour(drawn.run.setting.scheme)).set("stroke-opacity", "0.7"))
    }

    /// Runs of a scheme that no other run of the scheme beats in time and error, in ascending time.
    pub(super) fn unbeaten(&self, scheme: SchemeChoice) -> Vec<&Drawn<'a>> {
        let place = |drawn: &Drawn| {
            let here = drawn.run.setting.scheme == scheme;
            Some((drawn.run.time_s, drawn.run.errors.as_ref().filter(|_| here)?.judged(self.quantity)?))
        };
        let places: Vec<Option<(f64, f64)>> = self.runs.iter().map(place).collect();
        let mut own: Vec<&Drawn> = front(&places).into_iter().map(|index| &self.runs[index]).collect();
        own.sort_by(|a, b| a.run.time_s.total_cmp(&b.run.time_s));
        own
    }

    fn scheme_line(&self, scheme: SchemeChoice) -> Element {
        polyline(self.unbeaten(scheme).into_iter().map(|drawn| Some(self.place(drawn))))
            .set("class", "scheme")
            .set("stroke", scheme::colour(scheme))
            .set("stroke-width", "1.8")
    }

    /// Pareto front of all runs, in ascending time.
    pub(super) fn front(&self) -> Vec<&Drawn<'a>> {
        let on = |drawn: &&Drawn| drawn.run.pareto.contains(&self.quantity);
        let mut front: Vec<_> = self.runs.iter().filter(on).collect();
        front.sort_by(|a, b| a.run.time_s.total_cmp(&b.run.time_s));
        front
    }

    /// Labels with steps per revolution at the marks, where there is room.
    fn steps(&self) -> Element {
        let mut labels = Labels::inside(&self.diagram);
        for drawn in &self.runs {
            labels.keep_off(self.place(drawn), 0.8 * self.radius(drawn.run.setting.modes_per_speed));
        }
        let front = self.front();
        let others = self.runs.iter().filter(|drawn| !front.iter().any(|on| std::ptr::eq(*on, *drawn)));
        // Runs on the front have the first choice of room.
        let words = front.iter().copied().chain(others).filter_map(|drawn| {
            let steps = label(drawn.run.setting.steps_per_revolution.into(), 0);
            labels.beside(
                self.place(drawn),
                self.radius(drawn.run.setting.modes_per_speed) + 4.0,
                &steps,
                10.5,
            )
        });
        group().children(words.map(|label| label.set("fill", "#444444").rimmed("white")))
    }

    fn ring(&self, drawn: &Drawn) -> Element {
        let (x, y) = self.place(drawn);
        ring((x, y), self.radius(drawn.run.setting.modes_per_speed)).title(&drawn.title())
    }

    /// Line of the least error that a computing time allows: from the top down to the first run of the front, and on to the right.
    fn front_line(&self) -> Element {
        let (mut corners, mut height) = (Vec::new(), self.diagram.top);
        for (x, y) in self.front().into_iter().map(|drawn| self.place(drawn)) {
            corners.extend([Some((x, height)), Some((x, y))]);
            height = y;
        }
        corners.push(Some((self.diagram.right(), height)));
        polyline(corners).set("class", "front-line").set("stroke", "#999999").set("stroke-dasharray", "6 4")
    }

    fn key(&self) -> Element {
        let middle = (0.5 * MARK_WIDTH, 0.0);
        let mut key = Key::new(self.diagram.right() + 30.0, self.diagram.top + 8.0);
        for scheme in self.schemes() {
            let stroke = line((0.0, 0.0), (MARK_WIDTH, 0.0)).set("stroke", scheme::colour(scheme));
            let row = group().child(stroke.set("stroke-width", "1.8"));
            key = key.row(row.child(scheme::mark(scheme, middle, 5.5)), &scheme::words(scheme));
        }
        key = key.note("line: those that none of the scheme beats");
        key = key.note("number: time steps a revolution");
        let dashes = line((0.0, 0.0), (MARK_WIDTH, 0.0)).set("stroke", "#999999");
        let dashes = dashes.set("stroke-dasharray", "6 4");
        key = key.row(group().child(dashes).child(ring(middle, 4.0)), FRONT);
        if self.bars {
            let bar = line((middle.0, -8.0), (middle.0, 8.0)).set("stroke", INK).set("stroke-width", "1.2");
            key = key.row(bar, "± standard error (chaotic)");
        }
        key = key.heading("modes per speed · size of the wheel");
        for &size in &self.sizes {
            let reduction = self.study.reductions.iter().find(|found| found.modes_per_speed == size);
            let unknowns = reduction
                .map(|found| format!(" · {} unknowns", label(found.wheel_unknowns.into(), 0)))
                .unwrap_or_default();
            let mark = Element::new("circle").number("cx", middle.0).number("r", self.radius(size));
            key = key.row(mark.set("fill", "#888888"), &format!("{size}{unknowns}"));
        }
        key.draw()
    }
}

fn ring((x, y): (f64, f64), radius: f64) -> Element {
    Element::new("circle")
        .set("class", "front")
        .number("cx", x)
        .number("cy", y)
        .number("r", radius + 3.5)
        .set("fill", "none")
        .set("stroke", INK)
        .set("stroke-width", "1.5")
}
