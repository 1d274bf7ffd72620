//! Campaign: severity over speed and a parameter, and the sensitivities of its variance to the parameters.

use super::axis::{Scale, significant, ticks};
use super::cells::{cells, extent};
use super::diagram::Diagram;
use super::key::Flow;
use super::pixels::Pixels;
use super::svg::{Element, document, group, line, rectangle, text};
use super::{campaign_difference, colour_bar, hatching, heading};
use rubmap_analysis::request::Severity;
use rubmap_analysis::result::{Campaign, ParameterSensitivity, severity_unit};

const WIDTH: f64 = 1180.0;
const LEFT: f64 = 110.0;
const PLOT_WIDTH: f64 = 920.0;
const MAP_HEIGHT: f64 = 420.0;
const BAR_HEIGHT: f64 = 34.0;

/// Colour of the share of variance that a parameter accounts for alone; `WITH_OTHERS`: together with others.
const ALONE: &str = "#1f4e79";
const WITH_OTHERS: &str = "#9db8d2";

/// Largest number of parameters whose sensitivities are drawn: those that account for most.
const MOST_BARS: usize = 20;

/// Value of the parameter and the stretch of its axis that it covers.
pub(super) struct Row {
    pub(super) value: f64,
    from: f64,
    to: f64,
    pub(super) by_speed: Vec<Option<f64>>,
}

/// Rows of the map in ascending order: each reaches halfway to its neighbours, at the ends as far outwards as inwards.
pub(super) fn rows(campaign: &Campaign, parameter: usize) -> Vec<Row> {
    let map = campaign.map(parameter);
    let values: Vec<f64> = map.iter().map(|(value, _)| *value).collect();
    let row = |(place, (value, by_speed)): (usize, (f64, Vec<Option<f64>>))| {
        let alone = if value == 0.0 { 0.5 } else { 0.01 * value.abs() };
        let below = (place > 0).then(|| 0.5 * (value - values[place - 1]));
        let above = values.get(place + 1).map(|next| 0.5 * (next - value));
        let from = value - below.or(above).unwrap_or(alone);
        let to = value + above.or(below).unwrap_or(alone);
        Row { value, from, to, by_speed }
    };
    map.into_iter().enumerate().map(row).collect()
}

/// Draws the severity of designs over speed and a parameter (by its index), with the value at which the limit is met if that is the
/// parameter asked about, and below it, if there are any, the differences of the model that is compared, and the sensitivities.
pub(super) fn campaign(campaign: &Campaign, parameter: usize) -> String {
    let title = title(campaign, parameter);
    let (heading, bottom) = heading::heading(LEFT, &title, &words(campaign, parameter));
    let rows = rows(campaign, parameter);
    let cells = cells(&campaign.speeds_rad_s);
    let loudest = loudest(campaign);
    let y = match (rows.first(), rows.last()) {
        (Some(first), Some(last)) => (first.from, last.to),
        _ => (0.0, 1.0),
    };
    let diagram = Diagram::new((LEFT, bottom + 20.0), (PLOT_WIDTH, MAP_HEIGHT), extent(&cells), y);
    let scale = Scale::linear((0.0, loudest), (diagram.bottom(), diagram.top));
    let mut pixels = Pixels::over(&diagram);
    for row in &rows {
        for cell in &cells {
            let Some(severity) = row.by_speed[cell.index] else { continue };
            let x = (diagram.x.place(cell.from), diagram.x.place(cell.to));
            pixels.paint_area(x, (diagram.y.place(row.to), diagram.y.place(row.from)), scale.share(severity));
        }
    }
    let name = name(campaign, parameter);
    let mut content =
        vec![hatching::definition(), heading, diagram.background(hatching::FILL), pixels.draw()];
    let met = threshold(campaign, parameter, &diagram);
    let is_met = met.is_some();
    content.extend(met);
    content.extend([
        diagram.frame(),
        diagram.x_axis(&ticks(diagram.x.values, 9.0), "rotational speed Ω, rpm"),
        diagram.y_axis(&ticks(diagram.y.values, 8.0), name, 80.0),
        colour_bar::draw(&scale, diagram.right() + 26.0, &ticks(scale.values, 8.0), &short(campaign)),
    ]);
    let mut flow = Flow::new(LEFT, WIDTH - 20.0, diagram.bottom() + 66.0);
    if is_met {
        let mark = line((0.0, 0.0), (30.0, 0.0)).set("stroke", "#d62728").set("stroke-width", "1.6");
        flow = flow.entry(mark, 30.0, "limit met with the probability asked for; dashed: its interval");
    }
    if rows.iter().any(|row| row.by_speed.iter().any(Option::is_none)) {
        flow = flow.entry(hatching::mark(), 20.0, "no result");
    }
    let below = flow.bottom() + 30.0;
    content.push(flow.draw());
    let (differences, below) =
        campaign_difference::panel(campaign, (LEFT, PLOT_WIDTH, WIDTH - 20.0), diagram.x.values, below);
    content.extend(differences);
    let (bars, height) = sensitivities(campaign, below);
    content.extend(bars);
    document(&title, WIDTH, height, content)
}

/// Title: the severity and the parameter.
pub(super) fn title(campaign: &Campaign, parameter: usize) -> String {
    format!("Campaign: {} over speed and {}", severity_words(campaign), name(campaign, parameter))
}

