//! Contact over speed and contact node.

use super::axis::{Scale, significant, ticks};
use super::cells::{Cell, cells, extent};
use super::diagram::Diagram;
use super::key::Flow;
use super::pixels::Pixels;
use super::svg::{Element, document, group, line, polyline, rectangle};
use super::{colour_bar, hatching, heading};
use rubmap_analysis::result::{ForceMap, ForceRow};

const WIDTH: f64 = 1180.0;
const LEFT: f64 = 100.0;
const PLOT_WIDTH: f64 = 930.0;
const CURVES_HEIGHT: f64 = 170.0;
const MAP_HEIGHT: f64 = 340.0;

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
    pub(super) fn of(self, row: &ForceRow) -> &[f64] {
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
    pub(super) fn short(self, map: &ForceMap) -> String {
        let words = match self {
            Self::Peak => "force",
            Self::Impulse => "impulse",
            Self::Share => "share of time",
            Self::Consumption => "share of the clearance",
        };
        format!("{words}{}", self.unit(map))
    }
}

/// Curve over speed: its words, dashes, and value.
pub(super) type Curve = (&'static str, &'static str, fn(&ForceRow) -> Option<f64>);

/// Curves of the wheel above the map that have values; the first is the worst node of the map.
pub(super) fn curves(map: &ForceMap, quantity: ForceQuantity) -> Vec<Curve> {
    let known = |(.., value): &Curve| map.rows.iter().flatten().any(|row| value(row).is_some());
    all_curves(quantity).into_iter().filter(known).collect()
}

fn all_curves(quantity: ForceQuantity) -> Vec<Curve> {
    let worst: Curve = match quantity {
        ForceQuantity::Peak => ("worst node", "", |row| largest(&row.peak_force)),
        ForceQuantity::Impulse => ("worst node", "", |row| largest(&row.impulse_per_revolution)),
        ForceQuantity::Share => ("worst node", "", |row| largest(&row.contact_share)),
        ForceQuantity::Consumption => ("worst node", "", |row| largest(&row.clearance_consumption)),
    };
    match quantity {
        ForceQuantity::Peak => vec![
            worst,
            ("whole wheel, peak", "8 3", |row| Some(row.summary.peak_force)),
            ("whole wheel, mean", "2 3", |row| Some(row.summary.mean_force)),
        ],
        ForceQuantity::Consumption => {
            vec![worst, ("linear calculation", "8 3", |row| row.summary.linear_clearance_consumption)]
        }
        ForceQuantity::Impulse | ForceQuantity::Share => vec![worst],
    }
}

/// Words for the line at a consumption of 1.
pub(super) const REACHES: &str = "1: reaches the undeformed casing";

/// Title of the axis of contact nodes.
pub(super) const NODES: &str = "contact node (0: leading edge)";

pub(super) fn largest(values: &[f64]) -> Option<f64> {
    values.iter().copied().filter(|value| value.is_finite()).max_by(f64::total_cmp)
}

/// Draws contact over speed and contact node, above it the worst node, the whole wheel, and the linear prediction where there are such
/// numbers.
pub fn force_map(map: &ForceMap, quantity: ForceQuantity) -> String {
    let title = title(quantity);
    let (heading, bottom) = heading::heading(LEFT, &title, &[words(map)]);
    let cells = cells(&map.speeds_rad_s);
    let top = bottom + 20.0;
    let speeds = extent(&cells);
    let rows = |cell: &Cell| map.rows.get(cell.index).and_then(Option::as_ref);
    let curves = curves(map, quantity);
    let shown = curves
        .iter()
        .flat_map(|(.., value)| cells.iter().filter_map(move |cell| rows(cell).and_then(*value)));
    let highest = shown.filter(|value| value.is_finite()).fold(0.0, f64::max);
    let highest = if highest > 0.0 { 1.1 * highest } else { 1.0 };
    let nodes = map.rows.iter().flatten().map(|row| quantity.of(row).len()).max().unwrap_or(0);
    let loudest = map.rows.iter().flatten().filter_map(|row| largest(quantity.of(row))).fold(0.0, f64::max);
    let place = ((LEFT, top + CURVES_HEIGHT + 16.0), (PLOT_WIDTH, MAP_HEIGHT));
    let diagram = Diagram::new(place.0, place.1, speeds, (-0.5, nodes.max(1) as f64 - 0.5));
    let scale =
        Scale::linear((0.0, if loudest > 0.0 { loudest } else { 1.0 }), (diagram.bottom(), diagram.top));

    let mut pixels = Pixels::over(&diagram);
    for cell in &cells {
        for (node, value) in rows(cell).into_iter().flat_map(|row| quantity.of(row).iter().enumerate()) {
            let x = (diagram.x.place(cell.from), diagram.x.place(cell.to));
            let y = (diagram.y.place(node as f64 + 0.5), diagram.y.place(node as f64 - 0.5));
            pixels.paint_area(x, y, if value.is_finite() { scale.share(*value) } else { 0.0 });
        }
    }
    let x = ticks(diagram.x.values, 9.0);
    let mut content =
        vec![hatching::definition(), heading, diagram.background(hatching::FILL), pixels.draw()];
    content.push(over_speed(&curves, &cells, &rows, (quantity, map), ((LEFT, top), speeds, highest)));
    content.push(diagram.frame());
    content.push(diagram.x_axis(&x, "rotational speed Ω, rpm"));
    content.push(diagram.y_axis(&node_ticks(nodes), NODES, 72.0));
    let bar = ticks(scale.values, 8.0);
    content.push(colour_bar::draw(&scale, diagram.right() + 26.0, &bar, &quantity.short(map)));
    let mut flow = Flow::new(LEFT, WIDTH - 20.0, diagram.bottom() + 66.0);
    for (words, dashes, _) in &curves {
        flow = flow.entry(stroke(dashes), 30.0, words);
    }
    if quantity == ForceQuantity::Consumption && highest >= 1.0 {
        let limit = line((0.0, 0.0), (30.0, 0.0)).set("stroke", "#d62728").set("stroke-width", "1.2");
        flow = flow.entry(limit, 30.0, REACHES);
    }
    if cells.iter().any(|cell| rows(cell).is_none()) {
        flow = flow.entry(hatching::mark(), 20.0, "no result");
    }
    content.push(flow.draw());
    document(&title, WIDTH, diagram.bottom() + 92.0, content)
}

