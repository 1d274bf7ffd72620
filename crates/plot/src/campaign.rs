//! Campaign: severity over speed and a parameter, and the sensitivities of its variance to the parameters.

use super::axis::significant;
use super::campaign_difference as difference;
use super::cells::{cells, extent};
use super::drawing::Drawing;
use super::layer::{Band, Bars, Cells, Curve, Mark, Marks, Reach};
use super::sketch::{Axis, Panel, Sketch};
use super::style::{Colour, Dash, Look, Pen, Symbol};
use super::{colour, hatching, heading};
use rubmap_analysis::request::Severity;
use rubmap_analysis::result::{Campaign, ParameterSensitivity, severity_unit};
use serde_json::json;

const LEFT: f64 = 110.0;
const WIDTH: f64 = 920.0;
const MAP_HEIGHT: f64 = 420.0;
const ROW_HEIGHT: f64 = 34.0;

/// Distance from a panel to the next, with the axis and the key between.
const APART: f64 = 96.0;

/// Heights of the map, of a panel below it, and of the words of its axis in the figure, pixels.
const PIXELS: (usize, usize, usize) = (560, 170, 90);

/// Largest number of parameters whose sensitivities are drawn: those that account for most.
const MOST_BARS: usize = 20;

/// Severity of designs over speed and a parameter (by its index), with the value at which the limit is met if that is the parameter asked
/// about, and below it, if there are any, the differences of the compared model, and the sensitivities. Missing results are gaps.
pub fn campaign(campaign: &Campaign, parameter: usize) -> Drawing<'static> {
    let title =
        format!("Campaign: {} over speed and {}", severity_words(campaign), name(campaign, parameter));
    let sketch = Sketch::new("campaign", title, words(campaign, parameter));
    let map = map(campaign, parameter, sketch.top() + 20.0);
    let below = map.diagram.bottom() + APART;
    let differences = difference::panel(campaign, ((LEFT, below), WIDTH), map.x.range, &short(campaign));
    let foot = differences.as_ref().map_or(below, |panel| panel.diagram.bottom() + APART);
    let sensitivities = sensitivities(campaign, foot);
    let part = PIXELS.1 + PIXELS.2;
    let lower = if sensitivities.is_some() { part } else { 0 };
    let upper = lower + if differences.is_some() { part } else { 0 };
    let high = PIXELS.0 + upper;
    let share = |pixels: usize| pixels as f64 / high as f64;
    let sketch = Sketch { left: LEFT, ..sketch.high(high) };
    let sketch = sketch.meta("units", json!({"x": "rpm"})).meta("parameter", parameter);
    let sketch = sketch.with(map.domain(share(upper), 1.0));
    let sketch = match sensitivities {
        Some(panel) => sketch.with(panel.domain(0.0, share(PIXELS.1))),
        None => sketch,
    };
    match differences {
        Some(panel) => sketch.with(panel.domain(share(lower), share(lower + PIXELS.1))).into(),
        None => sketch.into(),
    }
}

/// Panel of severity over speed and the parameter.
fn map(campaign: &Campaign, parameter: usize, top: f64) -> Panel<'static> {
    let (rows, cells) = (rows(campaign, parameter), cells(&campaign.speeds_rad_s));
    let range = match (rows.first(), rows.last()) {
        (Some(first), Some(last)) => (first.band.from, last.band.to),
        _ => (0.0, 1.0),
    };
    let y = Axis::linear(name(campaign, parameter), range, 8.0);
    let panel =
        Panel::new((LEFT, top), (WIDTH, MAP_HEIGHT), Axis::speeds(extent(&cells), 9.0), y).key_below();
    let mut panel = panel.ramp(short(campaign), (0.0, loudest(campaign)), colour::amplitude);
    panel.push(hatching::definition());
    panel.push(panel.diagram.background(hatching::FILL));
    let row = |row: &Row| cells.iter().map(|cell| row.by_speed[cell.index]).collect();
    panel.push(Cells {
        columns: cells.iter().map(|cell| Band { from: cell.from, to: cell.to, value: cell.rpm }).collect(),
        values: rows.iter().map(row).collect(),
        rows: rows.iter().map(|row| row.band).collect(),
        hover: vec![
            "%{x:,.1f} rpm".to_owned(),
            format!("{} %{{y:.4~g}}", name(campaign, parameter)),
            format!("{}: %{{z:.4~g}}", short(campaign)),
        ],
        has_speeds: false,
        merged: "neighbours are one cell with the most severe",
        data: Vec::new(),
    });
    threshold(campaign, parameter, &mut panel);
    if rows.iter().any(|row| row.by_speed.iter().any(Option::is_none)) {
        panel.sample(hatching::mark(), "no result");
    }
    panel
}

