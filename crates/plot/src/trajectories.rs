//! Trajectories of blade tips before the lobes of their casing, seen from beside the wheel: the paper's Fig 2.

use std::f64::consts::TAU;

use super::axis::label;
use super::cells::rpm;
use super::drawing::Drawing;
use super::heading::origin;
use super::key::MARK_WIDTH;
use super::layer::{Course, Curve, Place, Stroke};
use super::sketch::{Axis, Panel, Sketch};
use super::style::{Colour, Dash, Pen};
use super::svg::{group, polyline, rectangle};
use rubmap_analysis::request::Component;
use rubmap_analysis::result::{SensorHistory, SpeedHistories, TipPlace};

/// Largest number of revolutions drawn, the last ones: more would cover each other.
const MOST_REVOLUTIONS: u32 = 10;

/// Outward motion of every tip that a radial or normal sensor records over its angle in the fixed frame, and the casing that it meets there
/// with its shape at full height.
pub fn trajectories(histories: &SpeedHistories) -> Drawing<'static> {
    let title = format!("Tip trajectories before the casing, {} rpm", label(rpm(histories.speed_rad_s), 0));
    let sketch = Sketch::new("trajectories", title, words(histories)).high(540);
    let sketch = sketch.meta("speed_index", histories.index).meta("speed_rpm", rpm(histories.speed_rad_s));
    let tips: Vec<Tip> = histories.sensors.iter().filter_map(Tip::of).collect();
    if tips.is_empty() {
        let words =
            "Nothing to draw: no radial or normal sensor of a tip whose place before the casing is known";
        return sketch.nothing(words).into();
    }
    let mut walls: Vec<&TipPlace> = tips.iter().map(|tip| tip.place).collect();
    walls.sort_by(|a, b| a.clearance.total_cmp(&b.clearance));
    walls.dedup_by(|a, b| a.clearance == b.clearance && a.heights == b.heights);
    let x = Axis::turn("angle in the fixed frame, in the direction of rotation");
    let y = Axis::linear(
        format!("outward displacement, {}", histories.units.length),
        heights(&tips, &walls),
        8.0,
    );
    let bottom = sketch.top();
    let mut panel = Panel::new((92.0, bottom + 24.0), (800.0, 550.0 - bottom), x, y);
    let point = format!("%{{x:.1f}}°: %{{y:.4~g}} {}", histories.units.length);
    let casing = if walls.len() == 1 { "casing" } else { "casing before each tip" };
    for (index, place) in walls.into_iter().enumerate() {
        draw_wall(&mut panel, (casing, &point), place, index == 0);
    }
    for (index, tip) in tips.iter().enumerate() {
        let pen = Pen::new(Colour::ordinal(index, tips.len().max(2)), Dash::nth(index), 1.3);
        let words = tip.words();
        let strokes = tip.motion(histories).into_iter().map(|places| Stroke { places, title: words.clone() });
        let curve = Curve::of(&words, strokes, pen).class("trajectory").over(words.clone(), &*point);
        if index < 20 {
            panel.sample(curve.sample(), &words);
        }
        panel.push(curve);
    }
    let metal = rectangle(0.0, -6.0, MARK_WIDTH, 12.0).set("fill", "#9a9a9a").set("fill-opacity", "0.35");
    panel.sample(metal.set("stroke", "#444444"), casing);
    sketch.with(panel).into()
}

/// First revolution that is drawn.
fn first(histories: &SpeedHistories) -> u32 {
    let [begin, end] = histories.revolutions;
    begin.max(end.saturating_sub(MOST_REVOLUTIONS))
}

/// Paragraphs below the title: the revolutions drawn, the origin, and whether the casing was still growing.
fn words(histories: &SpeedHistories) -> Vec<String> {
    let (first, [_, end]) = (first(histories), histories.revolutions);
    let words = format!(
        "revolutions {first} to {end}, over each other · {}",
        origin(&histories.settings.model, &histories.version)
    );
    let mut paragraphs = vec![words];
    paragraphs.extend(growing(histories, first));
    paragraphs
}

