//! Histories of one speed over its revolutions: the paper's Figs 6 to 8.

use std::f64::consts::TAU;

use super::axis::label;
use super::cells::rpm;
use super::drawing::Drawing;
use super::heading::origin;
use super::layer;
use super::sketch::{Axis, Panel, Sketch};
use super::style::{Colour, Dash, Pen};
use super::trace;
use super::trajectories::growing;
use rubmap_analysis::result::{ContactHistory, EnergyHistory, SensorHistory, SpeedHistories, TipPlace};

/// Quantity of the histories of a speed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum HistoryQuantity {
    /// Displacement of a sensor.
    Displacement,
    /// Velocity of a sensor.
    Velocity,
    /// Force on a contact node, a line for every blade that was recorded.
    Force,
    /// Number of contact nodes that touch, and the length of the contact lines in contact.
    Contact,
    /// Energy and its parts.
    Energy,
}

/// Histories of one speed over revolutions. `index` counts sensors for displacements and velocities and contact nodes for forces; the
/// wheel's contact and energy have none.
pub fn speed_histories(histories: &SpeedHistories, what: HistoryQuantity, index: usize) -> Drawing<'static> {
    let groups = groups(histories, what, index);
    let mut paragraphs = vec![words(histories, what)];
    paragraphs.extend(
        groups
            .iter()
            .any(|group| group.wall.is_some())
            .then(|| growing(histories, histories.revolutions[0]))
            .flatten(),
    );
    let sketch = Sketch::new("speed_histories", title(histories, what, index), paragraphs);
    let sketch = sketch.high(360 + 140 * groups.len());
    let sketch = sketch.meta("speed_index", histories.index).meta("speed_rpm", rpm(histories.speed_rad_s));
    if groups.is_empty() {
        return sketch.nothing("Nothing to draw: this was not recorded").into();
    }
    let (top, gap, count) = (sketch.top() + 24.0, 34.0, groups.len() as f64);
    let height = (576.0 - top - gap * (count - 1.0)) / count;
    // A single curve needs no key, unless it is a band or stands before a casing.
    let is_plain = |group: &Group| {
        let is_alone = matches!(&group.curves[..], [alone] if !trace::is_band(alone.values.len(), 830.0));
        is_alone && group.wall.is_none()
    };
    let width = if groups.iter().all(is_plain) { 1040.0 } else { 830.0 };
    groups
        .iter()
        .enumerate()
        .fold(sketch, |sketch, (place, group)| {
            let corner = (92.0, top + place as f64 * (height + gap));
            let mut panel = group.panel(histories, corner, (width, height));
            if groups.len() > 1 {
                // Panels stand from the top down, with room between them.
                let foot = 1.0 - (place + 1) as f64 / count;
                let room = if place + 1 < groups.len() { 0.05 } else { 0.0 };
                panel = panel.domain(foot + room, foot + 1.0 / count);
            }
            sketch.with(panel)
        })
        .into()
}

/// Title: the revolutions, the quantity and the speed.
fn title(histories: &SpeedHistories, what: HistoryQuantity, index: usize) -> String {
    let [begin, end] = histories.revolutions;
    format!(
        "Revolutions {begin} to {end}: {}, {} rpm",
        subject(histories, what, index),
        label(rpm(histories.speed_rad_s), 0)
    )
}

/// Paragraphs below the title: origin, and how samples were averaged.
fn words(histories: &SpeedHistories, what: HistoryQuantity) -> String {
    let mut words = vec![origin(&histories.settings.model, &histories.version)];
    if matches!(what, HistoryQuantity::Force | HistoryQuantity::Contact) {
        words.insert(0, "means over the interval between two samples".to_owned());
    }
    words.join(" · ")
}

fn subject(histories: &SpeedHistories, what: HistoryQuantity, index: usize) -> String {
    let of_sensor = |what: &str| match histories.sensors.get(index) {
        Some(found) => found.sensor.measuring(what),
        None => format!("{what} of sensor {index}"),
    };
    match what {
        HistoryQuantity::Displacement => of_sensor("displacement"),
        HistoryQuantity::Velocity => of_sensor("velocity"),
        HistoryQuantity::Force => format!("force on contact node {index}"),
        HistoryQuantity::Contact => "contact of the wheel with its casing".to_owned(),
        HistoryQuantity::Energy => "energy of the wheel since the start".to_owned(),
    }
}

