//! Interaction map: level and amplitudes over speed, engine orders, critical speeds, linear prediction.

use serde_json::json;

use super::amplitudes::amplitudes;
use super::attributes::{Axis, Scatter};
use super::cells::{MOST, logarithmic};
use super::document::{Figure, axis, speeds};
use super::level;
use super::marks::{line, marks, silent, strokes, words};
use super::palette::{WARNING, colour, dash};
use crate::cells::{Cell, cells, rpm};
use crate::frame::Frame;
use crate::level::{LevelColour, axis as level_axis};
use crate::map_view::{DRIVEN, OrderLine, QUIETEST, VerticalAxis, View, lobes};
use crate::marks::{critical_words, driven_words, known_to, linear_words};
use crate::window::Window;
use crate::{heat, interaction_map as drawing, validity};
use rubmap_analysis::result::{Campbell, CriticalSpeed, CriticalSpeeds, InteractionMap, StiffeningVerdict};

/// Colour of the linear criterion's crossings, visible on all amplitudes.
const LINEAR: &str = "#ff77cc";

/// Height of the figure in pixels.
const HEIGHT: usize = 760;

/// Vertical extent of the map, as shares of the height between the axes; `LEVEL`: of the level above it.
const MAP: [f64; 2] = [0.0, 0.7];
const LEVEL: [f64; 2] = [0.76, 1.0];

/// Interaction map or a window of it, with its critical speeds and the linear prediction where they are given.
///
/// The colours of the map are the logarithms of amplitudes to the base of 10; `customdata` holds for every cell the amplitude itself, its
/// frequency in Hz (with frequencies on the vertical axis: its engine order), and the speed in rad/s. `layout.meta.amplitude` says how to
/// show it linearly.
pub(crate) fn interaction_map(
    map: &InteractionMap,
    critical: Option<&CriticalSpeeds>,
    campbell: Option<&Campbell>,
    axis_upwards: VerticalAxis,
    window: Window,
    level_colour: LevelColour,
) -> Figure {
    seen_in((axis_upwards, Frame::Rotating), map, critical, campbell, window, level_colour)
}

/// Interaction map in the fixed frame, as [`fixed_frame_map`](crate::fixed_frame_map) draws it, with the cells of [`interaction_map`].
pub(crate) fn fixed_frame_map(
    map: &InteractionMap,
    critical: Option<&CriticalSpeeds>,
    axis_upwards: VerticalAxis,
    window: Window,
    level_colour: LevelColour,
) -> Figure {
    seen_in((axis_upwards, Frame::Fixed), map, critical, None, window, level_colour)
}

fn seen_in(
    seen: (VerticalAxis, Frame),
    map: &InteractionMap,
    critical: Option<&CriticalSpeeds>,
    campbell: Option<&Campbell>,
    window: Window,
    level_colour: LevelColour,
) -> Figure {
    let cells = cells(&map.speeds_rad_s);
    let view = View::new(map, &cells, campbell, seen, &window, ((0.0, 0.0), (1.0, 1.0)));
    let loudest = heat::loudest(map, &window);
    let scale = loudest.map_or((QUIETEST, 1.0), |loudest| (QUIETEST * loudest, loudest));
    let shown = amplitudes(map, &cells, &view, scale.0, ("x", "y"), MOST);
    let unit = map.sensor.unit(&map.units);
    let paragraphs: Vec<String> = [drawing::words(map)]
        .into_iter()
        .chain((view.frame == Frame::Fixed).then(|| drawing::BOTH_WAYS.to_owned()))
        .chain(map.stiffening.and_then(StiffeningVerdict::warning).map(str::to_owned))
        .chain(validity::without_thickness(map).then(|| validity::WITHOUT_THICKNESS.to_owned()))
        .chain(shown.thinned.clone())
        .collect();
    let x = speeds().range(<[f64; 2]>::from(view.diagram.x.values)).anchor("y");
    let seen = cells.iter().filter(|cell| view.diagram.x.contains(cell.rpm)).copied();
    let seen: Vec<Cell> = seen.collect();
    Figure::new("interaction_map", &drawing::title(map, view.frame), &paragraphs)
        .high(HEIGHT)
        .with(shown.trace)
        .with_all(engine_orders(map, &view))
        .with_all(campbell.map(|campbell| natural(campbell, &view)).into_iter().flatten())
        .with_all(level::traces(map, &seen, level_colour, "y2"))
        .with_all(critical.map(|critical| crossings(critical, &view)).into_iter().flatten())
        .with_all(
            critical.map(|critical| critical_speeds(critical, &view, level_colour)).into_iter().flatten(),
        )
        .axis("xaxis", x)
        .axis("yaxis", upwards(&view).domain(MAP))
        .axis("yaxis2", axis(&level_axis(map)).domain(LEVEL).rangemode("tozero").anchor("x"))
        .attribute("coloraxis", logarithmic(scale, &format!("amplitude, {unit}"), (MAP[0], MAP[1])))
        .meta("sensor", map.sensor)
        .meta("units", json!({"x": "rpm", "y": y_unit(&view), "amplitude": unit}))
        .meta("speeds_rpm", cells.iter().map(|cell| cell.rpm).collect::<Vec<f64>>())
        .meta("speed_indices", cells.iter().map(|cell| cell.index).collect::<Vec<usize>>())
        .meta("column_speed_indices", shown.indices)
        .meta("amplitude", json!({"z": "log10", "linear": "customdata[row][column][0]", "range": scale}))
}

