//! Wear of the coating of the casing.

use super::axis::{Scale, eighths, label, significant, ticks};
use super::cells::rpm;
use super::diagram::Diagram;
use super::force_map::{NODES, node_ticks};
use super::pixels::Pixels;
use super::svg::{document, polyline};
use super::{colour_bar, heading};
use rubmap_analysis::result::{Point, WearMap};
use rubmap_wheel::dynamics::sector::Units;

const WIDTH: f64 = 1180.0;
const HEIGHT: f64 = 640.0;
const LEFT: f64 = 100.0;
const PLOT_WIDTH: f64 = 930.0;
const CURVE_HEIGHT: f64 = 130.0;

/// Message where there is no coating.
pub(super) const NO_COATING: &str = "Nothing to draw: there is no coating";

/// Title of the horizontal axis.
pub(super) const ANGLE: &str = "angle of the casing from the package's x axis, in the direction of rotation";

/// Draws the depth of wear over the angle of the casing and the contact nodes at the end of one speed, above it the deepest at each
/// angle.
pub fn wear_map(wear: &WearMap, point: &Point, units: &Units) -> String {
    let title = title(point);
    let (heading, bottom) = heading::heading(LEFT, &title, &[words(point, units)]);

    let scale_end = wear.depths.iter().map(|rod| deepest(rod)).fold(0.0, f64::max);
    let scale_end = if scale_end > 0.0 { scale_end } else { 1.0 };
    let nodes = wear.depths.iter().map(Vec::len).max().unwrap_or(0);
    let degrees = eighths();

    let top = bottom + 20.0;
    let size = (PLOT_WIDTH, CURVE_HEIGHT);
    let above = Diagram::new((LEFT, top), size, (0.0, 360.0), (0.0, 1.1 * scale_end));
    let corner = (LEFT, top + CURVE_HEIGHT + 16.0);
    let size = (PLOT_WIDTH, HEIGHT - 64.0 - corner.1);
    let diagram = Diagram::new(corner, size, (0.0, 360.0), (-0.5, nodes.max(1) as f64 - 0.5));
    if nodes == 0 {
        let content = vec![heading, diagram.frame(), diagram.words(NO_COATING)];
        return document(&title, WIDTH, HEIGHT, content);
    }
    let scale = Scale::linear((0.0, scale_end), (diagram.bottom(), diagram.top));
    let width = 360.0 / wear.depths.len() as f64;
    let mut pixels = Pixels::over(&diagram);
    for (rod, depths) in wear.depths.iter().enumerate() {
        let (from, to) = (width * rod as f64, width * (rod + 1) as f64);
        let x = (diagram.x.place(from), diagram.x.place(to));
        for (node, depth) in depths.iter().enumerate() {
            let y = (diagram.y.place(node as f64 + 0.5), diagram.y.place(node as f64 - 0.5));
            pixels.paint_area(x, y, if depth.is_finite() { scale.share(*depth) } else { 0.0 });
        }
    }
    let steps = wear.depths.iter().enumerate().flat_map(|(rod, depths)| {
        let (from, to, depth) = (width * rod as f64, width * (rod + 1) as f64, deepest(depths));
        [above.inside(from, depth), above.inside(to.min(360.0), depth)]
    });
    let y = ticks(above.y.values, 3.0);
    let content = vec![
        heading,
        above.grid(&degrees, &y),
        polyline(steps).set("class", "curve").set("stroke", "#1f4e79").set("stroke-width", "1.4"),
        above.frame(),
        above.y_axis(&y, &format!("deepest, {}", units.length), 72.0),
        pixels.draw(),
        diagram.frame(),
        diagram.x_axis(&degrees, ANGLE),
        diagram.y_axis(&node_ticks(nodes), NODES, 72.0),
        colour_bar::draw(
            &scale,
            diagram.right() + 26.0,
            &ticks(scale.values, 7.0),
            &format!("depth, {}", units.length),
        ),
    ];
    document(&title, WIDTH, HEIGHT, content)
}

/// Title: the speed of the wear.
pub(super) fn title(point: &Point) -> String {
    format!("Wear of the coating, {} rpm", label(rpm(point.speed_rad_s), 0))
}

/// Paragraph below the title: the volume removed, the largest depth, whether a tip met the metal, and the program version.
pub(super) fn words(point: &Point, units: &Units) -> String {
    let mut words = Vec::new();
    if let Some(report) = &point.wear {
        words.push(format!("{} {}³ removed", significant(report.removed_volume), units.length));
        words.push(format!("at most {} {} deep", significant(report.deepest), units.length));
        words.extend(report.reached_metal.then(|| "a tip met the metal behind it".to_owned()));
    }
    words.push(format!("rubmap {}", point.version));
    words.join(" · ")
}

/// Largest depth at an angle.
pub(super) fn deepest(rod: &[f64]) -> f64 {
    rod.iter().copied().filter(|depth| depth.is_finite()).fold(0.0, f64::max)
}
