//! Histories of one speed over its revolutions: the paper's Figs 6 to 8.

use super::axis::label;
use super::cells::rpm;
use super::drawing::Drawing;
use super::heading::origin;
use super::layer;
use super::sketch::{Axis, Panel, Sketch};
use super::style::{Colour, Dash, Pen};
use super::trace;
use rubmap_analysis::result::{ContactHistory, EnergyHistory, SensorHistory, SpeedHistories};

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
    let sketch = Sketch::new("speed_histories", title(histories, what, index), vec![words(histories, what)]);
    let sketch = sketch.high(360 + 140 * groups.len());
    let sketch = sketch.meta("speed_index", histories.index).meta("speed_rpm", rpm(histories.speed_rad_s));
    if groups.is_empty() {
        return sketch.nothing("Nothing to draw: this was not recorded").into();
    }
    let (top, gap, count) = (sketch.top() + 24.0, 34.0, groups.len() as f64);
    let height = (576.0 - top - gap * (count - 1.0)) / count;
    // A single curve needs no key, unless it is a band.
    let is_plain =
        |group: &Group| matches!(&group.curves[..], [alone] if !trace::is_band(alone.values.len(), 830.0));
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
        vec![Group { axis, curves: curves.into_iter().collect() }]
    };
    let gauge =
        histories.sensors.get(index).map(|history| &history.sensor).filter(|sensor| sensor.gauge.is_some());
    let unit = gauge.map_or(length.as_str(), |_| "1");
    let (what, rate) = if gauge.is_some() { ("strain", "strain rate") } else { ("displacement", "velocity") };
    let contact = histories.contact.as_ref();
    match quantity {
        HistoryQuantity::Displacement => of_sensor(format!("{what}, {unit}"), |s| &s.displacement),
        HistoryQuantity::Velocity => of_sensor(format!("{rate}, {unit}/{time}"), |s| &s.velocity),
        HistoryQuantity::Force => {
            let curves = contact.map_or_else(Vec::new, |contact| forces(contact, index));
            vec![Group { axis: format!("force, {force}"), curves }]
        }
        HistoryQuantity::Contact => contact.map_or_else(Vec::new, |contact| {
            let curve = |values: &'a Vec<f64>| {
                let values = Some(values).filter(|values| !values.is_empty());
                values.map(|values| Curve { words: String::new(), values }).into_iter().collect()
            };
            vec![
                Group {
                    axis: "contact nodes that touch".to_owned(),
                    curves: curve(&contact.nodes_in_contact),
                },
                Group {
                    axis: format!("length in contact, {length}"),
                    curves: curve(&contact.contact_length),
                },
            ]
        }),
        HistoryQuantity::Energy => {
            let curves = histories.energy.as_ref().map_or_else(Vec::new, energies);
            vec![Group { axis: format!("energy, {force}·{length}"), curves }]
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

fn energies(energy: &EnergyHistory) -> Vec<Curve<'_>> {
    let all = [
        ("mechanical energy", &energy.mechanical),
        ("work of contact", &energy.contact_work),
        ("lost to damping", &energy.damping_loss),
        ("work of engine orders", &energy.excitation_work),
        ("work of mistuning", &energy.mistuning_work),
        ("work on the casing", &energy.casing_work),
        ("lost in the casing", &energy.casing_loss),
        ("heat of friction", &energy.friction_heat),
    ];
    let there = all.into_iter().filter(|(_, values)| !values.is_empty());
    there.map(|(words, values)| Curve { words: words.to_owned(), values }).collect()
}

impl Group<'_> {
    fn panel(&self, histories: &SpeedHistories, corner: (f64, f64), size: (f64, f64)) -> Panel<'static> {
        let [begin, end] = histories.revolutions.map(f64::from);
        let values = self.curves.iter().flat_map(|curve| curve.values.iter().copied());
        let finite = values.filter(|value| value.is_finite());
        let (low, high) = finite.fold((0f64, 0f64), |(low, high), value| (low.min(value), high.max(value)));
        // The axis of a quantity that never changes still needs a height.
        let room = if low < high { 0.06 * (high - low) } else { 1.0 };
        let x = if begin < end { (begin, end) } else { (begin, begin + 1.0) };
        let x = Axis::linear("revolutions since the start", x, 10.0).free();
        let y = (if low < 0.0 { low - room } else { 0.0 }, high + room);
        let mut panel =
            Panel::new(corner, size, x, Axis::linear(&self.axis, y, (size.1 / 60.0).max(2.0)).free());
        let step = 1.0 / f64::from(histories.samples_per_revolution.max(1));
        let count = self.curves.len();
        let history = |(index, curve): (usize, &Curve)| {
            let at = |(j, value): (usize, &f64)| Some((begin + (j + 1) as f64 * step, *value));
            let name = if curve.words.is_empty() { &self.axis } else { &curve.words };
            let drawn = layer::Curve::new(name, curve.values.iter().enumerate().map(at), self.pen(index));
            let drawn = drawn.title(&curve.words).over(&curve.words, "%{x:.4f} revolutions: %{y:.4~g}");
            if count > 1 { drawn } else { drawn.unlisted() }
        };
        if panel.histories(self.curves.iter().enumerate().map(history).collect()) {
            panel.note("bands: from lowest to highest");
        }
        panel
    }

    fn pen(&self, index: usize) -> Pen {
        let count = self.curves.len();
        let colour = if count == 1 { Colour::curve() } else { Colour::ordinal(index, count) };
        Pen::new(colour, Dash::nth(index), 1.5)
    }
}
