//! Histories of one speed over its revolutions: the paper's Figs 6 to 8.

use super::axis::{label, ticks};
use super::cells::rpm;
use super::colour::{DASHES, ordinal};
use super::diagram::Diagram;
use super::heading::{heading, origin};
use super::key::Key;
use super::svg::{Element, document, group};
use super::trace::{Pen, Trace};
use rubmap_analysis::result::{ContactHistory, EnergyHistory, SensorHistory, SpeedHistories};

const WIDTH: f64 = 1180.0;
const HEIGHT: f64 = 640.0;
const LEFT: f64 = 100.0;
const PLOT_WIDTH: f64 = 830.0;
/// Width of a diagram with one curve, which needs no key.
const WIDE: f64 = 1040.0;

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

/// Draws histories of one speed over revolutions. `index` counts sensors for displacements and velocities and contact nodes for
/// forces; the wheel's contact and energy have none.
pub fn speed_histories(histories: &SpeedHistories, what: HistoryQuantity, index: usize) -> String {
    let panels = panels(histories, what, index);
    let title = title(histories, what, index);
    let (heading, bottom) = heading(LEFT, &title, &[words(histories, what)]);
    let top = bottom + 24.0;
    let mut content = vec![heading];
    let gap = 34.0;
    let count = panels.len().max(1) as f64;
    let height = (HEIGHT - 64.0 - top - gap * (count - 1.0)) / count;
    if panels.is_empty() {
        let empty = Diagram::new((LEFT, top), (PLOT_WIDTH, height), (0.0, 1.0), (0.0, 1.0));
        content.extend([empty.frame(), empty.words(NOT_RECORDED)]);
    }
    for (place, panel) in panels.iter().enumerate() {
        let corner = (LEFT, top + place as f64 * (height + gap));
        let last = place + 1 == panels.len();
        let width = if panels.iter().all(|panel| panel.curves.len() == 1) { WIDE } else { PLOT_WIDTH };
        content.push(panel.draw(histories, (corner, (width, height)), (place == 0, last)));
    }
    document(&title, WIDTH, HEIGHT, content)
}

/// Message where the quantity was not recorded.
pub(super) const NOT_RECORDED: &str = "Nothing to draw: this was not recorded";

/// Title of the horizontal axis.
pub(super) const REVOLUTIONS: &str = "revolutions since the start";

/// Title: the revolutions, the quantity and the speed.
pub(super) fn title(histories: &SpeedHistories, what: HistoryQuantity, index: usize) -> String {
    let [begin, end] = histories.revolutions;
    format!(
        "Revolutions {begin} to {end}: {}, {} rpm",
        subject(histories, what, index),
        label(rpm(histories.speed_rad_s), 0)
    )
}

/// Paragraphs below the title: origin, and how samples were averaged.
pub(super) fn words(histories: &SpeedHistories, what: HistoryQuantity) -> String {
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

/// Curve of a panel.
pub(super) struct Curve<'a> {
    pub(super) words: String,
    pub(super) values: &'a [f64],
}

/// Curves over one vertical axis.
pub(super) struct Panel<'a> {
    pub(super) axis: String,
    pub(super) curves: Vec<Curve<'a>>,
}

/// Panels of the quantity that have curves.
pub(super) fn panels(histories: &SpeedHistories, what: HistoryQuantity, index: usize) -> Vec<Panel<'_>> {
    let mut panels = all_panels(histories, what, index);
    panels.retain(|panel| !panel.curves.is_empty());
    panels
}

