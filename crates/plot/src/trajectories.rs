//! Trajectories of blade tips before the lobes of their casing, seen from beside the wheel: the paper's Fig 2.

use std::f64::consts::TAU;

use super::axis::{eighths, label, ticks};
use super::cells::rpm;
use super::colour::{DASHES, ordinal};
use super::diagram::Diagram;
use super::heading::{heading, origin};
use super::key::{Key, MARK_WIDTH};
use super::svg::{Element, document, group, line, polyline, rectangle};
use rubmap_analysis::request::Component;
use rubmap_analysis::result::{SensorHistory, SpeedHistories, TipPlace};

const WIDTH: f64 = 1180.0;
const HEIGHT: f64 = 640.0;
const LEFT: f64 = 100.0;
const PLOT_WIDTH: f64 = 800.0;

/// Largest number of revolutions drawn, the last ones: more would cover each other.
const MOST_REVOLUTIONS: u32 = 10;

/// Length of the shortest line that is drawn.
const SMALLEST_STEP: f64 = 0.5;

/// Position in the drawing.
type Place = (f64, f64);

/// Draws the outward motion of every tip that a radial or normal sensor records over its angle in the fixed frame, and the casing that it
/// meets there with its shape at full height.
pub fn trajectories(histories: &SpeedHistories) -> String {
    let title = title(histories);
    let (heading, bottom) = heading(LEFT, &title, &words(histories));
    let mut content = vec![heading];
    let place = ((LEFT, bottom + 24.0), (PLOT_WIDTH, HEIGHT - 90.0 - bottom));
    content.extend(View::new(histories, place).draw());
    document(&title, WIDTH, HEIGHT, content)
}

/// Title: the speed of the trajectories.
pub(super) fn title(histories: &SpeedHistories) -> String {
    format!("Tip trajectories before the casing, {} rpm", label(rpm(histories.speed_rad_s), 0))
}

/// First revolution that is drawn.
fn first(histories: &SpeedHistories) -> u32 {
    let [begin, end] = histories.revolutions;
    begin.max(end.saturating_sub(MOST_REVOLUTIONS))
}

/// Paragraphs below the title: the revolutions drawn, the origin, and whether the casing was still growing.
pub(super) fn words(histories: &SpeedHistories) -> Vec<String> {
    let (first, [_, end]) = (first(histories), histories.revolutions);
    let words = format!(
        "revolutions {first} to {end}, over each other · {}",
        origin(&histories.settings.model, &histories.version)
    );
    let mut paragraphs = vec![words];
    let growing = f64::from(first) < histories.settings.integration.ramp_revolutions;
    let shaped = histories.sensors.iter().any(|s| s.tip.as_ref().is_some_and(|tip| !tip.heights.is_empty()));
    if growing && shaped {
        let ramp = histories.settings.integration.ramp_revolutions;
        let words = if ramp == 1.0 { "revolution".to_owned() } else { format!("{ramp} revolutions") };
        paragraphs
            .push(format!("the shape of the casing, drawn at full height, grows over the first {words}"));
    }
    paragraphs
}

/// Title of the horizontal axis.
pub(super) const ANGLE: &str = "angle in the fixed frame, in the direction of rotation";

/// Title of the vertical axis.
pub(super) fn outward(length: &str) -> String {
    format!("outward displacement, {length}")
}

/// Tip whose outward motion and position before the casing are known.
pub(super) struct Tip<'a> {
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
    pub(super) fn words(&self) -> String {
        let sensor = &self.history.sensor;
        let component =
            if sensor.component == Some(Component::Normal) { "along its normal" } else { "radially" };
        let node = match (sensor.contact_node, sensor.node) {
            (Some(node), _) => format!("contact node {node}"),
            (None, node) => format!("node {}", node.unwrap_or_default()),
        };
        format!("{node}, blade {}, {component}", sensor.sector)
    }
}

/// Tips and the casing before them, as the drawing shows them.
pub(super) struct View<'a> {
    histories: &'a SpeedHistories,
    pub(super) tips: Vec<Tip<'a>>,
    /// Number of revolutions of the record that are left out.
    skipped: u32,
    /// Different walls before the tips.
    pub(super) walls: Vec<&'a TipPlace>,
    pub(super) diagram: Diagram,
}

/// Message where no tip can be drawn.
pub(super) const NO_TIPS: &str =
    "Nothing to draw: no radial or normal sensor of a tip whose place before the casing is known";

/// Wall before a tip: angles in degrees, and the distance outwards.
pub(super) fn wall(place: &TipPlace) -> impl Iterator<Item = (f64, f64)> {
    let heights: &[f64] = if place.heights.is_empty() { &[0.0] } else { &place.heights };
    let steps = heights.len();
    (0..=steps).map(move |i| (360.0 * i as f64 / steps as f64, place.clearance - heights[i % steps]))
}

/// Words for a wall.
pub(super) fn wall_words(place: &TipPlace) -> String {
    format!("casing, clearance {}", place.clearance)
}

