//! Errors over the time step: how fast a scheme converges.

use super::axis::{decades, label};
use super::cells::rpm;
use super::colour::DASHES;
use super::diagram::Diagram;
use super::heading::heading;
use super::key::{Key, MARK_WIDTH};
use super::study_runs::{Drawn, error_axis, extent, left_out, origin, reason, words};
use super::svg::{Element, group, line, polyline, text};
use super::{scheme, svg};
use rubmap_analysis::request::SchemeChoice;
use rubmap_analysis::request::auto_or::AutoOr;
use rubmap_analysis::result::{Quantity, SpeedStudy};
use rubmap_analysis::run::WorkPrecision;

const WIDTH: f64 = 1180.0;
const HEIGHT: f64 = 760.0;
const LEFT: f64 = 92.0;
const PLOT_WIDTH: f64 = 790.0;

/// Draws the errors of one quantity over the time step at the speed of index `speed`, both on logarithmic axes: a line for each scheme and
/// size of the model, and beside them the slopes of first and second order.
pub fn error_over_step(study: &WorkPrecision, speed: usize, quantity: Quantity) -> String {
    let title = title(study, quantity);
    let Some(at) = study.speeds.get(speed) else {
        let (heading, _) = heading(LEFT, &title, &[format!("the study has no speed of index {speed}")]);
        return svg::document(&title, WIDTH, HEIGHT, vec![heading]);
    };
    let title = format!("{title}, {} rpm", label(rpm(at.speed_rad_s), 0));
    let (heading, bottom) = heading(LEFT, &title, &[at.message.clone(), origin(study, at)]);
    let note = text(LEFT, HEIGHT - 16.0, "start", &left_out(at, quantity));
    let note = note.set("class", "left-out").set("font-size", "12").set("fill", "#555555");
    let mut content = vec![heading, note];
    content.extend(View::new(at, quantity, bottom + 30.0).draw(study));
    svg::document(&title, WIDTH, HEIGHT, content)
}

/// Title: the quantity whose error is drawn.
pub(super) fn title(study: &WorkPrecision, quantity: Quantity) -> String {
    format!("Error over time step: {}", words(quantity, study))
}

/// Title of the horizontal axis.
pub(super) const STEP: &str = "time step, revolutions";

/// Runs that differ only in their time step.
pub(super) struct Ladder<'a> {
    pub(super) modes_per_speed: u32,
    pub(super) scheme: SchemeChoice,
    kept_modes: AutoOr,
    /// Runs from the smallest step to the largest.
    pub(super) runs: Vec<Drawn<'a>>,
}

/// Diagram of one quantity at one speed.
pub(super) struct View<'a> {
    at: &'a SpeedStudy,
    quantity: Quantity,
    pub(super) ladders: Vec<Ladder<'a>>,
    /// Modes per speed, ascending.
    pub(super) sizes: Vec<u32>,
    diagram: Diagram,
}

impl<'a> View<'a> {
    /// Lays out the errors in a diagram that begins at `top`.
    pub(super) fn new(at: &'a SpeedStudy, quantity: Quantity, top: f64) -> Self {
        let mut ladders: Vec<Ladder> = Vec::new();
        for drawn in at.runs.iter().filter_map(|run| Drawn::of(run, quantity)) {
            let setting = drawn.run.setting;
            let same = |ladder: &&mut Ladder| {
                (ladder.modes_per_speed, ladder.scheme, ladder.kept_modes)
                    == (setting.modes_per_speed, setting.scheme, setting.kept_modes)
            };
            match ladders.iter_mut().find(same) {
                Some(ladder) => ladder.runs.push(drawn),
                None => ladders.push(Ladder {
                    modes_per_speed: setting.modes_per_speed,
                    scheme: setting.scheme,
                    kept_modes: setting.kept_modes,
                    runs: vec![drawn],
                }),
            }
        }
        for ladder in &mut ladders {
            ladder.runs.sort_by_key(|drawn| std::cmp::Reverse(drawn.run.setting.steps_per_revolution));
        }
        let mut sizes: Vec<u32> = ladders.iter().map(|ladder| ladder.modes_per_speed).collect();
        sizes.sort_unstable();
        sizes.dedup();
        let runs = || ladders.iter().flat_map(|ladder| &ladder.runs);
        let steps = extent(runs().map(|drawn| step(drawn)));
        let errors = extent(runs().map(|drawn| drawn.error));
        let diagram = Diagram::logarithmic((LEFT, top), (PLOT_WIDTH, HEIGHT - 90.0 - top), steps, errors);
        Self { at, quantity, ladders, sizes, diagram }
    }