/// Title: the quantity of the map.
pub(super) fn title(quantity: ForceQuantity) -> String {
    format!("Contact over speed: {}", quantity.words())
}

/// Paragraph below the title: number of speeds, worst blade, origin.
pub(super) fn words(map: &ForceMap) -> String {
    let computed = map.rows.iter().flatten().count();
    format!(
        "{computed} of {} speeds · of every contact node its worst blade · {}",
        map.speeds_rad_s.len(),
        heading::origin(&map.settings.model, &map.version)
    )
}

fn stroke(dashes: &str) -> Element {
    let stroke = line((0.0, 0.0), (30.0, 0.0)).set("stroke", "#1f4e79").set("stroke-width", "1.6");
    stroke.set("stroke-dasharray", dashes)
}

/// Words for a value of a curve.
pub(super) fn told(rpm: f64, words: &str, value: f64) -> String {
    format!("{rpm:.0} rpm, {words}: {}", significant(value))
}

/// Ticks with the numbers of contact nodes; all where there are few.
pub(super) fn node_ticks(nodes: usize) -> Vec<(f64, String)> {
    let every = nodes.div_ceil(16).max(1);
    (0..nodes).step_by(every).map(|node| (node as f64, node.to_string())).collect()
}

/// Draws the curves above the map.
fn over_speed<'a>(
    curves: &[Curve],
    cells: &[Cell],
    rows: &impl Fn(&Cell) -> Option<&'a ForceRow>,
    (quantity, map): (ForceQuantity, &ForceMap),
    (corner, speeds, highest): ((f64, f64), (f64, f64), f64),
) -> Element {
    let diagram = Diagram::new(corner, (PLOT_WIDTH, CURVES_HEIGHT), speeds, (0.0, highest));
    let y = ticks(diagram.y.values, 4.0);
    let drawn = curves.iter().map(|(words, dashes, value)| {
        let at = |cell: &Cell| diagram.inside(cell.rpm, rows(cell).and_then(value)?);
        let curve = polyline(cells.iter().map(at)).set("class", "curve").set("stroke", "#1f4e79");
        let curve = curve.set("stroke-width", "1.6").set("stroke-dasharray", dashes).title(words);
        // A speed between two without results has no line.
        let dots = cells.iter().filter_map(|cell| Some((at(cell)?, rows(cell).and_then(value)?, cell.rpm)));
        let dots = dots.map(|((x, y), value, rpm)| {
            let dot = rectangle(x - 1.5, y - 1.5, 3.0, 3.0).set("fill", "#1f4e79");
            dot.title(&told(rpm, words, value))
        });
        group().child(curve).children(dots)
    });
    let limit = (quantity == ForceQuantity::Consumption && diagram.y.contains(1.0)).then(|| {
        let y = diagram.y.place(1.0);
        line((diagram.left, y), (diagram.right(), y)).set("stroke", "#d62728").set("stroke-width", "1.2")
    });
    group()
        .child(diagram.grid(&[], &y))
        .children(limit)
        .children(drawn)
        .child(diagram.frame())
        .child(diagram.y_axis(&y, &quantity.short(map), 72.0))
}
