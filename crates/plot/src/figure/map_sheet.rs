//! Sheet of interaction maps, one per nodal diameter.

use serde_json::{Value, json};

use super::amplitudes::amplitudes;
use super::attributes::Title;
use super::cells::{MOST, logarithmic};
use super::document::{Figure, axis};
use super::interaction_map::{engine_orders, upwards};
use super::level;
use super::text::escaped;
use crate::cells::cells;
use crate::frame::Frame;
use crate::heat;
use crate::level::LevelColour;
use crate::map_sheet::{self as drawing, NO_MAP};
use crate::map_view::{QUIETEST, VerticalAxis, View};
use crate::window::Window;
use rubmap_analysis::result::InteractionMap;

/// Sheet of maps of one sensor restricted to nodal diameters: the same window of each, a panel each with a common colour scale and axes
/// that move together. With the colours of utilisation there is a strip of them at the top of each map.
pub(crate) fn map_sheet(maps: &[InteractionMap], window: Window, level_colour: LevelColour) -> Figure {
    let figure = Figure::new("map_sheet", &drawing::title(maps), &[drawing::words(maps)]);
    let Some(first) = maps.first() else { return figure.empty(NO_MAP) };
    let columns = if maps.len() > 3 { 2 } else { 1 };
    let rows = maps.len().div_ceil(columns);
    let loudest = maps.iter().filter_map(|map| heat::loudest(map, &window)).fold(0.0, f64::max);
    let scale = if loudest > 0.0 { (QUIETEST * loudest, loudest) } else { (QUIETEST, 1.0) };
    let unit = first.sensor.unit(&first.units);
    let cells = cells(&first.speeds_rad_s);
    let most = share(maps.len(), columns);
    let mut figure = figure.high(160 + 230 * rows);
    let mut names: Vec<Value> = Vec::new();
    let mut thinned = None;
    for (index, map) in maps.iter().enumerate() {
        let (row, column) = (index / columns, index % columns);
        let view = View::new(
            map,
            &cells,
            None,
            (VerticalAxis::EngineOrder, Frame::Rotating),
            &window,
            ((0.0, 0.0), (1.0, 1.0)),
        );
        let (x, y) = (name("x", index), name("y", index));
        let shown = amplitudes(map, &cells, &view, scale.0, (&x, &y), most);
        thinned = thinned.or(shown.thinned);
        let lines = engine_orders(map, &view).into_iter().map(|trace| trace.showlegend(index == 0));
        figure = figure.with(shown.trace).with_all(lines.map(|trace| trace.xaxis(&x).yaxis(&y)));
        if level_colour == LevelColour::Utilisation {
            let (low, high) = view.diagram.y.values;
            let strips = level::utilisation(map, &cells, |_| Some((high - 0.04 * (high - low), high)));
            let strips = strips.into_iter().map(|trace| trace.showlegend(index == 0).xaxis(&x).yaxis(&y));
            figure = figure.with_all(strips);
        }
        let (wide, high) = (1.0 / columns as f64, 1.0 / rows as f64);
        let left = wide * column as f64 + if column > 0 { 0.06 } else { 0.0 };
        let foot = 1.0 - high * (row + 1) as f64;
        let across = [left, wide * (column + 1) as f64 - if column + 1 < columns { 0.02 } else { 0.0 }];
        let along = [foot + if row + 1 < rows { 0.25 * high } else { 0.0 }, foot + 0.92 * high];
        let below = index + columns >= maps.len();
        let mut x_axis = axis(if below { "Ω, rpm" } else { "" })
            .nticks(4u32)
            .tickangle(0.0)
            .range(<[f64; 2]>::from(view.diagram.x.values))
            .domain(across)
            .anchor(&y);
        let mut y_axis = upwards(&view).domain(along).anchor(&x);
        if column > 0 {
            y_axis = y_axis.title(Title::default().text(""));
        }
        if index > 0 {
            (x_axis, y_axis) = (x_axis.matches("x"), y_axis.matches("y"));
        }
        figure = figure.axis(&long("x", index), x_axis).axis(&long("y", index), y_axis);
        names.push(json!({
            "text": escaped(&drawing::name(map)), "xref": "paper", "yref": "paper", "x": across[0], "y": along[1], "xanchor": "left",
            "yanchor": "bottom", "showarrow": false,
        }));
    }
    let bar = logarithmic(scale, &format!("amplitude, {unit}"), (0.0, 1.0));
    figure
        .attribute("annotations", Value::Array(names))
        .attribute("coloraxis", bar)
        .meta("sensor", first.sensor)
        .meta("units", json!({"x": "rpm", "y": "engine_order", "amplitude": unit}))
        .meta("nodal_diameters", maps.iter().map(|map| map.nodal_diameter).collect::<Vec<_>>())
        .meta("speeds_rpm", cells.iter().map(|cell| cell.rpm).collect::<Vec<f64>>())
        .meta("speed_indices", cells.iter().map(|cell| cell.index).collect::<Vec<usize>>())
        .meta("thinned", thinned)
        .meta("amplitude", json!({"z": "log10", "linear": "customdata[row][column][0]", "range": scale}))
}

/// Numbers of speeds and rows of each map, for so many maps in so many columns: all maps together have the cells of two large ones.
fn share(maps: usize, columns: usize) -> (usize, usize) {
    let cells = 2 * MOST.0 * MOST.1 / maps.max(1);
    let rows = (cells * columns / MOST.0).clamp(40, 150);
    ((cells / rows).clamp(60, MOST.0 / columns), rows)
}

/// Name of an axis in traces, such as `x2`.
fn name(letter: &str, index: usize) -> String {
    if index == 0 { letter.to_owned() } else { format!("{letter}{}", index + 1) }
}

/// Name of an axis in the layout, such as `xaxis2`.
fn long(letter: &str, index: usize) -> String {
    if index == 0 { format!("{letter}axis") } else { format!("{letter}axis{}", index + 1) }
}
