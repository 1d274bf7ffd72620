//! Wear of the coating of the casing.

use serde_json::json;

use super::cells::{MOST, cells, linear, together};
use super::document::{Figure, axis};
use super::marks::{line, template};
use super::palette::CURVE;
use super::text::escaped;
use crate::cells::rpm;
use crate::force_map::NODES;
use crate::wear_map::{self as drawing, ANGLE, NO_COATING, deepest};
use rubmap_analysis::result::{Point, WearMap};
use rubmap_wheel::dynamics::sector::Units;

/// Depth of wear over the angle of the casing and the contact nodes at the end of one speed, above it the deepest at each angle.
pub fn wear_map(wear: &WearMap, point: &Point, units: &Units) -> Figure {
    let nodes = wear.depths.iter().map(Vec::len).max().unwrap_or(0);
    let one = together(wear.depths.len(), MOST.0);
    let mut paragraphs = vec![drawing::words(point, units)];
    paragraphs
        .extend((one > 1).then(|| format!("{one} places around the casing are one cell with the deepest")));
    let figure = Figure::new("wear", &drawing::title(point), &paragraphs)
        .meta("speed_index", point.index)
        .meta("speed_rpm", rpm(point.speed_rad_s))
        .meta("units", json!({"x": "degree", "y": "contact_node", "depth": units.length}));
    if nodes == 0 {
        return figure.empty(NO_COATING);
    }
    let width = 360.0 / wear.depths.len() as f64;
    let columns: Vec<&[Vec<f64>]> = wear.depths.chunks(one).collect();
    let middle = |column: usize| width * (one * column) as f64 + 0.5 * width * columns[column].len() as f64;
    let at = |column: &[Vec<f64>], node: usize| {
        let depths = column.iter().filter_map(|rod| rod.get(node)).filter(|depth| depth.is_finite());
        depths.fold(0.0, |deepest: f64, depth| deepest.max(*depth)) as f32
    };
    let values = (0..nodes).map(|node| columns.iter().map(|column| at(column, node)).collect()).collect();
    let most = wear.depths.iter().map(|rod| deepest(rod)).fold(0.0, f64::max);
    let length = escaped(&units.length);
    let x: Vec<f64> = (0..columns.len()).map(middle).collect();
    let curve = columns
        .iter()
        .zip(&x)
        .map(|(column, x)| Some((*x, column.iter().map(|rod| deepest(rod)).fold(0.0, f64::max))));
    let curve = line("deepest", curve, (CURVE, "solid", 1.6));
    let curve = curve.hovertemplate(template(&format!("%{{x:.1f}}°: %{{y:.4~g}} {length}")));
    let y = (0..nodes).map(|node| node as f64).collect();
    let told = format!("%{{x:.1f}}°, contact node %{{y}}<br>%{{z:.4~g}} {length}");
    let scale = (0.0, if most > 0.0 { most } else { 1.0 });
    figure
        .high(600)
        .with(cells((x, y), (values, Vec::new()), &told, ("x", "y", "coloraxis")))
        .with(curve.yaxis("y2").showlegend(false))
        .axis("xaxis", axis(ANGLE).range([0.0, 360.0]).dtick(45.0).ticksuffix("°").anchor("y"))
        .axis("yaxis", axis(NODES).domain([0.0, 0.62]).range([-0.5, nodes as f64 - 0.5]))
        .axis(
            "yaxis2",
            axis(&format!("deepest, {}", units.length)).domain([0.7, 1.0]).rangemode("tozero").anchor("x"),
        )
        .attribute("coloraxis", linear(scale, &format!("depth, {}", units.length), (0.0, 0.62)))
}