    fn draw(&self, study: &WorkPrecision) -> Vec<Element> {
        let diagram = &self.diagram;
        if self.ladders.is_empty() {
            return vec![diagram.frame(), diagram.words(&reason(self.at, self.quantity))];
        }
        let (x, y) = (decades(diagram.x.values, 14), decades(diagram.y.values, 20));
        let ladders = self.ladders.iter().map(|ladder| self.ladder(ladder));
        vec![
            diagram.grid(&x, &y),
            self.slopes(),
            group().children(ladders),
            diagram.frame(),
            diagram.x_axis(&x, STEP),
            diagram.y_axis(&y, &error_axis(self.quantity, study), 64.0),
            self.key(),
        ]
    }

    fn dashes(&self, modes_per_speed: u32) -> &'static str {
        let rank = self.sizes.iter().position(|size| *size == modes_per_speed).unwrap_or(0);
        DASHES[rank % DASHES.len()]
    }

    fn ladder(&self, ladder: &Ladder) -> Element {
        let place = |drawn: &Drawn| self.diagram.point(step(drawn), drawn.error);
        let rungs = polyline(ladder.runs.iter().map(|drawn| Some(place(drawn))))
            .set("class", "ladder")
            .set("stroke", scheme::colour(ladder.scheme))
            .set("stroke-width", "1.6")
            .set("stroke-dasharray", self.dashes(ladder.modes_per_speed));
        let marks = ladder.runs.iter().map(|drawn| {
            scheme::mark(ladder.scheme, place(drawn), 4.8).set("class", "run").title(&drawn.title())
        });
        group().child(rungs).children(marks)
    }

    /// Reference lines of first order (h) and second order (h²), from the lower left of the diagram to where they leave it.
    pub(super) fn orders(&self) -> [([(f64, f64); 2], &'static str); 2] {
        let (x, y) = (self.diagram.x.values, self.diagram.y.values);
        [(1, "h"), (2, "h²")].map(|(order, words)| {
            let from = (x.0, 1.3 * y.0);
            let reach = f64::min(x.1 / from.0, (y.1 / from.1).powf(1.0 / f64::from(order)));
            ([from, (from.0 * reach, from.1 * reach.powi(order))], words)
        })
    }

    fn slopes(&self) -> Element {
        let lines = self.orders().into_iter().map(|([from, to], words)| {
            let (a, b) = (self.diagram.point(from.0, from.1), self.diagram.point(to.0, to.1));
            let stroke = line(a, b).set("class", "slope").set("stroke", "#bbbbbb").set("stroke-width", "1.2");
            let label = text(b.0 - 8.0, b.1 + 16.0, "end", words).set("fill", "#777777").rimmed("white");
            group().child(stroke).child(label)
        });
        group().children(lines)
    }

    fn key(&self) -> Element {
        let middle = (0.5 * MARK_WIDTH, 0.0);
        let stroke = |colour: &str, dashes: &str| {
            let stroke = line((0.0, 0.0), (MARK_WIDTH, 0.0)).set("stroke", colour);
            stroke.set("stroke-width", "1.6").set("stroke-dasharray", dashes)
        };
        let mut key = Key::new(self.diagram.right() + 30.0, self.diagram.top + 8.0);
        let mut schemes: Vec<SchemeChoice> = Vec::new();
        for ladder in &self.ladders {
            if !schemes.contains(&ladder.scheme) {
                schemes.push(ladder.scheme);
                let row = group().child(stroke(scheme::colour(ladder.scheme), ""));
                let row = row.child(scheme::mark(ladder.scheme, middle, 5.0));
                key = key.row(row, &scheme::words(ladder.scheme));
            }
        }
        key = key.row(stroke("#bbbbbb", ""), "order 1 (h) and order 2 (h²)");
        key = key.heading("modes per speed");
        for size in &self.sizes {
            key = key.row(stroke("#444444", self.dashes(*size)), &size.to_string());
        }
        if self.ladders.iter().any(|ladder| ladder.runs.len() == 1) {
            key = key.note("a mark without a line: one step only");
        }
        key.draw()
    }
}

/// Time step of a run, in revolutions.
pub(super) fn step(drawn: &Drawn) -> f64 {
    1.0 / f64::from(drawn.run.setting.steps_per_revolution.max(1))
}
