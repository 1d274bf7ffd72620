//! Drawings that are not yet sketched: one function draws the SVG, another makes the figure.

use super::drawing::Drawing;
use super::figure;
use super::level::LevelColour;
use super::map_view::VerticalAxis;
use super::window::Window;
use rubmap_analysis::result::{Campbell, CriticalSpeeds, InteractionMap};

/// Draws an interaction map or a window of it, with its critical speeds and the linear prediction where they are given.
pub fn interaction_map<'a>(
    map: &'a InteractionMap,
    critical: Option<CriticalSpeeds>,
    campbell: Option<&'a Campbell>,
    axis: VerticalAxis,
    window: Window,
    colour: LevelColour,
) -> Drawing<'a> {
    let shown = critical.clone();
    let svg = move || {
        super::interaction_map::interaction_map(map, critical.as_ref(), campbell, axis, window, colour)
    };
    Drawing::twice(svg, move || figure::interaction_map(map, shown.as_ref(), campbell, axis, window, colour))
}

/// Draws a map whose rows are in the fixed frame (`rubmap_analysis::run::fixed_frame_row`), or a window of it.
pub fn fixed_frame_map(
    map: &InteractionMap,
    critical: Option<CriticalSpeeds>,
    axis: VerticalAxis,
    window: Window,
    colour: LevelColour,
) -> Drawing<'_> {
    let shown = critical.clone();
    let svg = move || super::interaction_map::fixed_frame_map(map, critical.as_ref(), axis, window, colour);
    Drawing::twice(svg, move || figure::fixed_frame_map(map, shown.as_ref(), axis, window, colour))
}

/// Draws the same window of several maps, a panel each.
pub fn map_sheet(maps: &[InteractionMap], window: Window, colour: LevelColour) -> Drawing<'_> {
    let svg = move || super::map_sheet::map_sheet(maps, window, colour);
    Drawing::twice(svg, move || figure::map_sheet(maps, window, colour))
}