/// Adds the value of the parameter at which the limit is met, and the ends of its interval; nothing if another parameter was asked about.
fn threshold(campaign: &Campaign, parameter: usize, panel: &mut Panel) {
    let asked = campaign.threshold.as_ref().filter(|found| found.parameter == name(campaign, parameter));
    let Some((found, value)) = asked.and_then(|found| Some((found, found.value?))) else { return };
    let across = |name: &str, value: f64, dash: Dash| {
        let ends = [panel.x.range.0, panel.x.range.1].map(|rpm| Some((rpm, value)));
        Curve::new(name, ends, Pen::new(Colour::warning(), dash, 1.6))
    };
    let title = format!("{} {}", name(campaign, parameter), significant(value));
    let met = across("limit met with the probability asked for", value, Dash::Solid);
    let ends = [found.from, found.to].into_iter().flatten();
    let ends: Vec<Curve> = ends.map(|end| across("its interval", end, Dash::Dashed).unlisted()).collect();
    panel.sample(met.sample(), "limit met with the probability asked for; dashed: its interval");
    panel.push(met.title(&title).class("threshold"));
    panel.layers.extend(ends.into_iter().map(Into::into));
}

/// Row of the map: its stretch of the parameter's axis, and the severity at every speed.
struct Row {
    band: Band,
    by_speed: Vec<Option<f64>>,
}

/// Rows of the map in ascending order: each reaches halfway to its neighbours, at the ends as far outwards as inwards.
fn rows(campaign: &Campaign, parameter: usize) -> Vec<Row> {
    let map = campaign.map(parameter);
    let values: Vec<f64> = map.iter().map(|(value, _)| *value).collect();
    let row = |(place, (value, by_speed)): (usize, (f64, Vec<Option<f64>>))| {
        let alone = if value == 0.0 { 0.5 } else { 0.01 * value.abs() };
        let below = (place > 0).then(|| 0.5 * (value - values[place - 1]));
        let above = values.get(place + 1).map(|next| 0.5 * (next - value));
        let from = value - below.or(above).unwrap_or(alone);
        let to = value + above.or(below).unwrap_or(alone);
        Row { band: Band { from, to, value }, by_speed }
    };
    map.into_iter().enumerate().map(row).collect()
}

/// Paragraphs below the title: designs, simulations, and the messages of threshold and comparison.
fn words(campaign: &Campaign, parameter: usize) -> Vec<String> {
    let outcomes = campaign.designs.iter().map(|design| &design.outcome).chain(campaign.compared());
    let finished: u32 = outcomes.clone().map(|outcome| outcome.finished).sum();
    let all = outcomes.count() * campaign.speeds_rad_s.len();
    let mut words = vec![format!(
        "{} designs, {finished} of {all} simulations · of designs with the same {} the most severe · {}",
        campaign.designs.len(),
        name(campaign, parameter),
        heading::origin(&campaign.settings.sweep.model, &campaign.version)
    )];
    words.extend(campaign.threshold.iter().map(|threshold| threshold.message.clone()));
    words.extend(campaign.comparison.iter().map(|comparison| comparison.message.clone()));
    words
}

fn name(campaign: &Campaign, parameter: usize) -> &str {
    campaign.settings.parameters.get(parameter).map_or("", |parameter| &parameter.name)
}

fn severity_words(campaign: &Campaign) -> &'static str {
    match campaign.settings.severity {
        Severity::Amplitude => "largest amplitude of a sensor",
        Severity::Tip => "amplitude of the tip that moves most",
        Severity::ContactForce => "largest contact force",
        Severity::Wear => "deepest wear",
        Severity::Stress => "largest von Mises stress",
        Severity::Utilisation => "largest utilisation",
    }
}

