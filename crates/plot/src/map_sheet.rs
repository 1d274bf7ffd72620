//! Sheet of interaction maps, one per nodal diameter: the paper's Figs 12 to 14.

use super::axis::{Scale, label, logarithmic_ticks, ticks};
use super::cells::{cells, range};
use super::frame::Frame;
use super::key::Flow;
use super::level::LevelColour;
use super::map_view::{End, QUIETEST, VerticalAxis, View, is_missing};
use super::svg::{Element, document, group, text};
use super::window::Window;
use super::{colour_bar, hatching, heading, heat, margin};
use rubmap_analysis::result::InteractionMap;

const WIDTH: f64 = 1180.0;
const LEFT: f64 = 84.0;
/// Left edge of the colour bar.
const BAR: f64 = 1076.0;
const GAP: (f64, f64) = (58.0, 84.0);
const PANEL_HEIGHT: f64 = 232.0;
/// Height of the strip above a panel.
const STRIP: f64 = 7.0;

/// Message where there is no map.
pub(super) const NO_MAP: &str = "Nothing to draw: no map is given";

/// Draws the same window of several maps, a panel each with a common colour scale: maps of one sensor, restricted to nodal diameters.
///
/// With the colours of utilisation there is a strip of them above each map.
pub(super) fn map_sheet(maps: &[InteractionMap], window: Window, level_colour: LevelColour) -> String {
    let title = title(maps);
    let words = words(maps);
    let (heading, bottom) = heading::heading(LEFT, &title, &[words]);
    let Some(first) = maps.first() else {
        let empty = text(LEFT, bottom + 40.0, "start", NO_MAP).set("class", "empty");
        return document(&title, WIDTH, 160.0, vec![heading, empty]);
    };
    let columns = if maps.len() > 4 { 3 } else { maps.len().min(2) };
    let width = (BAR - 44.0 - LEFT - GAP.0 * (columns - 1) as f64) / columns as f64;
    let rows = maps.len().div_ceil(columns);
    let top = bottom + 42.0;
    let loudest = maps.iter().filter_map(|map| heat::loudest(map, &window)).fold(0.0, f64::max);
    let loudest = (loudest > 0.0).then_some(loudest);
    let mut content = vec![hatching::definition(), heading];
    let (mut missing, mut ends) = (false, Vec::new());
    for (index, map) in maps.iter().enumerate() {
        let (row, column) = (index / columns, index % columns);
        let left = LEFT + column as f64 * (width + GAP.0);
        let corner = (left, top + row as f64 * (PANEL_HEIGHT + GAP.1));
        let cells = cells(&map.speeds_rad_s);
        let place = (corner, (width, PANEL_HEIGHT));
        let view = View::new(map, &cells, None, (VerticalAxis::EngineOrder, Frame::Rotating), &window, place);
        let (low, high) = view.diagram.x.values;
        missing |= cells.iter().any(|cell| cell.to > low && cell.from < high && is_missing(map, cell));
        ends.extend(view.engine_orders(map).1);
        let below = index + columns >= maps.len();
        content.push(panel(map, &view, loudest, (column == 0, below)));
        if level_colour == LevelColour::Utilisation {
            content.push(margin::strip(map, &cells, &view.diagram, STRIP));
        }
    }
    if let Some(loudest) = loudest {
        let foot = top + rows as f64 * (PANEL_HEIGHT + GAP.1) - GAP.1;
        let scale = Scale::logarithmic((QUIETEST * loudest, loudest), (foot, top));
        let ticks = logarithmic_ticks(scale.values);
        let words = format!("amplitude, {}", first.sensor.unit(&first.units));
        content.push(colour_bar::draw(&scale, BAR, &ticks, &words));
    }
    let foot = top + rows as f64 * (PANEL_HEIGHT + GAP.1) - 12.0;
    let flow = key(first, &ends, foot, missing, level_colour);
    let height = f64::max(foot + 30.0, flow.bottom() + 18.0);
    content.push(flow.draw());
    document(&title, WIDTH, height, content)
}

/// Draws a map with its name; axes have titles only at the left and the lower edge of the sheet.
fn panel(
    map: &InteractionMap,
    view: &View,
    loudest: Option<f64>,
    (leftmost, below): (bool, bool),
) -> Element {
    let diagram = &view.diagram;
    let cells = cells(&map.speeds_rad_s);
    let name = name(map);
    let x = ticks(diagram.x.values, (diagram.width / 95.0).max(2.0));
    let y = ticks(diagram.y.values, 8.0);
    group()
        .set("class", "panel")
        .child(text(diagram.left, diagram.top - 8.0 - STRIP, "start", &name).set("font-weight", "bold"))
        .child(view.amplitudes(map, &cells, loudest))
        .child(view.engine_orders(map).0)
        .child(diagram.frame())
        .child(diagram.x_axis(&x, if below { "rotational speed Ω, rpm" } else { "" }))
        .child(diagram.y_axis(&y, if leftmost { "engine order k" } else { "" }, 46.0))
}

/// Name of a map in a sheet: its nodal diameter.
pub(super) fn name(map: &InteractionMap) -> String {
    match map.nodal_diameter {
        Some(i) => format!("nodal diameter {i}"),
        None => "all nodal diameters".to_owned(),
    }
}

fn key(first: &InteractionMap, ends: &[End], y: f64, missing: bool, level_colour: LevelColour) -> Flow {
    let mut flow = View::explained(Flow::new(LEFT, WIDTH - 20.0, y), first, ends);
    if level_colour == LevelColour::Utilisation {
        flow = margin::explained(flow, first, &cells(&first.speeds_rad_s));
    }
    if missing { flow.entry(hatching::mark(), 20.0, "no result") } else { flow }
}

pub(super) fn title(maps: &[InteractionMap]) -> String {
    match maps.first() {
        Some(map) => format!("Maps by nodal diameter: {}", map.sensor),
        None => "Maps by nodal diameter".to_owned(),
    }
}

/// Paragraph below the title: numbers of results and speeds, and the origin.
pub(super) fn words(maps: &[InteractionMap]) -> String {
    let Some(map) = maps.first() else { return String::new() };
    let computed = map.amplitude.iter().flatten().count();
    let (slow, fast) = range(&map.speeds_rad_s);
    let speeds =
        format!("{} speeds from {} to {} rpm", map.speeds_rad_s.len(), label(slow, 0), label(fast, 0));
    let origin = heading::origin(&map.settings.model, &map.version);
    format!("{computed} of {speeds} · one scale of colours for all · {origin}")
}