fn y_unit(view: &View) -> &'static str {
    match (view.axis, view.frame) {
        (VerticalAxis::EngineOrder, Frame::Rotating) => "engine_order",
        (VerticalAxis::EngineOrder, Frame::Fixed) => "rotational_frequency",
        (VerticalAxis::Frequency, _) => "Hz",
    }
}

/// Vertical axis of a view.
pub(super) fn upwards(view: &View) -> Axis {
    axis(view.axis_words()).range(<[f64; 2]>::from(view.diagram.y.values))
}

/// Traces of the engine orders; those that the lobes excite have their numbers in a map of frequencies.
pub(super) fn engine_orders(map: &InteractionMap, view: &View) -> Vec<Scatter> {
    let (excited, others): (Vec<OrderLine>, Vec<OrderLine>) =
        view.order_lines(map).into_iter().partition(|line| line.excited && lobes(map) > 1);
    let other_words = if lobes(map) > 1 { "other engine orders" } else { "engine orders" };
    let mut traces = Vec::new();
    for (name, lines, pen) in [
        (other_words, &others, ("rgba(176, 176, 176, 0.6)", "dot", 1.0)),
        ("engine orders of lobes", &excited, ("rgba(176, 176, 176, 0.45)", "solid", 1.0)),
    ] {
        if lines.is_empty() {
            continue;
        }
        let trace = silent(name, strokes(lines.iter().map(|line| line.ends)), pen);
        let rising = view.axis == VerticalAxis::Frequency;
        let numbers = lines.iter().flat_map(|line| [String::new(), line.order.to_string(), String::new()]);
        traces.push(match rising {
            true => {
                trace.mode("lines+text").text(numbers.collect::<Vec<String>>()).textposition("bottom left")
            }
            false => trace,
        });
    }
    traces
}

/// Traces of the natural frequencies in the rotating frame, those of a nodal diameter under one name.
fn natural(campbell: &Campbell, view: &View) -> Vec<Scatter> {
    let harmonics = campbell.frequencies_hz.first().map_or(0, Vec::len);
    let lines = view.natural(campbell);
    let of = |i: usize| {
        let lines = lines.iter().filter(move |line| line.nodal_diameter == i);
        let places = lines.clone().flat_map(|line| line.places.iter().copied().chain([None]));
        let told = lines.flat_map(|line| vec![line.words(); line.places.len() + 1]).collect();
        let pen = (colour(i, harmonics), dash(i), 1.3);
        words(line(&format!("nodal diameter {i}"), places, (&pen.0, pen.1, pen.2)), told)
    };
    (0..harmonics).map(of).collect()
}

/// Traces of the crossings of natural frequencies with the linear criterion and with the lobes' engine orders.
fn crossings(critical: &CriticalSpeeds, view: &View) -> Vec<Scatter> {
    let place = |speed_rad_s: f64, order: u32| view.seen(rpm(speed_rad_s), f64::from(order));
    let linear = critical.linear_crossings.iter().filter_map(|crossing| {
        let order = crossing.nodal_diameter * crossing.superharmonic;
        Some((place(crossing.speed_rad_s, order)?, linear_words(crossing)))
    });
    let driven = critical.driven_crossings.iter().filter_map(|crossing| {
        Some((place(crossing.speed_rad_s, crossing.engine_order)?, driven_words(crossing)))
    });
    let rings = marks("linear (i, j, n)", linear, ("circle-open", 10, LINEAR));
    let diamonds = marks("driven (i, j)", driven, ("diamond", 9, DRIVEN));
    rings.into_iter().chain(diamonds).collect()
}

/// Traces of the critical speeds: lines through both panels, and a mark at the level of each.
fn critical_speeds(critical: &CriticalSpeeds, view: &View, by: LevelColour) -> Vec<Scatter> {
    let said = by == LevelColour::Utilisation;
    let mut traces = Vec::new();
    for (resolved, name, dash) in [(true, "critical speed", "dash"), (false, "critical, not resolved", "dot")]
    {
        let of = |speed: &&CriticalSpeed| {
            speed.resolved == resolved && view.diagram.x.contains(rpm(speed.speed_rad_s))
        };
        let found: Vec<&CriticalSpeed> = critical.critical_speeds.iter().filter(of).collect();
        let (low, high) = view.diagram.y.values;
        let upright = found.iter().map(|speed| rpm(speed.speed_rad_s)).map(|rpm| [(rpm, low), (rpm, high)]);
        let lines = silent(name, strokes(upright), (WARNING, dash, 1.4));
        let told = |speed: &&CriticalSpeed| {
            let words = format!("{}{}", critical_words(speed, said), known_to(speed));
            ((rpm(speed.speed_rad_s), speed.rms), words)
        };
        let symbol = if resolved { "triangle-down" } else { "triangle-down-open" };
        let Some(peaks) = marks(name, found.iter().map(told), (symbol, 11, WARNING)) else { continue };
        let indices: Vec<usize> = found.iter().map(|speed| speed.index as usize).collect();
        let peaks = peaks.customdata(indices).yaxis("y2").showlegend(false);
        traces.extend([lines.legendgroup(name), peaks.legendgroup(name)]);
    }
    traces
}
