//! Contact over speed and contact node.

use super::axis::significant;
use super::cells::{Cell, cells, extent};
use super::drawing::Drawing;
use super::layer::{Band, Cells, Curve};
use super::sketch::{Axis, Panel, Sketch};
use super::style::{Colour, Dash, Look, Pen, Symbol};
use super::{colour, hatching, heading};
use rubmap_analysis::result::{ForceMap, ForceRow};
use serde_json::json;

/// Contact quantity of a force map; each contact node has the value of its worst blade.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ForceQuantity {
    /// Largest force.
    Peak,
    /// Impulse per revolution.
    Impulse,
    /// Share of time in contact.
    Share,
    /// Largest share of the clearance that the motion takes up.
    Consumption,
}

impl ForceQuantity {
    /// Values of all contact nodes at one speed.
    fn of(self, row: &ForceRow) -> &[f64] {
        match self {
            Self::Peak => &row.peak_force,
            Self::Impulse => &row.impulse_per_revolution,
            Self::Share => &row.contact_share,
            Self::Consumption => &row.clearance_consumption,
        }
    }

    fn words(self) -> &'static str {
        match self {
            Self::Peak => "largest contact force",
            Self::Impulse => "contact impulse per revolution",
            Self::Share => "share of time in contact",
            Self::Consumption => "largest share of the clearance that motion takes",
        }
    }

    fn unit(self, map: &ForceMap) -> String {
        match self {
            Self::Peak => format!(", {}", map.units.force),
            Self::Impulse => format!(", {}·{}", map.units.force, map.units.time),
            Self::Share | Self::Consumption => String::new(),
        }
    }

    /// Title of the colour bar.
    fn short(self, map: &ForceMap) -> String {
        let words = match self {
            Self::Peak => "force",
            Self::Impulse => "impulse",
            Self::Share => "share of time",
            Self::Consumption => "share of the clearance",
        };
        format!("{words}{}", self.unit(map))
    }
}

/// Curve over speed: its words and its value.
type Curved = (&'static str, fn(&ForceRow) -> Option<f64>);

/// Curves of the wheel above the map that have values; the first is the worst node of the map.
fn curves(map: &ForceMap, quantity: ForceQuantity) -> Vec<Curved> {
    let known = |(_, value): &Curved| map.rows.iter().flatten().any(|row| value(row).is_some());
    all_curves(quantity).into_iter().filter(known).collect()
}

fn all_curves(quantity: ForceQuantity) -> Vec<Curved> {
    let worst: Curved = match quantity {
        ForceQuantity::Peak => ("worst node", |row| largest(&row.peak_force)),
        ForceQuantity::Impulse => ("worst node", |row| largest(&row.impulse_per_revolution)),
        ForceQuantity::Share => ("worst node", |row| largest(&row.contact_share)),
        ForceQuantity::Consumption => ("worst node", |row| largest(&row.clearance_consumption)),
    };
    match quantity {
        ForceQuantity::Peak => vec![
            worst,
            ("whole wheel, peak", |row| Some(row.summary.peak_force)),
            ("whole wheel, mean", |row| Some(row.summary.mean_force)),
        ],
        ForceQuantity::Consumption => {
            vec![worst, ("linear calculation", |row| row.summary.linear_clearance_consumption)]
        }
        ForceQuantity::Impulse | ForceQuantity::Share => vec![worst],
    }
}

/// Words for the line at a consumption of 1.
const REACHES: &str = "1: reaches the undeformed casing";

/// Title of the axis of contact nodes.
pub(super) const NODES: &str = "contact node (0: leading edge)";

fn largest(values: &[f64]) -> Option<f64> {
    values.iter().copied().filter(|value| value.is_finite()).max_by(f64::total_cmp)
}

/// Contact over speed and contact node, above it the worst node, the whole wheel, and the linear prediction where there are such numbers.
pub fn force_map(map: &ForceMap, quantity: ForceQuantity) -> Drawing<'static> {
    let cells = cells(&map.speeds_rad_s);
    let title = format!("Contact over speed: {}", quantity.words());
    let sketch = Sketch::new("forces", title, vec![words(map)]).high(640);
    let top = sketch.top() + 20.0;
    let mut below = nodes(map, &cells, quantity, top + 186.0);
    let above = over_speed(map, &cells, quantity, (top, &mut below));
    let is_missing = |cell: &Cell| map.rows.get(cell.index).is_none_or(Option::is_none);
    if cells.iter().any(is_missing) {
        below.sample(hatching::mark(), "no result");
    }
    sketch
        .meta("units", json!({"x": "rpm", "y": "contact_node"}))
        .meta("speeds_rpm", cells.iter().map(|cell| cell.rpm).collect::<Vec<f64>>())
        .meta("speed_indices", cells.iter().map(|cell| cell.index).collect::<Vec<usize>>())
        .with(below)
        .with(above)
        .into()
}

