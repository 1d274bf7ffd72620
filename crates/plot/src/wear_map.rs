//! Wear of the coating of the casing.

use super::axis::{label, significant};
use super::cells::rpm;
use super::colour;
use super::drawing::Drawing;
use super::force_map::{NODES, node_bands, node_ticks};
use super::layer::{Band, Cells, Curve};
use super::sketch::{Axis, Panel, Sketch};
use super::style::{Colour, Dash, Pen};
use rubmap_analysis::result::{Point, WearMap};
use rubmap_wheel::dynamics::sector::Units;
use serde_json::json;

/// Depth of wear over the angle of the casing and the contact nodes at the end of one speed, above it the deepest at each angle.
pub fn wear_map(wear: &WearMap, point: &Point, units: &Units) -> Drawing<'static> {
    let title = format!("Wear of the coating, {} rpm", label(rpm(point.speed_rad_s), 0));
    let sketch = Sketch::new("wear", title, vec![words(point, units)]).high(600);
    let sketch = sketch
        .meta("speed_index", point.index)
        .meta("speed_rpm", rpm(point.speed_rad_s))
        .meta("units", json!({"x": "degree", "y": "contact_node", "depth": units.length}));
    let nodes = wear.depths.iter().map(Vec::len).max().unwrap_or(0);
    if nodes == 0 {
        return sketch.nothing("Nothing to draw: there is no coating").into();
    }
    let most = wear.depths.iter().map(|rod| deepest(rod)).fold(0.0, f64::max);
    let most = if most > 0.0 { most } else { 1.0 };
    let width = 360.0 / wear.depths.len() as f64;
    let stretch = |rod: usize| (width * rod as f64, (width * (rod + 1) as f64).min(360.0));
    let angle = "angle of the casing from the package's x axis, in the direction of rotation";
    let range = (-0.5, nodes as f64 - 0.5);
    let y = Axis::linear(NODES, range, 8.0).ticks(node_ticks(nodes));
    let top = sketch.top() + 20.0;
    let map = Panel::new((92.0, top + 146.0), (938.0, 430.0 - top), Axis::turn(angle), y);
    let mut map =
        map.domain(0.0, 0.62).ramp(format!("depth, {}", units.length), (0.0, most), colour::amplitude);
    let column = |rod: usize| {
        let (from, to) = stretch(rod);
        Band { from, to, value: 0.5 * (from + to) }
    };
    let row =
        |node: usize| wear.depths.iter().map(|rod| Some(rod.get(node).copied().unwrap_or(0.0))).collect();
    map.push(Cells {
        columns: (0..wear.depths.len()).map(column).collect(),
        rows: node_bands(nodes),
        values: (0..nodes).map(row).collect(),
        hover: vec!["%{x:.1f}°, contact node %{y}".to_owned(), format!("%{{z:.4~g}} {}", units.length)],
        has_speeds: false,
        merged: "places around the casing are one cell with the deepest",
        data: Vec::new(),
    });
    let y = Axis::linear(format!("deepest, {}", units.length), (0.0, 1.1 * most), 3.0).with_zero();
    let above = Panel::new((92.0, top), (938.0, 130.0), Axis::turn(angle), y);
    let mut above = above.domain(0.7, 1.0);
    let steps = wear.depths.iter().enumerate().flat_map(|(rod, depths)| {
        let ((from, to), depth) = (stretch(rod), deepest(depths));
        [Some((from, depth)), Some((to, depth))]
    });
    let curve = Curve::new("deepest", steps, Pen::new(Colour::curve(), Dash::Solid, 1.4)).class("curve");
    above.push(curve.over("", format!("%{{x:.1f}}°: %{{y:.4~g}} {}", units.length)).unlisted());
    sketch.with(map).with(above).into()
}

/// Paragraph below the title: the volume removed, the largest depth, whether a tip met the metal, and the program version.
fn words(point: &Point, units: &Units) -> String {
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
fn deepest(rod: &[f64]) -> f64 {
    rod.iter().copied().filter(|depth| depth.is_finite()).fold(0.0, f64::max)
}