/// Curve of a group.
struct Curve<'a> {
    words: String,
    values: &'a [f64],
}

/// Curves over one vertical axis.
struct Group<'a> {
    axis: String,
    curves: Vec<Curve<'a>>,
    /// Casing that the node of the only curve meets.
    wall: Option<&'a TipPlace>,
}

impl<'a> Group<'a> {
    fn new(axis: impl Into<String>, curves: Vec<Curve<'a>>) -> Self {
        Self { axis: axis.into(), curves, wall: None }
    }
}

/// Groups of the quantity that have curves.
fn groups(histories: &SpeedHistories, what: HistoryQuantity, index: usize) -> Vec<Group<'_>> {
    let mut groups = all_groups(histories, what, index);
    groups.retain(|group| !group.curves.is_empty());
    groups
}

fn all_groups<'a>(histories: &'a SpeedHistories, quantity: HistoryQuantity, index: usize) -> Vec<Group<'a>> {
    let units = &histories.units;
    let (length, force, time) = (&units.length, &units.force, &units.time);
    let of_sensor = |axis: String, values: fn(&SensorHistory) -> &[f64]| {
        let found = histories.sensors.get(index).map(values).filter(|values| !values.is_empty());
        let curves = found.map(|values| Curve { words: String::new(), values });
        vec![Group::new(axis, curves.into_iter().collect())]
    };
    let gauge =
        histories.sensors.get(index).map(|history| &history.sensor).filter(|sensor| sensor.gauge.is_some());
    let unit = gauge.map_or(length.as_str(), |_| "1");
    let (what, rate) = if gauge.is_some() { ("strain", "strain rate") } else { ("displacement", "velocity") };
    let contact = histories.contact.as_ref();
    match quantity {
        HistoryQuantity::Displacement => {
            let mut groups = of_sensor(format!("{what}, {unit}"), |s| &s.displacement);
            let wall = histories.sensors.get(index).and_then(|history| history.tip.as_ref());
            groups.iter_mut().for_each(|group| group.wall = wall);
            groups
        }
        HistoryQuantity::Velocity => of_sensor(format!("{rate}, {unit}/{time}"), |s| &s.velocity),
        HistoryQuantity::Force => {
            let curves = contact.map_or_else(Vec::new, |contact| forces(contact, index));
            vec![Group::new(format!("force, {force}"), curves)]
        }
        HistoryQuantity::Contact => contact.map_or_else(Vec::new, |contact| {
            let curve = |values: &'a Vec<f64>| {
                let values = Some(values).filter(|values| !values.is_empty());
                values.map(|values| Curve { words: String::new(), values }).into_iter().collect()
            };
            vec![
                Group::new("contact nodes that touch", curve(&contact.nodes_in_contact)),
                Group::new(format!("length in contact, {length}"), curve(&contact.contact_length)),
            ]
        }),
        HistoryQuantity::Energy => {
            let [stored, added] = histories.energy.as_ref().map_or_else(Default::default, energies);
            vec![
                Group::new(format!("stored: kinetic and potential, {force}·{length}"), stored),
                Group::new(format!("added up since the start, {force}·{length}"), added),
            ]
        }
    }
}

fn forces(contact: &ContactHistory, node: usize) -> Vec<Curve<'_>> {
    let sectors = contact.force.iter().enumerate();
    let curve = |(sector, nodes): (usize, &'_ Vec<Vec<f64>>)| {
        let values = nodes.get(node).filter(|values| !values.is_empty())?;
        Some((sector, values.len()))
    };
    let found: Vec<(usize, usize)> = sectors.filter_map(curve).collect();
    found
        .into_iter()
        .map(|(sector, _)| Curve { words: format!("blade {sector}"), values: &contact.force[sector][node] })
        .collect()
}