/// Words about a shape of the casing that is drawn at full height and has not grown to it by the revolution `first`.
pub(super) fn growing(histories: &SpeedHistories, first: u32) -> Option<String> {
    let ramp = histories.settings.integration.ramp_revolutions;
    let is_shaped =
        histories.sensors.iter().any(|s| s.tip.as_ref().is_some_and(|tip| !tip.heights.is_empty()));
    let words = if ramp == 1.0 { "revolution".to_owned() } else { format!("{ramp} revolutions") };
    let is_growing = is_shaped && f64::from(first) < ramp;
    is_growing.then(|| format!("the shape of the casing, drawn at full height, grows over the first {words}"))
}

/// Tip whose outward motion and position before the casing are known.
struct Tip<'a> {
    history: &'a SensorHistory,
    place: &'a TipPlace,
}

impl<'a> Tip<'a> {
    fn of(history: &'a SensorHistory) -> Option<Self> {
        let outward = matches!(history.sensor.component, Some(Component::Radial | Component::Normal));
        let place = history.tip.as_ref().filter(|_| outward && !history.displacement.is_empty())?;
        Some(Self { history, place })
    }

    /// Words for the tip.
    fn words(&self) -> String {
        let sensor = &self.history.sensor;
        let component =
            if sensor.component == Some(Component::Normal) { "along its normal" } else { "radially" };
        let node = match (sensor.contact_node, sensor.node) {
            (Some(node), _) => format!("contact node {node}"),
            (None, node) => format!("node {}", node.unwrap_or_default()),
        };
        format!("{node}, blade {}, {component}", sensor.sector)
    }

    /// Motion of the tip in the drawn revolutions, one after the other: angles in degrees, and the distance outwards.
    fn motion(&self, histories: &SpeedHistories) -> Vec<Vec<Option<Place>>> {
        let samples = histories.samples_per_revolution.max(1);
        let skipped = ((first(histories) - histories.revolutions[0]) * samples) as usize;
        let mut revolutions = vec![Vec::new()];
        let mut before = f64::NAN;
        for (j, moved) in self.history.displacement.iter().enumerate().skip(skipped) {
            let turned = (j + 1) as f64 / f64::from(samples);
            let angle = (self.place.angle_rad / TAU + turned).rem_euclid(1.0) * 360.0;
            if angle < before {
                revolutions.push(Vec::new());
            }
            before = angle;
            revolutions.last_mut().into_iter().for_each(|last| last.push(Some((angle, *moved))));
        }
        revolutions
    }
}

/// Range of the casing and of all motion, with some room.
fn heights(tips: &[Tip], walls: &[&TipPlace]) -> (f64, f64) {
    let casing = walls.iter().flat_map(|place| wall(place)).map(|(_, distance)| distance);
    let moved = tips.iter().flat_map(|tip| tip.history.displacement.iter().copied());
    let finite = casing.chain(moved).filter(|value| value.is_finite());
    let (low, high) = finite.fold((0f64, 0f64), |(low, high), value| (low.min(value), high.max(value)));
    let room = if low < high { 0.08 * (high - low) } else { 1.0 };
    (low - room, high + room)
}

/// Wall before a tip: angles in degrees, and the distance outwards.
fn wall(place: &TipPlace) -> impl Iterator<Item = Place> {
    let heights: &[f64] = if place.heights.is_empty() { &[0.0] } else { &place.heights };
    let steps = heights.len();
    (0..=steps).map(move |i| (360.0 * i as f64 / steps as f64, place.clearance - heights[i % steps]))
}

/// Adds a wall, with the metal above it in the drawing.
fn draw_wall(panel: &mut Panel, (name, point): (&str, &str), place: &TipPlace, is_first: bool) {
    let diagram = panel.diagram;
    let corners = wall(place).map(|(x, y)| {
        let (x, y) = diagram.point(x, y);
        (x, y.clamp(diagram.top, diagram.bottom()))
    });
    let ends = [(diagram.right(), diagram.top), (diagram.left, diagram.top)];
    let metal = polyline(corners.chain(ends).map(Some)).set("style", "fill:#9a9a9a;fill-opacity:0.22");
    panel.push(group().child(metal));
    let pen = Pen::new(Colour::neutral("#444444"), Dash::Solid, if is_first { 1.6 } else { 1.0 });
    let words = format!("casing, clearance {}", place.clearance);
    let curve = Curve::new(name, wall(place).map(Some), pen).title(&words).over(words, point);
    panel.push(curve.course(Course::Cut).class("casing"));
}
