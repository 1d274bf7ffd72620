//! Interference diagram (SAFE, ZZENF): natural frequencies over the nodal diameter at one speed, and the zig-zag of engine orders.

use std::f64::consts::TAU;

use super::axis::{label, significant};
use super::cells::rpm;
use super::drawing::Drawing;
use super::heading;
use super::layer::{Area, Areas, Course, Curve, Mark, Marks, Stroke};
use super::marks;
use super::sketch::{Axis, Panel, Sketch};
use super::style::{Colour, Dash, Look, Pen, Symbol};
use rubmap_analysis::request::FamiliesBy;
use rubmap_analysis::result::{FoldedOrder, Interference, InterferingMode, NearestOrder, Wave};

/// Largest distance from its engine order, per cent, at which a mode has it written beside it.
const WRITTEN: f64 = 20.0;

/// Half the width of the bar of an engine order over the operating range, in nodal diameters.
const HALF_BAR: f64 = 0.14;

/// Modes of all nodal diameters at one speed, and the engine orders folded onto the nodal diameters that they drive: up between multiples of N and the
/// halves behind them, down from there. Orders of the lobes are marked, with bars over the operating range.
pub fn interference(found: &Interference) -> Drawing<'_> {
    let highest = found.modes.iter().map(|mode| mode.frequency_hz).filter(|hz| hz.is_finite());
    let highest = highest.fold(0.0, f64::max);
    let top = if highest > 0.0 { 1.08 * highest } else { 1.0 };
    let last = f64::from(found.sectors / 2);
    let step = (last / 16.0).ceil().max(1.0) as usize;
    let ticks = (0..=found.sectors / 2).step_by(step).map(|i| (f64::from(i), i.to_string())).collect();
    let x = Axis::names("nodal diameter", (-0.45, last + 0.65), ticks);
    let y = Axis::linear("natural frequency in the rotating frame, Hz", (0.0, top), 10.0);
    let speed = rpm(found.speed_rad_s);
    let title = format!("Interference diagram at {} rpm", label(speed, 0));
    let mut sketch = Sketch::new("interference", title, words(found)).high(600);
    sketch = sketch.meta("units", serde_json::json!({"x": "", "y": "Hz"})).meta("speed_rpm", speed);
    let mut panel = Panel::new((92.0, 106.0), (812.0, 586.0), x, y);
    bars(found, &mut panel);
    zigzag(found, top, &mut panel);
    families(found, &mut panel);
    orders(found, &mut panel);
    modes(found, &mut panel);
    panel.note("%: a mode above (+) or below (−) its nearest");
    panel.note(&format!("engine order of the lobes, up to {WRITTEN} %"));
    sketch.with(panel).into()
}

/// Paragraphs below the title.
fn words(found: &Interference) -> Vec<String> {
    let by = match found.families_by {
        FamiliesBy::Shape => "families by shape",
        FamiliesBy::Rank => "families by rank",
    };
    let origin = heading::origin(&found.model, &found.version);
    let lobes = if found.lobes == 1 { "lobe" } else { "lobes" };
    let mut words = vec![format!("{} sectors · {} {lobes} · {by} · {origin}", found.sectors, found.lobes)];
    words.extend(found.between_rad_s.map(|[low, high]| {
        let [low, high] = [low, high].map(|speed| label(rpm(speed), 0));
        format!("frequencies between those of the modal analysis at {low} and {high} rpm")
    }));
    words
}

/// Adds the engine orders of the lobes over the operating range.
fn bars(found: &Interference, panel: &mut Panel) {
    let Some([from, to]) = found.range_rad_s else { return };
    let (_, top) = panel.y.range;
    let bar = |order: &FoldedOrder| {
        let [low, high] = [from, to].map(|speed| f64::from(order.engine_order) * speed / TAU);
        let i = f64::from(order.nodal_diameter);
        let words = format!(
            "engine order {}, nodal diameter {}: {} to {} Hz over the operating range",
            order.engine_order,
            order.nodal_diameter,
            significant(low),
            significant(high)
        );
        (low < top).then(|| Area {
            across: (i - HALF_BAR, i + HALF_BAR),
            upwards: Some((low, high.min(top))),
            words,
        })
    };
    let areas: Vec<Area> =
        found.engine_orders.iter().filter(|order| order.of_lobes).filter_map(bar).collect();
    if areas.is_empty() {
        return;
    }
    // Grid, zig-zag and a dark page show through.
    let fill = "rgba(240, 160, 60, 0.35)";
    let sample = super::svg::rectangle(0.0, -6.0, super::key::MARK_WIDTH, 12.0).set("fill", fill);
    let [from, to] = [from, to].map(|speed| label(rpm(speed), 0));
    panel.sample(sample, &format!("{from} to {to} rpm"));
    panel.push(Areas { name: "operating range", areas, fill: fill.to_owned(), class: "range" });
}

