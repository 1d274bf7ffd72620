//! Backbone curves: amplitude of free vibration over the change of its frequency.

use super::axis::{label, significant};
use super::campbell::{explained, family, name_families};
use super::cells::rpm;
use super::drawing::Drawing;
use super::heading;
use super::layer::{Curve, Mark, Marks};
use super::marks;
use super::sketch::{Axis, Panel, Sketch};
use super::style::{Colour, DASHES, Dash, Look, Pen, Symbol};
use rubmap_analysis::result::{BackboneCurve, BackbonePoint, Backbones};

/// Amplitude over the change of the frequency: colours show the family, dashes the nodal diameter, and circles where a curve could not be followed.
pub fn backbones(found: &Backbones) -> Drawing<'_> {
    let points = || found.curves.iter().flat_map(|curve| &curve.points);
    let highest = points().map(|point| point.amplitude).fold(0.0, f64::max);
    let changes = points().map(|point| point.change_percent);
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

fn curves(found: &Backbones, panel: &mut Panel) {
    let families = found.curves.iter().map(|curve| curve.family as usize).max().unwrap_or(0);
    for curve in &found.curves {
        let (index, i) = (curve.family as usize - 1, curve.nodal_diameter);
        let pen = Pen::new(Colour::family(index, families), Dash::nth(i as usize), 1.8);
        let places = curve.points.iter().map(|point| Some((point.change_percent, point.amplitude)));
        let over = |point: &BackbonePoint| {
            format!(
                "{}: {} Hz ({:+.2} %) at {}",
                marks::mode(i, curve.family, None),
                significant(point.frequency_hz),
                point.change_percent,
                significant(point.amplitude)
            )
        };
        let words = curve.points.iter().map(over).collect();
        panel.push(Curve::new(&family(index), places, pen).title(&told(curve)).each(words));
    }
    name_families(families, panel);
    let mut diameters: Vec<u32> = found.curves.iter().map(|curve| curve.nodal_diameter).collect();
    diameters.dedup();
    for first in 0..DASHES {
        let alike: Vec<String> =
            diameters.iter().filter(|&&i| i as usize % DASHES == first).map(u32::to_string).collect();
        if !alike.is_empty() {
            let pen = Pen::new(Colour::neutral("#444444"), Dash::nth(first), 1.8);
            explained(panel, pen, &format!("nodal diameter {}", alike.join(", ")));
        }
    }
}

/// Mode and end of a curve, in words.
fn told(curve: &BackboneCurve) -> String {
    format!("{}: {}", marks::mode(curve.nodal_diameter, curve.family, None), curve.end)
}

/// Adds the ends of curves that could not be followed to the largest amplitude.
fn ends(found: &Backbones, panel: &mut Panel) {
    let mark = |curve: &BackboneCurve| {
        let last = curve.points.last()?;
        Some(Mark::new((last.change_percent, last.amplitude), told(curve)))
    };
    let ended = found.curves.iter().filter(|curve| !curve.complete).filter_map(mark);
    let look = Look::open(Symbol::Circle, (4.5, 10.0), Colour::warning());
    panel.marks("not followed any further", Marks::new("not followed any further", look, ended));
}
