//! Work and precision: error over computing time of every setting of a study.

use serde_json::json;

use super::attributes::{Axis, Line, Marker, Scatter};
use super::document::{Figure, axis};
use super::marks::{bars, marks, silent};
use super::palette::{NEUTRAL, symbol};
use crate::axis::label;
use crate::cells::rpm;
use crate::scheme;
use crate::study_runs::{Drawn, error_axis, left_out, origin, reason};
use crate::work_precision::{self as drawing, FRONT, TIME, View};
use rubmap_analysis::request::SchemeChoice;
use rubmap_analysis::result::{Quantity, SpeedStudy};
use rubmap_analysis::run::WorkPrecision;

/// Errors of one quantity over computing time at the speed of index `speed`, both on logarithmic axes: a name for each scheme, marks larger
/// for more modes, and the Pareto front of all.
pub fn work_precision(study: &WorkPrecision, speed: usize, quantity: Quantity) -> Figure {
    let title = drawing::title(study, quantity);
    let Some(at) = study.speeds.get(speed) else { return no_speed("work_precision", &title, speed) };
    let view = View::new(study, at, quantity, 0.0);
    let figure = begin("work_precision", &title, (study, at), quantity);
    if view.runs.is_empty() {
        return figure.empty(&reason(at, quantity));
    }
    let front: Vec<&Drawn> = view.front();
    let places = |runs: &[&Drawn]| -> Vec<Option<(f64, f64)>> {
        runs.iter().map(|drawn| Some((drawn.run.time_s, drawn.error))).collect()
    };
    let pen = Line::default().color(NEUTRAL).width(1.2).dash("dash").shape("hv");
    let front_line = silent(FRONT, places(&front), (NEUTRAL, "dash", 1.2)).line(pen);
    let rings = front.iter().map(|drawn| ((drawn.run.time_s, drawn.error), drawn.title()));
    let rings = marks(FRONT, rings, ("circle-open", 22, NEUTRAL));
    let schemes: Vec<SchemeChoice> = view.schemes().collect();
    figure
        .with(front_line.legendgroup("front"))
        .with_all(rings.map(|rings| rings.legendgroup("front").showlegend(false)))
        .with_all(schemes.iter().map(|scheme| {
            let name = scheme::words(*scheme);
            let own = silent(&name, places(&view.unbeaten(*scheme)), (scheme::colour(*scheme), "solid", 1.8));
            own.legendgroup(name).showlegend(false)
        }))
        .with_all(schemes.iter().filter_map(|scheme| runs(&view, *scheme)))
        .axis("xaxis", logarithmic(TIME, view.diagram.x.values))
        .axis("yaxis", logarithmic(&error_axis(quantity, study), view.diagram.y.values))
}

/// Builds a figure of one speed of a study, without its traces.
pub(super) fn begin(
    kind: &str,
    title: &str,
    (study, at): (&WorkPrecision, &SpeedStudy),
    quantity: Quantity,
) -> Figure {
    let title = format!("{title}, {} rpm", label(rpm(at.speed_rad_s), 0));
    let paragraphs = [at.message.clone(), origin(study, at), left_out(at, quantity)];
    let paragraphs: Vec<String> = paragraphs.into_iter().filter(|words| !words.is_empty()).collect();
    let figure = Figure::new(kind, &title, &paragraphs).high(640);
    figure.meta("quantity", quantity).meta("speed_rpm", rpm(at.speed_rad_s)).meta("units", json!({"y": "1"}))
}

/// Figure with a message, where a study has no speed of this index.
pub(super) fn no_speed(kind: &str, title: &str, speed: usize) -> Figure {
    Figure::new(kind, title, &[]).empty(&format!("the study has no speed of index {speed}"))
}

/// Logarithmic axis.
pub(super) fn logarithmic(title: &str, (low, high): (f64, f64)) -> Axis {
    let axis = axis(title).kind("log").range([low.log10(), high.log10()]);
    axis.exponentformat("e")
}

/// Symbol of a scheme.
pub(super) fn mark(scheme: SchemeChoice) -> &'static str {
    match scheme {
        SchemeChoice::ExactModal => symbol(0, true),
        SchemeChoice::MasslessBoundary => symbol(1, true),
        SchemeChoice::CentralDifferences => symbol(2, true),
        SchemeChoice::Auto => symbol(3, true),
    }
}

/// Runs of a scheme with their steps per revolution; bars are the standard error where trajectories are chaotic.
fn runs(view: &View, scheme: SchemeChoice) -> Option<Scatter> {
    let of: Vec<&Drawn> = view.runs.iter().filter(|drawn| drawn.run.setting.scheme == scheme).collect();
    let told = of.iter().map(|drawn| ((drawn.run.time_s, drawn.error), drawn.title()));
    let name = scheme::words(scheme);
    let trace = marks(&name, told, (mark(scheme), 8, scheme::colour(scheme)))?;
    let sizes = of
        .iter()
        .map(|drawn| (2.2 * view.radius(drawn.run.setting.modes_per_speed)) as usize as f64)
        .collect::<Vec<f64>>();
    let marker = Marker::default().symbol(mark(scheme)).size(sizes).color(scheme::colour(scheme));
    let steps: Vec<String> =
        of.iter().map(|drawn| label(drawn.run.setting.steps_per_revolution.into(), 0)).collect();
    let trace = trace.marker(marker).mode("markers+text").text(steps);
    let trace = trace.textposition("top right").legendgroup(name).cliponaxis(false);
    let spreads: Vec<f64> = of.iter().map(|drawn| drawn.spread.unwrap_or(f64::NAN)).collect();
    Some(match view.bars {
        true => trace.error_y(bars().array(spreads).color(scheme::colour(scheme))),
        false => trace,
    })
}
