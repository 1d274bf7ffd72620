//! Errors over the time step: how fast a scheme converges.

use super::drawing::Drawing;
use super::layer::{Course, Curve, Stroke};
use super::sketch::{Axis, Panel, Sketch};
use super::study_runs::{Drawn, begin, error_axis, extent, no_speed, reason, words};
use super::style::{Colour, Dash, Pen};
use super::{scheme, svg};
use rubmap_analysis::request::SchemeChoice;
use rubmap_analysis::request::auto_or::AutoOr;
use rubmap_analysis::result::{Quantity, SpeedStudy};
use rubmap_analysis::run::WorkPrecision;

const KIND: &str = "error_over_step";

/// Errors of one quantity over the time step at the speed of index `speed`, both on logarithmic axes: a line for each scheme and size of
/// the model, and beside them the slopes of first and second order.
pub fn error_over_step(study: &WorkPrecision, speed: usize, quantity: Quantity) -> Drawing<'static> {
    let title = format!("Error over time step: {}", words(quantity, study));
    let Some(at) = study.speeds.get(speed) else { return no_speed(KIND, &title, speed).into() };
    let sketch = begin(KIND, &title, (study, at), quantity);
    let ladders = ladders(at, quantity);
    if ladders.is_empty() {
        return sketch.nothing(reason(at, quantity)).into();
    }
    let panel = panel(&sketch, &ladders, &error_axis(quantity, study));
    sketch.with(panel).into()
}

/// Runs that differ only in their time step.
struct Ladder<'a> {
    modes_per_speed: u32,
    scheme: SchemeChoice,
    kept_modes: AutoOr,
    /// Runs from the smallest step to the largest.
    runs: Vec<Drawn<'a>>,
}

fn ladders(at: &SpeedStudy, quantity: Quantity) -> Vec<Ladder<'_>> {
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
    ladders
}

fn panel(sketch: &Sketch, ladders: &[Ladder], error_axis: &str) -> Panel<'static> {
    let mut sizes: Vec<u32> = ladders.iter().map(|ladder| ladder.modes_per_speed).collect();
    sizes.sort_unstable();
    sizes.dedup();
    let dash = |size: u32| Dash::nth(sizes.iter().position(|other| *other == size).unwrap_or(0));
    let runs = || ladders.iter().flat_map(|ladder| &ladder.runs);
    let steps = Axis::logarithmic("time step, revolutions", extent(runs().map(step)), 14);
    let errors = Axis::logarithmic(error_axis, extent(runs().map(|drawn| drawn.error)), 20);
    let top = sketch.top() + 30.0;
    let mut panel = Panel::new((92.0, top), (790.0, 670.0 - top), steps, errors);
    let slopes = slopes(&panel);
    panel.layers.extend(slopes.into_iter().map(Into::into));
    let mut schemes: Vec<SchemeChoice> = Vec::new();
    for ladder in ladders {
        let name = format!("{}, {} modes", scheme::words(ladder.scheme), ladder.modes_per_speed);
        let places = ladder.runs.iter().map(|drawn| Some((step(drawn), drawn.error)));
        let pen = Pen::new(Colour::of(scheme::colour(ladder.scheme)), dash(ladder.modes_per_speed), 1.6);
        let told = ladder.runs.iter().map(|drawn| drawn.title()).collect();
        let mut curve = Curve::new(&name, places, pen).class("ladder").each(told);
        let look = scheme::look(ladder.scheme, (4.8, 9.0));
        if !schemes.contains(&ladder.scheme) {
            schemes.push(ladder.scheme);
            let solid = Pen { dash: Dash::Solid, ..curve.pen.clone() };
            panel.sample(
                svg::group().child(solid.sample()).child(look.sample()),
                &scheme::words(ladder.scheme),
            );
        }
        curve.look = Some(look);
        panel.push(curve);
    }
    panel.sample(Pen::new(Colour::of("#999999"), Dash::Dotted, 1.6).sample(), "order 1 (h) and order 2 (h²)");
    panel.heading("modes per speed");
    for size in &sizes {
        panel.sample(Pen::new(Colour::of("#444444"), dash(*size), 1.6).sample(), &size.to_string());
    }
    if ladders.iter().any(|ladder| ladder.runs.len() == 1) {
        panel.note("a mark without a line: one step only");
    }
    panel
}

/// Reference lines of first order (h) and second order (h²), from the lower left of the diagram to where they leave it.
fn slopes(panel: &Panel) -> [Curve; 2] {
    let (x, y) = (panel.x.range, panel.y.range);
    [(1, "h", Dash::Dotted), (2, "h²", Dash::Mixed)].map(|(order, words, dash)| {
        let from = (x.0, 1.3 * y.0);
        let reach = f64::min(x.1 / from.0, (y.1 / from.1).powf(1.0 / f64::from(order)));
        let to = (from.0 * reach, from.1 * reach.powi(order));
        let stroke = Stroke { places: vec![Some(from), Some(to)], title: String::new() };
        let pen = Pen::new(Colour::neutral("#999999"), dash, 1.2);
        let slope =
            Curve::of(&format!("order {order} ({words})"), [stroke], pen).course(Course::Cut).class("slope");
        Curve { labels: vec![words.to_owned()], ..slope }
    })
}

/// Time step of a run, in revolutions.
fn step(drawn: &Drawn) -> f64 {
    1.0 / f64::from(drawn.run.setting.steps_per_revolution.max(1))
}