/// Stored energy, and works and losses since the start: they grow without bounds beside it.
fn energies(energy: &EnergyHistory) -> [Vec<Curve<'_>>; 2] {
    let stored = Curve { words: String::new(), values: &energy.mechanical };
    let added = [
        ("work of contact", &energy.contact_work),
        ("lost to damping", &energy.damping_loss),
        ("work of engine orders", &energy.excitation_work),
        ("work of mistuning", &energy.mistuning_work),
        ("work of stiffening blades", &energy.bending_work),
        ("work on the casing", &energy.casing_work),
        ("lost in the casing", &energy.casing_loss),
        ("heat of friction", &energy.friction_heat),
    ];
    let there = added.into_iter().filter(|(_, values)| !values.is_empty());
    let added = there.map(|(words, values)| Curve { words: words.to_owned(), values }).collect();
    [Some(stored).filter(|curve| !curve.values.is_empty()).into_iter().collect(), added]
}

/// Outward distance of the casing before a node after so many revolutions.
fn distance(wall: &TipPlace, turned: f64) -> f64 {
    if wall.heights.is_empty() {
        return wall.clearance;
    }
    let count = wall.heights.len();
    let place = (wall.angle_rad / TAU + turned).rem_euclid(1.0) * count as f64;
    let (before, share) = (place as usize % count, place.fract());
    let height = (1.0 - share) * wall.heights[before] + share * wall.heights[(before + 1) % count];
    wall.clearance - height
}

impl Group<'_> {
    fn panel(&self, histories: &SpeedHistories, corner: (f64, f64), size: (f64, f64)) -> Panel<'static> {
        let [begin, end] = histories.revolutions.map(f64::from);
        let step = 1.0 / f64::from(histories.samples_per_revolution.max(1));
        let samples = self.curves.first().map_or(0, |curve| curve.values.len());
        let wall: Vec<f64> = self
            .wall
            .map_or_else(Vec::new, |wall| (1..=samples).map(|j| distance(wall, j as f64 * step)).collect());
        let values = self.curves.iter().flat_map(|curve| curve.values).chain(&wall).copied();
        let finite = values.filter(|value| value.is_finite());
        let (low, high) = finite.fold((0f64, 0f64), |(low, high), value| (low.min(value), high.max(value)));
        // The axis of a quantity that never changes still needs a height.
        let room = if low < high { 0.06 * (high - low) } else { 1.0 };
        let x = if begin < end { (begin, end) } else { (begin, begin + 1.0) };
        let x = Axis::linear("revolutions since the start", x, 10.0).free();
        let y = (if low < 0.0 { low - room } else { 0.0 }, high + room);
        let mut panel =
            Panel::new(corner, size, x, Axis::linear(&self.axis, y, (size.1 / 60.0).max(2.0)).free());
        let count = self.curves.len();
        let history = |(index, curve): (usize, &Curve)| {
            let at = |(j, value): (usize, &f64)| Some((begin + (j + 1) as f64 * step, *value));
            let name = if curve.words.is_empty() { &self.axis } else { &curve.words };
            let drawn = layer::Curve::new(name, curve.values.iter().enumerate().map(at), self.pen(index));
            let drawn = drawn.title(&curve.words).over(&curve.words, "%{x:.4f} revolutions: %{y:.4~g}");
            if count > 1 || self.wall.is_some() { drawn } else { drawn.unlisted() }
        };
        if panel.histories(self.curves.iter().enumerate().map(history).collect()) {
            panel.note("bands: from lowest to highest");
        }
        let at = |j: usize| begin + (j + 1) as f64 * step;
        let grey = |dash, width| Pen::new(Colour::neutral("#444444"), dash, width);
        let mut add = |name: &str, places: Vec<Option<layer::Place>>, pen: Pen| {
            let curve = layer::Curve::new(name, places, pen).over(name, "%{x:.4f} revolutions: %{y:.4~g}");
            panel.sample(curve.sample(), name);
            panel.push(curve.class("casing"));
        };
        if let Some(found) = self.wall {
            add(
                "casing: contact begins",
                wall.iter().enumerate().map(|(j, value)| Some((at(j), *value))).collect(),
                grey(Dash::Solid, 1.6),
            );
            if !found.heights.is_empty() {
                let ends = [at(0), at(samples.max(1) - 1)].map(|x| Some((x, found.clearance)));
                add("clearance", ends.to_vec(), grey(Dash::Dashed, 1.0));
            }
        }
        panel
    }

    fn pen(&self, index: usize) -> Pen {
        let count = self.curves.len();
        let colour = if count == 1 { Colour::curve() } else { Colour::ordinal(index, count) };
        Pen::new(colour, Dash::nth(index), 1.5)
    }
}