/// Title of the colour bar: the severity with its unit.
fn short(campaign: &Campaign) -> String {
    let unit = severity_unit(campaign.settings.severity, &campaign.units);
    let words = campaign.settings.severity.as_str().replace('_', " ");
    if unit.is_empty() { words } else { format!("{words}, {unit}") }
}

/// Largest severity of all designs and speeds; 1 where none is known.
fn loudest(campaign: &Campaign) -> f64 {
    let all = campaign.designs.iter().flat_map(|design| design.outcome.by_speed.iter().flatten());
    let loudest = all.copied().filter(|severity| severity.is_finite()).fold(0.0, f64::max);
    if loudest > 0.0 { loudest } else { 1.0 }
}

/// Sensitivities that are drawn, largest total first.
fn shown(campaign: &Campaign) -> Vec<&ParameterSensitivity> {
    let all = campaign.sensitivities.as_ref().map(|sensitivities| sensitivities.parameters.as_slice());
    let mut all: Vec<&ParameterSensitivity> = all.unwrap_or_default().iter().collect();
    all.sort_by(|a, b| b.total.total_cmp(&a.total));
    all.truncate(MOST_BARS);
    all
}

/// Words for a sensitivity.
fn told(of: &ParameterSensitivity) -> String {
    format!(
        "{}: alone {} ± {}, with others {} ± {}",
        of.parameter,
        significant(of.first_order),
        significant(of.first_order_error),
        significant(of.total),
        significant(of.total_error)
    )
}

/// Share of the variance, and its standard error.
type Shared = fn(&ParameterSensitivity) -> (f64, f64);

/// Panel of the sensitivities from `top` on, two bars per parameter with their standard errors; none where there are none.
fn sensitivities(campaign: &Campaign, top: f64) -> Option<Panel<'static>> {
    let shown = shown(campaign);
    let ends = shown.iter().flat_map(|of| {
        [
            of.first_order - of.first_order_error,
            of.total + of.total_error,
            of.first_order + of.first_order_error,
        ]
    });
    let range = ends.fold((0.0, 1.0), |(low, high): (f64, f64), end| (low.min(end), high.max(end)));
    let count = shown.len() as f64;
    let place = |at: usize| count - at as f64;
    let names = shown.iter().enumerate().map(|(at, of)| (place(at), of.parameter.clone())).collect();
    let y = Axis::names("", (0.4, count + 0.6), names);
    let size = (WIDTH - 120.0, ROW_HEIGHT * (count + 0.2));
    let x = Axis::linear("share of the variance", range, 8.0).free();
    let mut panel = Panel::new((LEFT + 120.0, top), size, x, y).apart().key_below();
    let kinds: [(&str, &str, f64, Shared); 2] = [
        ("alone (first order)", "#1f4e79", 0.2, |of| (of.first_order, of.first_order_error)),
        ("with others (total)", "#9db8d2", -0.2, |of| (of.total, of.total_error)),
    ];
    for (index, (words, paper, off, value)) in kinds.into_iter().enumerate() {
        let mark =
            |(at, of): (usize, &&ParameterSensitivity)| Mark::new((value(of).0, place(at) + off), told(of));
        let colour = Colour { paper: paper.to_owned(), ..Colour::curve() };
        let look = if index == 0 { Look::filled } else { Look::open };
        let look = look(Symbol::Circle, (4.0, 9.0), colour).with(paper, paper, 1.0);
        let lengths = shown.iter().map(|of| Reach::even(value(of).1)).collect();
        let bars = Bars {
            lengths,
            colour: Colour { paper: "#222222".to_owned(), ..Colour::curve() },
            class: "error",
        };
        let marks = Marks::new(words, look, shown.iter().enumerate().map(mark)).class("bar");
        panel.marks(words, Marks { across: Some(bars), beam: Some(0.4 * ROW_HEIGHT), ..marks });
    }
    panel.note("lines: standard errors");
    (!shown.is_empty()).then_some(panel)
}