fn all_panels<'a>(histories: &'a SpeedHistories, quantity: HistoryQuantity, index: usize) -> Vec<Panel<'a>> {
    let units = &histories.units;
    let (length, force, time) = (&units.length, &units.force, &units.time);
    let of_sensor = |axis: String, values: fn(&SensorHistory) -> &[f64]| {
        let found = histories.sensors.get(index).map(values).filter(|values| !values.is_empty());
        let curves = found.map(|values| Curve { words: String::new(), values });
        vec![Panel { axis, curves: curves.into_iter().collect() }]
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
            vec![Panel { axis: format!("force, {force}"), curves }]
        }
        HistoryQuantity::Contact => contact.map_or_else(Vec::new, |contact| {
            let curve = |values: &'a Vec<f64>| {
                let values = Some(values).filter(|values| !values.is_empty());
                values.map(|values| Curve { words: String::new(), values }).into_iter().collect()
            };
            vec![
                Panel {
                    axis: "contact nodes that touch".to_owned(),
                    curves: curve(&contact.nodes_in_contact),
                },
                Panel {
                    axis: format!("length in contact, {length}"),
                    curves: curve(&contact.contact_length),
                },
            ]
        }),
        HistoryQuantity::Energy => {
            let curves = histories.energy.as_ref().map_or_else(Vec::new, energies);
            vec![Panel { axis: format!("energy, {force}·{length}"), curves }]
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

impl Panel<'_> {
    fn draw(
        &self,
        histories: &SpeedHistories,
        place: ((f64, f64), (f64, f64)),
        (first, last): (bool, bool),
    ) -> Element {
        let diagram = self.diagram(histories, place);
        let (x, y) = (ticks(diagram.x.values, 10.0), ticks(diagram.y.values, (place.1.1 / 60.0).max(2.0)));
        let step = 1.0 / f64::from(histories.samples_per_revolution.max(1));
        let begin = f64::from(histories.revolutions[0]);
        let mut bands = false;
        let mut curves = group();
        for (index, curve) in self.curves.iter().enumerate() {
            let at = |(j, value): (usize, &f64)| diagram.point(begin + (j + 1) as f64 * step, *value);
            let places = curve.values.iter().enumerate().map(at).collect();
            let trace = Trace::of(places, diagram.x.place(1.0) - diagram.x.place(0.0));
            bands |= trace.is_band;
            curves = curves.child(trace.drawn(&self.pen(index)).title(&curve.words));
        }
        group()
            .set("class", "panel")
            .child(diagram.grid(&x, &y))
            .child(curves)
            .child(diagram.frame())
            .child(diagram.x_axis(&x, if last { REVOLUTIONS } else { "" }))
            .child(diagram.y_axis(&y, &self.axis, 72.0))
            .child(self.key(&diagram, bands, first))
    }

    fn pen(&self, index: usize) -> Pen {
        let count = self.curves.len();
        let dashes = if count > 2 * DASHES.len() { "" } else { DASHES[index % DASHES.len()] };
        let colour = if count == 1 { "#1f4e79".to_owned() } else { ordinal(index, count) };
        Pen { colour, width: 1.5, dashes, of_many: count > 2 }
    }

    fn diagram(&self, histories: &SpeedHistories, (corner, size): ((f64, f64), (f64, f64))) -> Diagram {
        let [begin, end] = histories.revolutions.map(f64::from);
        let values = self.curves.iter().flat_map(|curve| curve.values.iter().copied());
        let finite = values.filter(|value| value.is_finite());
        let (low, high) = finite.fold((0f64, 0f64), |(low, high), value| (low.min(value), high.max(value)));
        // The axis of a quantity that never changes still needs a height.
        let room = if low < high { 0.06 * (high - low) } else { 1.0 };
        let x = if begin < end { (begin, end) } else { (begin, begin + 1.0) };
        Diagram::new(corner, size, x, (if low < 0.0 { low - room } else { 0.0 }, high + room))
    }

    fn key(&self, diagram: &Diagram, bands: bool, first: bool) -> Element {
        /// Largest number of curves that the key names; of more only the first and the last are named.
        const MOST: usize = 16;
        let mut key = Key::new(diagram.right() + 28.0, diagram.top + 8.0);
        let count = self.curves.len();
        let shown = |index: &usize| count <= MOST || *index == 0 || index + 1 == count;
        for index in (0..count).filter(|index| count > 1 && shown(index)) {
            key = key.row(self.pen(index).mark(bands), &self.curves[index].words);
        }
        match (bands, count) {
            // The note stands above the frame of the first panel; below it are the numbers of the axis.
            (true, 1) if !first => key.draw(),
            (true, 1) => Key::new(diagram.right() - 190.0, diagram.top - 14.0)
                .note("band: from lowest to highest")
                .draw(),
            (true, _) => key.note("bands: from lowest to highest").draw(),
            (false, _) => key.draw(),
        }
    }
}
