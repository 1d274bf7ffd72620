//! Work and precision: error over computing time of every setting of a study.

use super::axis::label;
use super::drawing::Drawing;
use super::key::MARK_WIDTH;
use super::layer::{Bars, Course, Curve, Mark, Marks, Reach};
use super::scheme;
use super::sketch::{Axis, Panel};
use super::study_runs::{Drawn, begin, error_axis, extent, no_speed, reason, words};
use super::style::{Colour, Dash, Look, Pen, Symbol};
use super::svg::{Element, INK, group, line};
use rubmap_analysis::request::SchemeChoice;
use rubmap_analysis::result::{Quantity, SpeedStudy, front};
use rubmap_analysis::run::WorkPrecision;
use rubmap_wheel::response::sensitivity::Growth;

const KIND: &str = "work_precision";

/// Radii of the marks of the smallest and of the largest model.
const RADII: (f64, f64) = (3.6, 8.0);

/// Title of the horizontal axis.
const TIME: &str = "CPU time of the whole run with set-up, without reduction, s";

/// Words for the Pareto front.
const FRONT: &str = "no run is better in time and error";

/// Errors of one quantity over computing time at the speed of index `speed`, both on logarithmic axes.
///
/// Every completed run is a mark: colour and shape say the scheme, its size the modes kept. A line joins those runs of a scheme
/// that no other run of it beats in time and error; rings and a step line are the Pareto front of all. Where trajectories are
/// chaotic, bars show the standard error of the amplitude. What has no place on logarithmic axes is counted below.
pub fn work_precision(study: &WorkPrecision, speed: usize, quantity: Quantity) -> Drawing<'static> {
    let title = format!("Work and precision: {}", words(quantity, study));
    let Some(at) = study.speeds.get(speed) else { return no_speed(KIND, &title, speed).into() };
    let sketch = begin(KIND, &title, (study, at), quantity);
    let view = View::new(study, at, quantity);
    if view.runs.is_empty() {
        return sketch.nothing(reason(at, quantity)).into();
    }
    let panel = view.panel(sketch.top() + 30.0);
    sketch.with(panel).into()
}

/// Runs of one quantity at one speed.
struct View<'a> {
    study: &'a WorkPrecision,
    quantity: Quantity,
    /// Whether bars show the standard error.
    has_bars: bool,
    runs: Vec<Drawn<'a>>,
    /// Modes per speed of the models, ascending.
    sizes: Vec<u32>,
}

impl<'a> View<'a> {
    fn new(study: &'a WorkPrecision, at: &'a SpeedStudy, quantity: Quantity) -> Self {
        let chaotic = at.sensitivity.is_some_and(|sensitivity| sensitivity.growth == Growth::Chaotic);
        let runs = at.runs.iter().filter_map(|run| Drawn::of(run, quantity)).collect();
        let mut sizes: Vec<u32> = at.runs.iter().map(|run| run.setting.modes_per_speed).collect();
        sizes.sort_unstable();
        sizes.dedup();
        Self { study, quantity, has_bars: chaotic && quantity == Quantity::Amplitude, runs, sizes }
    }

