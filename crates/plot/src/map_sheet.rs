//! Sheet of interaction maps, one per nodal diameter: the paper's Figs 12 to 14.

use super::axis::label;
use super::cells::{cells, range, within};
use super::drawing::Drawing;
use super::frame::Frame;
use super::heat::{self, Heat};
use super::level::LevelColour;
use super::map_view::{QUIETEST, VerticalAxis, View};
use super::merged::MOST;
use super::sketch::{Axis, Panel, Sketch, Stand};
use super::window::Window;
use super::{hatching, heading, map_lines, margin};
use rubmap_analysis::result::InteractionMap;
use serde_json::json;

const LEFT: f64 = 84.0;
/// Left edge of the colour bar, and its distance from the maps.
const BAR: f64 = 1076.0;
const BESIDE: f64 = 44.0;
const GAP: (f64, f64) = (58.0, 84.0);
const PANEL_HEIGHT: f64 = 232.0;

/// Message where there is no map.
const NO_MAP: &str = "Nothing to draw: no map is given";

/// Draws the same window of several maps, a panel each with a common colour scale and axes that move together: maps of one sensor, restricted
/// to nodal diameters.
///
/// With the colours of utilisation each map has a strip of them along its upper edge.
pub fn map_sheet(maps: &[InteractionMap], window: Window, level_colour: LevelColour) -> Drawing<'_> {
    let sketch = Sketch { left: LEFT, ..Sketch::new("map_sheet", title(maps), vec![words(maps)]) };
    let Some(first) = maps.first() else { return sketch.nothing(NO_MAP).into() };
    let loudest = maps.iter().filter_map(|map| heat::loudest(map, &window)).fold(0.0, f64::max);
    let sheet = Sheet::new(maps.len(), sketch.top() + 42.0, (loudest > 0.0).then_some(loudest));
    let (mut panels, mut merged, mut has_missing) = (Vec::new(), None, false);
    for (index, map) in maps.iter().enumerate() {
        let heat = sheet.heat(index, map, &window);
        merged = merged.or_else(|| heat.merged());
        has_missing |= map_lines::has_missing(map, &heat.cells, &heat.view);
        panels.push(sheet.panel(index, heat, level_colour));
    }
    let all = cells(&first.speeds_rad_s);
    if let Some(lowest) = panels.get_mut(sheet.drawn.columns * (sheet.drawn.rows() - 1)) {
        lowest.stand = Stand::Below;
        map_lines::explain_orders(lowest);
        if level_colour == LevelColour::Utilisation {
            margin::explain(first, &all, lowest);
        }
        if has_missing {
            lowest.wide_sample(hatching::mark(), 20.0, "no result");
        }
    }
    let (unit, range) = (first.sensor.unit(&first.units), sheet.range());
    Sketch { panels, high: 160 + 230 * sheet.shown.rows(), ..sketch }
        .meta("sensor", first.sensor)
        .meta("units", json!({"x": "rpm", "y": "engine_order", "amplitude": unit}))
        .meta("nodal_diameters", maps.iter().map(|map| map.nodal_diameter).collect::<Vec<_>>())
        .meta("speeds_rpm", all.iter().map(|cell| cell.rpm).collect::<Vec<f64>>())
        .meta("speed_indices", all.iter().map(|cell| cell.index).collect::<Vec<usize>>())
        .meta("thinned", merged)
        .meta("amplitude", json!({"z": "log10", "linear": "customdata[row][column][0]", "range": range}))
        .into()
}

/// Layout of the maps, and their common scale of colours.
struct Sheet {
    /// Places in the drawing and in the figure.
    drawn: Grid,
    shown: Grid,
    /// Height in the drawing at which the maps begin.
    top: f64,
    /// Loudest amplitude, if anything moves.
    loudest: Option<f64>,
}

impl Sheet {
    fn new(count: usize, top: f64, loudest: Option<f64>) -> Self {
        let drawn = Grid { count, columns: if count > 4 { 3 } else { count.min(2) } };
        let shown = Grid { count, columns: if count > 3 { 2 } else { 1 } };
        Self { drawn, shown, top, loudest }
    }

    /// Range of the colours. Maps without motion are as quiet as the colours go.
    fn range(&self) -> (f64, f64) {
        let loudest = self.loudest.unwrap_or(1.0);
        (QUIETEST * loudest, loudest)
    }