/// Panel of the contact nodes.
fn nodes(map: &ForceMap, cells: &[Cell], quantity: ForceQuantity, top: f64) -> Panel<'static> {
    let nodes = map.rows.iter().flatten().map(|row| quantity.of(row).len()).max().unwrap_or(0);
    let most = map.rows.iter().flatten().filter_map(|row| largest(quantity.of(row))).fold(0.0, f64::max);
    let y = Axis::linear(NODES, (-0.5, nodes.max(1) as f64 - 0.5), 8.0).ticks(node_ticks(nodes));
    let panel = Panel::new((92.0, top), (938.0, 340.0), Axis::speeds(extent(cells), 9.0), y).key_below();
    let range = (0.0, if most > 0.0 { most } else { 1.0 });
    let mut panel = panel.domain(0.0, 0.58).ramp(quantity.short(map), range, colour::amplitude);
    panel.push(hatching::definition());
    panel.push(panel.diagram.background(hatching::FILL));
    let value =
        |cell: &Cell, node: usize| quantity.of(map.rows.get(cell.index)?.as_ref()?).get(node).copied();
    panel.push(Cells {
        columns: cells.iter().map(|cell| Band { from: cell.from, to: cell.to, value: cell.rpm }).collect(),
        rows: node_bands(nodes),
        values: (0..nodes).map(|node| cells.iter().map(|cell| value(cell, node)).collect()).collect(),
        hover: vec![
            "%{x:,.1f} rpm (%{customdata[0]:,.1f} rad/s)".to_owned(),
            "contact node %{y}".to_owned(),
            format!("{}: %{{z:.4~g}}", quantity.short(map)),
        ],
        has_speeds: true,
        merged: "speeds are one cell with the largest",
        data: Vec::new(),
    });
    panel
}

/// Panel of the wheel over speed; its key stands below the other one.
fn over_speed(
    map: &ForceMap,
    cells: &[Cell],
    quantity: ForceQuantity,
    (top, below): (f64, &mut Panel),
) -> Panel<'static> {
    let curves = curves(map, quantity);
    let at = |cell: &Cell, curve: &Curved| (curve.1)(map.rows.get(cell.index)?.as_ref()?);
    let shown = curves.iter().flat_map(|curve| cells.iter().filter_map(move |cell| at(cell, curve)));
    let highest = shown.filter(|value| value.is_finite()).fold(0.0, f64::max);
    let highest = if highest > 0.0 { 1.1 * highest } else { 1.0 };
    let y = Axis::linear(quantity.short(map), (0.0, highest), 4.0).with_zero();
    let speeds = extent(cells);
    let mut panel = Panel::new((92.0, top), (938.0, 170.0), Axis::speeds(speeds, 9.0), y).domain(0.66, 1.0);
    for (index, curve) in curves.iter().enumerate() {
        let colour = match curves.len() {
            1 => Colour::curve(),
            count => Colour { paper: Colour::curve().paper, ..Colour::ordinal(index, count) },
        };
        // A speed between two without results has no line, so marks are needed.
        let look = Look::filled(Symbol::Square, (1.7, 5.0), colour.clone());
        let places = cells.iter().map(|cell| Some((cell.rpm, at(cell, curve)?)));
        let told = |cell: &Cell| match at(cell, curve) {
            Some(value) => format!("{:.0} rpm, {}: {}", cell.rpm, curve.0, significant(value)),
            None => String::new(),
        };
        let drawn = Curve::new(curve.0, places, Pen::new(colour, Dash::nth(index), 1.6)).title(curve.0);
        let drawn = drawn.each(cells.iter().map(told).collect()).class("curve");
        below.sample(drawn.sample(), curve.0);
        panel.push(Curve { look: Some(look), ..drawn });
    }
    if quantity == ForceQuantity::Consumption {
        let limit = [Some((speeds.0, 1.0)), Some((speeds.1, 1.0))];
        let limit = Curve::new(REACHES, limit, Pen::new(Colour::warning(), Dash::Solid, 1.2));
        if panel.diagram.y.contains(1.0) {
            below.sample(limit.sample(), REACHES);
        }
        panel.push(limit);
    }
    panel
}

/// Paragraph below the title: number of speeds, worst blade, origin.
fn words(map: &ForceMap) -> String {
    let computed = map.rows.iter().flatten().count();
    format!(
        "{computed} of {} speeds · of every contact node its worst blade · {}",
        map.speeds_rad_s.len(),
        heading::origin(&map.settings.model, &map.version)
    )
}

/// Ticks with the numbers of contact nodes; all where there are few.
pub(super) fn node_ticks(nodes: usize) -> Vec<(f64, String)> {
    let every = nodes.div_ceil(16).max(1);
    (0..nodes).step_by(every).map(|node| (node as f64, node.to_string())).collect()
}

/// Rows of contact nodes.
pub(super) fn node_bands(nodes: usize) -> Vec<Band> {
    let middle = (0..nodes).map(|node| node as f64);
    middle.map(|value| Band { from: value - 0.5, to: value + 0.5, value }).collect()
}
