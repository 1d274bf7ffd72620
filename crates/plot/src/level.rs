//! Level of the response over speed, above the map.

use super::axis::{significant, ticks};
use super::cells::Cell;
use super::diagram::Diagram;
use super::svg::{Element, group, line, polyline};
use super::{margin, validity};
use rubmap_analysis::result::InteractionMap;

const COLOUR: &str = "#1f4e79";

/// Colouring of the level of a map.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LevelColour {
    /// Plain curve without colours.
    Plain,
    /// Largest utilisation at each speed, as colours below the curve; labels of critical speeds have theirs.
    Utilisation,
}

/// Root mean square of the map's sensor about its mean, at the speed with this index.
pub(super) fn rms(map: &InteractionMap, index: usize) -> Option<f64> {
    let point = map.points.iter().find(|point| point.index as usize == index)?;
    let response = point.responses.iter().find(|response| response.sensor == map.sensor)?;
    response.rms.is_finite().then_some(response.rms)
}

/// Empty diagram of the level.
pub(super) fn diagram(
    map: &InteractionMap,
    cells: &[Cell],
    speeds: (f64, f64),
    corner: (f64, f64),
    size: (f64, f64),
) -> Diagram {
    let shown = cells.iter().filter(|cell| (speeds.0..=speeds.1).contains(&cell.rpm));
    let highest = shown.filter_map(|cell| rms(map, cell.index)).fold(0.0, f64::max);
    let top = if highest > 0.0 { 1.12 * highest } else { 1.0 };
    Diagram::new(corner, size, speeds, (0.0, top))
}

/// Draws the level and its axis.
pub(super) fn draw(map: &InteractionMap, cells: &[Cell], diagram: &Diagram, by: LevelColour) -> Element {
    let ticks = ticks(diagram.y.values, 4.0);
    let grid = ticks.iter().skip(1).map(|(value, _)| {
        let y = diagram.y.place(*value);
        line((diagram.left, y), (diagram.right(), y)).set("stroke", "#e4e4e4")
    });
    let area = (by == LevelColour::Utilisation)
        .then(|| margin::area(map, cells, diagram, |cell| rms(map, cell.index)));
    let points: Vec<_> = cells
        .iter()
        .map(|cell| {
            let place = |rms| Some((diagram.inside(cell.rpm, rms)?, rms));
            (cell, rms(map, cell.index).and_then(place))
        })
        .collect();
    let curve = polyline(points.iter().map(|(_, point)| point.map(|(place, _)| place)))
        .set("stroke", COLOUR)
        .set("stroke-width", "1.6")
        .set("stroke-linejoin", "round");
    // Dots shrink with their number: dots that touch add nothing to the curve.
    let radius = (0.25 * diagram.width / points.len().max(1) as f64).clamp(0.8, 2.6);
    let dots = points.iter().filter_map(|(cell, point)| {
        let ((x, y), rms) = (*point)?;
        let verdict = validity::point(map, cell.index).and_then(|point| point.validity_verdict());
        let colour = verdict.and_then(validity::colour);
        let dot = Element::new("circle").number("cx", x).number("cy", y);
        let dot = dot.number("r", colour.map_or(radius, |_| radius.max(2.0)));
        Some(dot.set("fill", colour.unwrap_or(COLOUR)).title(&words(map, cell, rms)))
    });
    group()
        .child(diagram.background("white"))
        .children(grid)
        .children(area)
        .child(curve)
        .children(dots)
        .child(diagram.y_axis(&ticks, &axis(map), 58.0))
}

/// Title of the axis of the level.
pub(super) fn axis(map: &InteractionMap) -> String {
    format!("level, {} rms", map.sensor.unit(&map.units))
}

/// Words for the level of a speed, with the verdict on linear theory there.
pub(super) fn words(map: &InteractionMap, cell: &Cell, rms: f64) -> String {
    let point = validity::point(map, cell.index);
    let reason = point.and_then(|point| validity::reason(point.validity.as_ref()?));
    let reason = reason.map_or_else(String::new, |reason| format!(", {reason}"));
    format!("{:.0} rpm: {} {} rms{reason}", cell.rpm, significant(rms), map.sensor.unit(&map.units))
}