    /// Amplitudes of a map in its place.
    fn heat<'a>(&self, index: usize, map: &'a InteractionMap, window: &Window) -> Heat<'a> {
        let columns = self.drawn.columns as f64;
        let width = (BAR - BESIDE - LEFT - GAP.0 * (columns - 1.0)) / columns;
        let (row, column) = self.drawn.place(index);
        let corner = (LEFT + column as f64 * (width + GAP.0), self.top + row as f64 * (PANEL_HEIGHT + GAP.1));
        let cells = cells(&map.speeds_rad_s);
        let seen = (VerticalAxis::EngineOrder, Frame::Rotating);
        let view = View::new(map, &cells, None, seen, window, (corner, (width, PANEL_HEIGHT)));
        Heat { map, cells, view, most: self.shown.share() }
    }

    /// Panel of a map with its name; axes have titles only at the left and the lower edge of the sheet.
    fn panel<'a>(&self, index: usize, heat: Heat<'a>, level_colour: LevelColour) -> Panel<'a> {
        let (map, view) = (heat.map, heat.view);
        let diagram = &view.diagram;
        let below = |grid: &Grid, words: &'static str| if grid.is_lowest(index) { words } else { "" };
        let beside = |grid: &Grid| if grid.place(index).1 == 0 { view.axis_words() } else { "" };
        let wanted = (diagram.width / 95.0).max(2.0);
        let x = Axis::linear(below(&self.drawn, "rotational speed Ω, rpm"), diagram.x.values, wanted);
        let y = Axis::linear(beside(&self.drawn), diagram.y.values, 8.0).away(46.0);
        let (x, y) = (x.short(below(&self.shown, "Ω, rpm")), y.short(beside(&self.shown)));
        let [across, upwards] = self.shown.extents(index);
        let (corner, size) = ((diagram.left, diagram.top), (diagram.width, diagram.height));
        let panel = Panel::new(corner, size, x, y).aside(across, upwards);
        let title = format!("amplitude, {}", map.sensor.unit(&map.units));
        let mut panel = panel.amplitudes(title, self.range(), self.loudest.map(|_| BESIDE));
        panel.name = Some(name(map));
        if index == 0 {
            panel.push(hatching::definition());
        }
        panel.push(map_lines::background(map, &heat.cells, diagram));
        let strips = match level_colour {
            LevelColour::Utilisation => {
                margin::areas(map, within(&heat.cells, diagram.x.values), |_| Some(None))
            }
            LevelColour::Plain => Vec::new(),
        };
        panel.push(heat);
        map_lines::engine_orders(map, &view).into_iter().for_each(|curve| panel.push(curve));
        strips.into_iter().for_each(|areas| panel.push(areas));
        panel
    }
}

/// Maps in rows of so many columns, from the upper left corner.
struct Grid {
    count: usize,
    columns: usize,
}

impl Grid {
    fn rows(&self) -> usize {
        self.count.div_ceil(self.columns)
    }

    /// Row and column of a map.
    fn place(&self, index: usize) -> (usize, usize) {
        (index / self.columns, index % self.columns)
    }

    /// Whether there is no map below this one.
    fn is_lowest(&self, index: usize) -> bool {
        index + self.columns >= self.count
    }

    /// Largest numbers of speeds and rows of each map in the figure: all maps together have the cells of two large ones.
    fn share(&self) -> (usize, usize) {
        let cells = 2 * MOST.0 * MOST.1 / self.count.max(1);
        let rows = (cells * self.columns / MOST.0).clamp(40, 150);
        ((cells / rows).clamp(60, MOST.0 / self.columns), rows)
    }

    /// Horizontal and vertical extent of a map in the figure, with room for the labels of its axes and its name.
    fn extents(&self, index: usize) -> [[f64; 2]; 2] {
        let (row, column) = self.place(index);
        let (wide, high) = (1.0 / self.columns as f64, 1.0 / self.rows() as f64);
        let left = wide * column as f64 + if column > 0 { 0.06 } else { 0.0 };
        let right = wide * (column + 1) as f64 - if column + 1 < self.columns { 0.02 } else { 0.0 };
        let foot = 1.0 - high * (row + 1) as f64;
        let room = if row + 1 < self.rows() { 0.25 * high } else { 0.0 };
        [[left, right], [foot + room, foot + 0.92 * high]]
    }
}

/// Name of a map in a sheet: its nodal diameter.
fn name(map: &InteractionMap) -> String {
    match map.nodal_diameter {
        Some(i) => format!("nodal diameter {i}"),
        None => "all nodal diameters".to_owned(),
    }
}

/// Title: the sensor of the maps.
fn title(maps: &[InteractionMap]) -> String {
    match maps.first() {
        Some(map) => format!("Maps by nodal diameter: {}", map.sensor),
        None => "Maps by nodal diameter".to_owned(),
    }
}

/// Paragraph below the title: numbers of results and speeds, and the origin.
fn words(maps: &[InteractionMap]) -> String {
    let Some(map) = maps.first() else { return String::new() };
    let computed = map.amplitude.iter().flatten().count();
    let (slow, fast) = range(&map.speeds_rad_s);
    let speeds =
        format!("{} speeds from {} to {} rpm", map.speeds_rad_s.len(), label(slow, 0), label(fast, 0));
    let origin = heading::origin(&map.settings.model, &map.version);
    format!("{computed} of {speeds} · one scale of colours for all · {origin}")
}
