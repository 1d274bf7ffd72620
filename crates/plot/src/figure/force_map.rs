//! Contact over speed and contact node.

use serde_json::json;

use super::attributes::Scatter;
use super::cells::{MOST, cells as coloured, linear, together};
use super::document::{Figure, axis, speeds};
use super::marks::{line, silent, words};
use super::palette::{CURVE, WARNING, colour, dash};
use super::text::escaped;
use crate::cells::{Cell, cells, extent};
use crate::force_map::{self as drawing, ForceQuantity, NODES, REACHES, largest, told};
use rubmap_analysis::result::{ForceMap, ForceRow};

/// Contact over speed and contact node, above it the worst node, the whole wheel, and the linear prediction where there are such numbers.
/// Speeds without a result are gaps. `customdata` of a cell is the speed in rad/s.
pub fn force_map(map: &ForceMap, quantity: ForceQuantity) -> Figure {
    let cells = cells(&map.speeds_rad_s);
    let rows = |cell: &Cell| map.rows.get(cell.index).and_then(Option::as_ref);
    let nodes = map.rows.iter().flatten().map(|row| quantity.of(row).len()).max().unwrap_or(0);
    let most = map.rows.iter().flatten().filter_map(|row| largest(quantity.of(row))).fold(0.0, f64::max);
    let one = together(cells.len(), MOST.0);
    let columns: Vec<&[Cell]> = cells.chunks(one).collect();
    let of = |column: &[Cell], node: usize| {
        let values = column.iter().filter_map(|cell| of_node(rows(cell)?, quantity, node));
        values.max_by(|a, b| a.total_cmp(b))
    };
    let value = |node: usize| -> Vec<f32> {
        columns.iter().map(|column| of(column, node).map_or(f32::NAN, |value| value as f32)).collect()
    };
    let speed = |column: &&[Cell]| column[column.len() / 2].rpm;
    let rad_s = |column: &&[Cell]| vec![(speed(column) * std::f64::consts::TAU / 60.0) as f32];
    let values: Vec<Vec<f32>> = (0..nodes).map(value).collect();
    let data = (0..nodes).map(|_| columns.iter().map(rad_s).collect()).collect();
    let words = format!(
        "%{{x:,.1f}} rpm (%{{customdata[0]:,.1f}} rad/s)<br>contact node %{{y}}<br>{}: %{{z:.4~g}}",
        escaped(&quantity.short(map))
    );
    let x = if let [[cell]] = columns[..] {
        vec![cell.from, cell.to]
    } else {
        columns.iter().map(speed).collect()
    };
    let y: Vec<f64> = (0..nodes).map(|node| node as f64).collect();
    let mut paragraphs = vec![drawing::words(map)];
    paragraphs.extend((one > 1).then(|| format!("{one} speeds are one cell with the largest")));
    let scale = (0.0, if most > 0.0 { most } else { 1.0 });
    let range = extent(&cells);
    Figure::new("forces", &drawing::title(quantity), &paragraphs)
        .high(640)
        .with(coloured((x, y), (values, data), &words, ("x", "y", "coloraxis")))
        .with_all(curves(map, &cells, quantity))
        .axis("xaxis", speeds().range(<[f64; 2]>::from(range)).anchor("y"))
        .axis("yaxis", axis(NODES).domain([0.0, 0.58]).range([-0.5, nodes.max(1) as f64 - 0.5]))
        .axis("yaxis2", axis(&quantity.short(map)).domain([0.66, 1.0]).rangemode("tozero").anchor("x"))
        .attribute("coloraxis", linear(scale, &quantity.short(map), (0.0, 0.58)))
        .meta("units", json!({"x": "rpm", "y": "contact_node"}))
        .meta("speeds_rpm", cells.iter().map(|cell| cell.rpm).collect::<Vec<f64>>())
        .meta("speed_indices", cells.iter().map(|cell| cell.index).collect::<Vec<usize>>())
}

/// Value of a contact node at one speed, if it is known.
fn of_node(row: &ForceRow, quantity: ForceQuantity, node: usize) -> Option<f64> {
    quantity.of(row).get(node).copied().filter(|value| value.is_finite())
}

/// Traces of the wheel over speed.
fn curves(map: &ForceMap, cells: &[Cell], quantity: ForceQuantity) -> Vec<Scatter> {
    let all = drawing::curves(map, quantity);
    let count = all.len();
    let trace = |(index, (name, _, value)): (usize, drawing::Curve)| {
        let of = |cell: &Cell| value(map.rows.get(cell.index)?.as_ref()?);
        let places = cells.iter().map(|cell| Some((cell.rpm, of(cell)?)));
        let words_of = |cell: &Cell| of(cell).map_or_else(String::new, |value| told(cell.rpm, name, value));
        let colour = if count == 1 { CURVE.to_owned() } else { colour(index, count) };
        let trace =
            words(line(name, places, (&colour, dash(index), 1.6)), cells.iter().map(words_of).collect());
        // A speed between two without results has no line, so marks are needed.
        trace.mode("lines+markers").yaxis("y2")
    };
    let mut traces: Vec<_> = all.into_iter().enumerate().map(trace).collect();
    if quantity == ForceQuantity::Consumption {
        let (slow, fast) = extent(cells);
        let limit = [Some((slow, 1.0)), Some((fast, 1.0))];
        traces.push(silent(REACHES, limit, (WARNING, "dash", 1.2)).yaxis("y2"));
    }
    traces
}