impl<'a> View<'a> {
    /// Lays out the tips and the casing within a rectangle of the drawing.
    pub(super) fn new(histories: &'a SpeedHistories, (corner, size): ((f64, f64), (f64, f64))) -> Self {
        let tips: Vec<Tip> = histories.sensors.iter().filter_map(Tip::of).collect();
        let skipped = first(histories) - histories.revolutions[0];
        let mut walls: Vec<&TipPlace> = tips.iter().map(|tip| tip.place).collect();
        walls.sort_by(|a, b| a.clearance.total_cmp(&b.clearance));
        walls.dedup_by(|a, b| a.clearance == b.clearance && a.heights == b.heights);
        let casing = walls.iter().flat_map(|place| wall(place)).map(|(_, distance)| distance);
        let moved = tips.iter().flat_map(|tip| tip.history.displacement.iter().copied());
        let (low, high) = casing
            .chain(moved)
            .filter(|value| value.is_finite())
            .fold((0f64, 0f64), |(low, high), value| (low.min(value), high.max(value)));
        let room = if low < high { 0.08 * (high - low) } else { 1.0 };
        let diagram = Diagram::new(corner, size, (0.0, 360.0), (low - room, high + room));
        Self { histories, tips, skipped, walls, diagram }
    }

    fn draw(&self) -> Vec<Element> {
        let diagram = &self.diagram;
        if self.tips.is_empty() {
            return vec![diagram.frame(), diagram.words(NO_TIPS)];
        }
        let degrees = eighths();
        let y = ticks(diagram.y.values, 8.0);
        let casings = self.walls.iter().enumerate().map(|(index, place)| self.casing(index, place));
        let paths = self.tips.iter().enumerate().map(|(index, tip)| self.path(index, tip));
        let length = &self.histories.units.length;
        vec![
            diagram.grid(&degrees, &y),
            diagram.region("casing"),
            group().set("clip-path", "url(#casing)").children(casings),
            group().children(paths),
            diagram.frame(),
            diagram.x_axis(&degrees, ANGLE),
            diagram.y_axis(&y, &outward(length), 72.0),
            self.key(),
        ]
    }

    /// Draws the casing before a tip; the first one is filled.
    fn casing(&self, index: usize, place: &TipPlace) -> Element {
        let wall: Vec<(f64, f64)> = wall(place).map(|(x, y)| self.diagram.point(x, y)).collect();
        let stroke = polyline(wall.iter().copied().map(Some)).set("stroke", "#444444");
        let stroke = stroke.set("class", "casing").set("stroke-width", if index == 0 { "1.6" } else { "1" });
        let corners = [(self.diagram.right(), self.diagram.top), (self.diagram.left, self.diagram.top)];
        let metal = polyline(wall.into_iter().chain(corners).map(Some));
        let metal = metal.set("style", "fill:#9a9a9a;fill-opacity:0.22");
        group().child(metal).child(stroke.title(&wall_words(place)))
    }

    /// Motion of a tip, with a gap before each revolution: angles in degrees, and the distance outwards.
    pub(super) fn motion(&self, tip: &Tip) -> Vec<Option<(f64, f64)>> {
        let samples = self.histories.samples_per_revolution.max(1);
        let skipped = (self.skipped * samples) as usize;
        let mut places = Vec::new();
        let mut before = f64::NAN;
        for (j, moved) in tip.history.displacement.iter().enumerate().skip(skipped) {
            let turned = (j + 1) as f64 / f64::from(samples);
            let angle = (tip.place.angle_rad / TAU + turned).rem_euclid(1.0) * 360.0;
            if angle < before {
                places.push(None);
            }
            before = angle;
            places.push(Some((angle, *moved)));
        }
        places
    }

    /// Draws the motion of a tip, a stroke for each revolution.
    fn path(&self, index: usize, tip: &Tip) -> Element {
        let mut points: Vec<Option<Place>> = Vec::new();
        for place in self.motion(tip) {
            let place = place.and_then(|(x, y)| self.diagram.inside(x, y));
            // Steps too short to be seen are left out.
            let hidden =
                points.last().copied().flatten().zip(place).is_some_and(|(last, place): (Place, Place)| {
                    f64::hypot(place.0 - last.0, place.1 - last.1) < SMALLEST_STEP
                });
            if !hidden {
                points.push(place);
            }
        }
        let (colour, dashes) = self.style(index);
        polyline(points)
            .set("class", "trajectory")
            .set("stroke", colour)
            .set("stroke-width", "1.3")
            .set("stroke-dasharray", dashes)
            .title(&tip.words())
    }

    fn style(&self, index: usize) -> (String, &'static str) {
        (ordinal(index, self.tips.len().max(2)), DASHES[index % DASHES.len()])
    }

    fn key(&self) -> Element {
        let mut key = Key::new(self.diagram.right() + 28.0, self.diagram.top + 8.0);
        for (index, tip) in self.tips.iter().enumerate().take(20) {
            let (colour, dashes) = self.style(index);
            let stroke = line((0.0, 0.0), (MARK_WIDTH, 0.0)).set("stroke", colour).set("stroke-width", "1.6");
            key = key.row(stroke.set("stroke-dasharray", dashes), &tip.words());
        }
        let metal = rectangle(0.0, -6.0, MARK_WIDTH, 12.0).set("fill", "#9a9a9a").set("fill-opacity", "0.35");
        key.row(metal.set("stroke", "#444444"), self.casing_words()).draw()
    }

    /// Words for the casing in the key.
    pub(super) fn casing_words(&self) -> &'static str {
        match self.walls.len() {
            1 => "casing",
            _ => "casing before each tip",
        }
    }
}