/// Paragraphs below the title: designs, simulations, and the messages of threshold and comparison.
pub(super) fn words(campaign: &Campaign, parameter: usize) -> Vec<String> {
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

pub(super) fn name(campaign: &Campaign, parameter: usize) -> &str {
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
pub(super) fn short(campaign: &Campaign) -> String {
    let unit = severity_unit(campaign.settings.severity, &campaign.units);
    let words = campaign.settings.severity.as_str().replace('_', " ");
    if unit.is_empty() { words } else { format!("{words}, {unit}") }
}

/// Largest severity of all designs and speeds; 1 where none is known.
pub(super) fn loudest(campaign: &Campaign) -> f64 {
    let all = campaign.designs.iter().flat_map(|design| design.outcome.by_speed.iter().flatten());
    let loudest = all.copied().filter(|severity| severity.is_finite()).fold(0.0, f64::max);
    if loudest > 0.0 { loudest } else { 1.0 }
}

/// Value of the parameter at which the limit is met, then the ends of its interval; none if another parameter was asked about.
pub(super) fn met(campaign: &Campaign, parameter: usize) -> Option<(f64, [Option<f64>; 2])> {
    let threshold = campaign.threshold.as_ref()?;
    (threshold.parameter == name(campaign, parameter))
        .then_some((threshold.value?, [threshold.from, threshold.to]))
}

fn threshold(campaign: &Campaign, parameter: usize, diagram: &Diagram) -> Option<Element> {
    let (value, ends) = met(campaign, parameter)?;
    let across = |value: f64, dashes: &str| {
        let y = diagram.y.place(value);
        let line = line((diagram.left, y), (diagram.right(), y)).set("stroke", "#d62728");
        line.set("stroke-width", "1.6").set("stroke-dasharray", dashes)
    };
    let inside = |value: &f64| diagram.y.contains(*value);
    let value = Some(value).filter(inside);
    let value = value.map(|value| {
        across(value, "").set("class", "threshold").title(&format!(
            "{} {}",
            name(campaign, parameter),
            significant(value)
        ))
    });
    let ends = ends.into_iter().flatten().filter(inside).map(|end| across(end, "6 4"));
    Some(group().children(value).children(ends))
}

/// Sensitivities that are drawn, largest total first.
pub(super) fn shown(campaign: &Campaign) -> Vec<&ParameterSensitivity> {
    let all = campaign.sensitivities.as_ref().map(|sensitivities| sensitivities.parameters.as_slice());
    let mut all: Vec<&ParameterSensitivity> = all.unwrap_or_default().iter().collect();
    all.sort_by(|a, b| b.total.total_cmp(&a.total));
    all.truncate(MOST_BARS);
    all
}

/// Words for a sensitivity.
pub(super) fn told(of: &ParameterSensitivity) -> String {
    format!(
        "{}: alone {} ± {}, with others {} ± {}",
        of.parameter,
        significant(of.first_order),
        significant(of.first_order_error),
        significant(of.total),
        significant(of.total_error)
    )
}

/// Two bars per parameter from `top` on, with their standard errors; and the height of the whole drawing.
fn sensitivities(campaign: &Campaign, top: f64) -> (Vec<Element>, f64) {
    let shown = shown(campaign);
    if shown.is_empty() {
        return (Vec::new(), top);
    }
    let ends = shown.iter().flat_map(|of| {
        [
            of.first_order - of.first_order_error,
            of.total + of.total_error,
            of.first_order + of.first_order_error,
        ]
    });
    let (low, high) = ends.fold((0.0, 1.0), |(low, high): (f64, f64), end| (low.min(end), high.max(end)));
    let height = BAR_HEIGHT * shown.len() as f64;
    let diagram = Diagram::new((LEFT + 120.0, top), (PLOT_WIDTH - 120.0, height), (low, high), (0.0, 1.0));
    let x = ticks(diagram.x.values, 8.0);
    let bar = |(value, error): (f64, f64), y: f64, colour: &str| {
        let (from, to) = (diagram.x.place(0.0), diagram.x.place(value));
        let middle = y + 0.5 * (0.5 * BAR_HEIGHT - 4.0);
        let whisker =
            line((diagram.x.place(value - error), middle), (diagram.x.place(value + error), middle));
        group()
            .child(
                rectangle(from.min(to), y, (to - from).abs(), 0.5 * BAR_HEIGHT - 4.0)
                    .set("fill", colour)
                    .set("class", "bar"),
            )
            .child(whisker.set("stroke", "#222222").set("stroke-width", "1.2"))
    };
    let bars = shown.iter().enumerate().map(|(place, of)| {
        let y = top + BAR_HEIGHT * place as f64 + 3.0;
        group()
            .child(bar((of.first_order, of.first_order_error), y, ALONE))
            .child(bar((of.total, of.total_error), y + 0.5 * BAR_HEIGHT - 2.0, WITH_OTHERS))
            .child(
                text(diagram.left - 10.0, y + 0.5 * BAR_HEIGHT, "end", &of.parameter).set("font-size", "12"),
            )
            .title(&told(of))
    });
    let swatch = |colour: &str| rectangle(0.0, -6.0, 20.0, 10.0).set("fill", colour);
    let flow = Flow::new(LEFT, WIDTH - 20.0, diagram.bottom() + 66.0)
        .entry(swatch(ALONE), 20.0, "alone (first order)")
        .entry(swatch(WITH_OTHERS), 20.0, "with others (total); lines: standard errors");
    let height = flow.bottom() + 30.0;
    let content = vec![
        diagram.grid(&x, &[]),
        group().children(bars),
        diagram.frame(),
        diagram.x_axis(&x, "share of the variance"),
        flow.draw(),
    ];
    (content, height)
}
