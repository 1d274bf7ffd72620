//! Backbone curves: amplitude of free vibration over the change of its frequency.

use std::collections::BTreeSet;

use super::axis::{label, significant};
use super::campbell::{family, name_families};
use super::cells::rpm;
use super::drawing::Drawing;
use super::heading;
use super::layer::{Curve, Mark, Marks};
use super::marks;
use super::sketch::{Axis, Panel, Sketch};
use super::style::{Colour, DASHES, Dash, Look, Pen, Symbol};
use super::svg::group;
use rubmap_analysis::result::{BackboneCurve, BackbonePoint, Backbones};

/// Change of the frequency, %, that the harmonics of a curve do not resolve: a curve that never exceeds it is drawn without change.
const RESOLVED: f64 = 1e-4;

/// Number of marks along a curve, where its nodal diameter has marks.
const ALONG: usize = 4;

/// Amplitude over the change of the frequency: colours show the family, dashes and marks the nodal diameter, and red circles where a curve could not
/// be followed.
pub fn backbones(found: &Backbones) -> Drawing<'_> {
    let points = || found.curves.iter().flat_map(|curve| &curve.points);
    let highest = points().map(|point| point.amplitude).fold(0.0, f64::max);
    let changes = found.curves.iter().flat_map(places).map(|place| place.0);
    let (low, high) =
        changes.fold((0.0f64, 0.0f64), |(low, high), change| (low.min(change), high.max(change)));
    let room = if high > low { 0.05 * (high - low) } else { 1.0 };
    let x = Axis::linear("change of the natural frequency, %", (low - room, high + room), 10.0);
    let length = &found.units.length;
    let upwards = (0.0, if highest > 0.0 { 1.06 * highest } else { 1.0 });
    let y = Axis::linear(format!("amplitude where the mode moves most, {length}"), upwards, 10.0);
    let title = format!("Backbone curves at {} rpm", label(rpm(found.speed_rad_s), 0));
    let words = format!(
        "free vibration without damping and contact · {} coordinates of a blade · {}",
        found.coordinates,
        heading::origin(&found.model, &found.version)
    );
    let mut sketch = Sketch::new("backbones", title, vec![words]).high(600);
    sketch = sketch.meta("units", serde_json::json!({"x": "%", "y": length}));
    if found.curves.is_empty() {
        return sketch.nothing("The analysis has no modes of these nodal diameters.").into();
    }
    let mut panel = Panel::new((92.0, 86.0), (812.0, 606.0), x, y);
    curves(found, &mut panel);
    ends(found, &mut panel);
    sketch.with(panel).into()
}

fn is_flat(curve: &BackboneCurve) -> bool {
    curve.points.iter().all(|point| point.change_percent.abs() < RESOLVED)
}

/// Points of a curve as they are drawn.
fn places(curve: &BackboneCurve) -> impl Iterator<Item = (f64, f64)> + '_ {
    let by = if is_flat(curve) { 0.0 } else { 1.0 };
    curve.points.iter().map(move |point| (by * point.change_percent, point.amplitude))
}

/// Marks of a nodal diameter, without which its dashes would be those of a smaller one.
fn look(nodal_diameter: u32, colour: Colour) -> Option<Look> {
    let symbol = Symbol::nth((nodal_diameter as usize / DASHES).checked_sub(1)?);
    Some(Look::filled(symbol, (4.0, 8.0), colour))
}

fn curves(found: &Backbones, panel: &mut Panel) {
    let families = found.curves.iter().map(|curve| curve.family as usize).max().unwrap_or(0);
    for curve in &found.curves {
        let (index, i) = (curve.family as usize - 1, curve.nodal_diameter);
        let colour = Colour::family(index, families);
        let over = |point: &BackbonePoint| {
            format!(
                "{}: {} Hz ({:+.2} %) at {}",
                marks::mode(i, curve.family, None),
                significant(point.frequency_hz),
                point.change_percent,
                significant(point.amplitude)
            )
        };
        let words: Vec<String> = curve.points.iter().map(over).collect();
        let marked = look(i, colour.clone()).map(|look| {
            let step = (curve.points.len() / ALONG).max(1);
            let all = places(curve).zip(&words).skip(step).step_by(step);
            Marks::new(&family(index), look, all.map(|(place, words)| Mark::new(place, words.clone())))
        });
        let pen = Pen::new(colour, Dash::nth(i as usize), 1.8);
        panel.push(Curve::new(&family(index), places(curve).map(Some), pen).title(&told(curve)).each(words));
        marked.into_iter().for_each(|marks| panel.push(marks.unlisted()));
    }
    name_families(families, panel);
    let diameters: BTreeSet<u32> = found.curves.iter().map(|curve| curve.nodal_diameter).collect();
    for i in diameters {
        let grey = Colour::neutral("#444444");
        let (pen, look) = (Pen::new(grey.clone(), Dash::nth(i as usize), 1.8), look(i, grey));
        let sample = look.iter().fold(group().child(pen.sample()), |all, look| all.child(look.sample()));
        let words = format!("nodal diameter {i}");
        panel.sample(sample, &words);
        panel.push(Curve { look, ..Curve::new(&words, [None, None], pen) });
    }
    if found.curves.iter().any(is_flat) {
        panel.note("without change: less than 0.0001 %");
    }
}

/// Mode and end of a curve, in words.
fn told(curve: &BackboneCurve) -> String {
    format!("{}: {}", marks::mode(curve.nodal_diameter, curve.family, None), curve.end)
}

/// Adds the ends of curves that could not be followed to the largest amplitude.
fn ends(found: &Backbones, panel: &mut Panel) {
    let mark = |curve: &BackboneCurve| Some(Mark::new(places(curve).last()?, told(curve)));
    let ended = found.curves.iter().filter(|curve| !curve.complete).filter_map(mark);
    let look = Look::open(Symbol::Circle, (4.5, 10.0), Colour::warning());
    panel.marks("not followed any further", Marks::new("not followed any further", look, ended));
}