    fn panel(&self, top: f64) -> Panel<'static> {
        let tops =
            self.runs.iter().filter_map(|drawn| Some(drawn.error + drawn.spread.filter(|_| self.has_bars)?));
        let errors = extent(self.runs.iter().map(|drawn| drawn.error).chain(tops));
        let times = Axis::logarithmic(TIME, extent(self.runs.iter().map(|drawn| drawn.run.time_s)), 14);
        let errors = Axis::logarithmic(error_axis(self.quantity, self.study), errors, 20);
        let mut panel = Panel::new((92.0, top), (790.0, 710.0 - top), times, errors);
        let front = self.front();
        let places = |runs: &[&Drawn]| -> Vec<_> { runs.iter().map(|drawn| Some(place(drawn))).collect() };
        let pen = Pen::new(Colour::neutral("#999999"), Dash::Dashed, 1.2);
        panel.push(Curve::new(FRONT, places(&front), pen.clone()).course(Course::Steps).class("front-line"));
        for scheme in self.schemes() {
            let pen = Pen::new(Colour::of(scheme::colour(scheme)), Dash::Solid, 1.8);
            let curve = Curve::new(&scheme::words(scheme), places(&self.unbeaten(scheme)), pen);
            let sample = group().child(curve.sample()).child(scheme::look(scheme, (5.5, 0.0)).sample());
            panel.sample(sample, &scheme::words(scheme));
            panel.push(curve.class("scheme").unlisted());
        }
        for scheme in self.schemes() {
            panel.push(self.marks(scheme));
        }
        let ring = Look::open(Symbol::Circle, (7.5, 22.0), Colour::neutral(INK));
        let rings = front.iter().map(|drawn| Mark {
            radius: Some(self.radius(drawn.run.setting.modes_per_speed) + 3.5),
            ..Mark::new(place(drawn), drawn.title())
        });
        panel.note("line: those that none of the scheme beats");
        panel.note("number: time steps a revolution");
        panel.sample(group().child(pen.sample()).child(ring.sample()), FRONT);
        panel.push(Marks::new(FRONT, ring, rings).class("front").unlisted());
        self.rest_of_key(&mut panel);
        panel
    }

    /// Adds what the key says of bars and sizes.
    fn rest_of_key(&self, panel: &mut Panel) {
        let middle = 0.5 * MARK_WIDTH;
        if self.has_bars {
            let bar = line((middle, -8.0), (middle, 8.0)).set("stroke", INK).set("stroke-width", "1.2");
            panel.sample(bar, "± standard error (chaotic)");
        }
        panel.heading("modes per speed · size of the wheel");
        for &size in &self.sizes {
            let reduction = self.study.reductions.iter().find(|found| found.modes_per_speed == size);
            let unknowns = reduction
                .map(|found| format!(" · {} unknowns", label(found.wheel_unknowns.into(), 0)))
                .unwrap_or_default();
            let mark = Element::new("circle").number("cx", middle).number("r", self.radius(size));
            panel.sample(mark.set("fill", "#888888"), &format!("{size}{unknowns}"));
        }
    }

    /// Schemes that are in the drawing.
    fn schemes(&self) -> impl Iterator<Item = SchemeChoice> {
        let drawn = |scheme: &SchemeChoice| self.runs.iter().any(|drawn| drawn.run.setting.scheme == *scheme);
        self.study.settings.grid.schemes.iter().copied().filter(drawn)
    }

    /// Radius of the marks of a model with these modes per speed.
    fn radius(&self, modes_per_speed: u32) -> f64 {
        let rank = self.sizes.iter().position(|&size| size == modes_per_speed).unwrap_or(0);
        let steps = self.sizes.len().saturating_sub(1).max(1);
        RADII.0 + (RADII.1 - RADII.0) * rank as f64 / steps as f64
    }

    /// Mark of a run with its steps per revolution.
    fn mark(&self, drawn: &Drawn) -> Mark {
        let radius = Some(self.radius(drawn.run.setting.modes_per_speed));
        let steps = label(drawn.run.setting.steps_per_revolution.into(), 0);
        Mark { radius, ..Mark::new(place(drawn), drawn.title()).label(steps) }
    }

    /// Runs of a scheme, small marks over large ones; bars are the standard error where trajectories are chaotic.
    fn marks(&self, scheme: SchemeChoice) -> Marks {
        let mut here: Vec<&Drawn> =
            self.runs.iter().filter(|drawn| drawn.run.setting.scheme == scheme).collect();
        here.sort_by_key(|drawn| std::cmp::Reverse(drawn.run.setting.modes_per_speed));
        let lengths = here.iter().map(|drawn| Reach::even(drawn.spread.unwrap_or(f64::NAN))).collect();
        let bars = Bars { lengths, colour: Colour::of(scheme::colour(scheme)), class: "spread" };
        let look = scheme::look(scheme, (5.5, 8.0));
        let marks = Marks::new(&scheme::words(scheme), look, here.into_iter().map(|drawn| self.mark(drawn)));
        Marks { has_texts: true, bars: self.has_bars.then_some(bars), ..marks.class("run") }
    }

    /// Runs of a scheme that no other run of the scheme beats in time and error, in ascending time.
    fn unbeaten(&self, scheme: SchemeChoice) -> Vec<&Drawn<'a>> {
        let place = |drawn: &Drawn| {
            let here = drawn.run.setting.scheme == scheme;
            Some((drawn.run.time_s, drawn.run.errors.as_ref().filter(|_| here)?.judged(self.quantity)?))
        };
        let places: Vec<Option<(f64, f64)>> = self.runs.iter().map(place).collect();
        let mut own: Vec<&Drawn> = front(&places).into_iter().map(|index| &self.runs[index]).collect();
        own.sort_by(|a, b| a.run.time_s.total_cmp(&b.run.time_s));
        own
    }

    /// Pareto front of all runs, in ascending time.
    fn front(&self) -> Vec<&Drawn<'a>> {
        let on = |drawn: &&Drawn| drawn.run.pareto.contains(&self.quantity);
        let mut front: Vec<_> = self.runs.iter().filter(on).collect();
        front.sort_by(|a, b| a.run.time_s.total_cmp(&b.run.time_s));
        front
    }
}

fn place(drawn: &Drawn) -> (f64, f64) {
    (drawn.run.time_s, drawn.error)
}