/// Adds the line f = kΩ/2π folded at multiples of N/2: solid where k climbs from nodal diameter to nodal diameter, dashed where it descends.
fn zigzag(found: &Interference, top: f64, panel: &mut Panel) {
    let half = 0.5 * f64::from(found.sectors);
    let highest = found.engine_orders.last().map_or(0.0, |order| f64::from(order.engine_order));
    let hz = |order: f64| order * found.speed_rad_s / TAU;
    let (mut legs, mut leg) = ([Vec::new(), Vec::new()], 0);
    while f64::from(leg) * half < highest && hz(f64::from(leg) * half) < top {
        let (from, to) = (f64::from(leg) * half, (f64::from(leg + 1) * half).min(highest));
        let falls = leg % 2 == 1;
        let fold = |order: f64| if falls { half - (order - from) } else { order - from };
        let places = [from, to].map(|order| Some((fold(order), hz(order)))).to_vec();
        legs[usize::from(falls)].push(Stroke { places, title: String::new() });
        leg += 1;
    }
    let colour = || Colour::neutral("#777777");
    let names = ["engine orders k = aN + i", "engine orders k = aN − i"];
    for ((strokes, name), dash) in legs.into_iter().zip(names).zip([Dash::Solid, Dash::Dashed]) {
        if !strokes.is_empty() {
            let curve = Curve::of(name, strokes, Pen::new(colour(), dash, 1.0)).course(Course::Cut);
            panel.sample(curve.sample(), name);
            panel.push(curve);
        }
    }
}

fn count(found: &Interference) -> usize {
    found.modes.iter().map(|mode| mode.family as usize).max().unwrap_or(0)
}

/// Adds lines through the modes of every family.
fn families(found: &Interference, panel: &mut Panel) {
    for family in 0..count(found) {
        let of = |wave: Option<Wave>| {
            let there = found.modes.iter().filter(move |mode| mode.family as usize == family + 1);
            let there = there.filter(move |mode| mode.wave.is_none() || mode.wave == wave);
            there.map(|mode| Some((f64::from(mode.nodal_diameter), mode.frequency_hz))).collect()
        };
        let mut strokes: Vec<Vec<_>> = vec![of(Some(Wave::Backward))];
        if found.modes.iter().any(|mode| mode.wave.is_some()) {
            strokes.push(of(Some(Wave::Forward)));
        }
        let strokes = strokes.into_iter().map(|places| Stroke { places, title: String::new() });
        let pen = Pen::new(Colour::family(family, count(found)), Dash::Solid, 0.8);
        panel.push(Curve::of(&name(family), strokes, pen).unlisted());
    }
}

fn name(family: usize) -> String {
    format!("family {}", family + 1)
}

/// Adds marks at the engine orders: diamonds with their number at those of the lobes, small dots at the others.
fn orders(found: &Interference, panel: &mut Panel) {
    let place = |order: &FoldedOrder| (f64::from(order.nodal_diameter), order.frequency_hz);
    let inside = |order: &&FoldedOrder| panel.diagram.inside(place(order).0, place(order).1).is_some();
    let mark = |order: &FoldedOrder| {
        let wave = match order.wave {
            None => "standing",
            Some(Wave::Forward) => "with the rotation",
            Some(Wave::Backward) => "against the rotation",
        };
        let words = format!(
            "engine order {}: nodal diameter {}, {wave}, {} Hz",
            order.engine_order,
            order.nodal_diameter,
            significant(order.frequency_hz)
        );
        Mark::new(place(order), words)
    };
    let (of_lobes, others): (Vec<_>, Vec<_>) =
        found.engine_orders.iter().filter(inside).partition(|order| order.of_lobes);
    let dot = Look::filled(Symbol::Circle, (1.8, 4.0), Colour::neutral("#999999"));
    panel.marks("other engine orders", Marks::new("other engine orders", dot, others.into_iter().map(mark)));
    let diamond = Look::filled(Symbol::Diamond, (4.4, 10.0), Colour::warning());
    let driven = of_lobes.into_iter().map(|order| mark(order).label(format!("EO {}", order.engine_order)));
    panel.marks("engine orders of the lobes", Marks::new("engine orders of the lobes", diamond, driven));
}

/// Adds the modes, those of a family under one name; forward waves are open.
fn modes(found: &Interference, panel: &mut Panel) {
    let mark = |mode: &InterferingMode| {
        let words = format!(
            "{}: {} Hz",
            marks::mode(mode.nodal_diameter, mode.family, mode.wave),
            significant(mode.frequency_hz)
        );
        let (words, written) = match mode.nearest {
            None => (format!("{words}, not driven"), String::new()),
            Some(NearestOrder { engine_order, margin_percent, .. }) => {
                let percent = format!("{margin_percent:+.1} %").replace('-', "−");
                let written = if margin_percent.abs() <= WRITTEN { percent.clone() } else { String::new() };
                (format!("{words}, {percent} of engine order {engine_order}"), written)
            }
        };
        let met = mode.met_in_range.iter().map(u32::to_string).collect::<Vec<_>>().join(", ");
        let words = if met.is_empty() { words } else { format!("{words}, met in the range by {met}") };
        Mark::new((f64::from(mode.nodal_diameter), mode.frequency_hz), words).label(written)
    };
    for family in 0..count(found) {
        let all = |is_forward: bool| {
            let there = found.modes.iter().filter(move |mode| mode.family as usize == family + 1);
            there.filter(move |mode| (mode.wave == Some(Wave::Forward)) == is_forward).map(mark)
        };
        let colour = || Colour::family(family, count(found));
        let symbol = Symbol::nth(family);
        let filled = Look::filled(symbol, (4.2, 9.0), colour());
        panel.marks(&name(family), Marks::new(&name(family), filled, all(false)));
        let open = Look::open(symbol, (4.2, 9.0), colour());
        let forward = format!("{}, forward waves", name(family));
        panel.marks(&forward, Marks::new(&forward, open, all(true)));
    }
}
