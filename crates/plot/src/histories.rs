//! Displacements over the first revolutions, one line per size: the paper's Figs 6 and 7.

use super::axis::{label, ticks};
use super::cells::rpm;
use super::colour::{DASHES, DISTINCT};
use super::diagram::Diagram;
use super::heading::heading;
use super::key::Key;
use super::marks::order;
use super::svg::{Element, group};
use super::trace::{Pen, Trace};
use super::{scheme, svg};
use rubmap_analysis::result::HistoryLine;
use rubmap_analysis::run::Histories;

const WIDTH: f64 = 1180.0;
const HEIGHT: f64 = 640.0;
const LEFT: f64 = 92.0;
const PLOT_WIDTH: f64 = 800.0;

/// Draws the displacements of the sensor of index `sensor` over revolutions, one line per size of the model; the reference is thin and
/// black.
pub fn histories(histories: &Histories, sensor: usize) -> String {
    let title = title(histories, sensor);
    let curves = curves(histories, sensor);
    let (heading, bottom) = heading(LEFT, &title, &[words(histories)]);
    let diagram = diagram(&curves, histories.samples_per_revolution, bottom + 24.0);
    let mut content = vec![heading];
    if curves.is_empty() {
        content.extend([diagram.frame(), diagram.words(NOT_COMPLETED)]);
        return svg::document(&title, WIDTH, HEIGHT, content);
    }
    let axis = axis(histories, sensor);
    let (x, y) = (ticks(diagram.x.values, 8.0), ticks(diagram.y.values, 8.0));
    content.push(diagram.grid(&x, &y));
    let mut bands = false;
    content.extend(curves.iter().enumerate().map(|(index, curve)| {
        let step = 1.0 / f64::from(histories.samples_per_revolution.max(1));
        let place = |(j, value): (usize, &f64)| diagram.point((j + 1) as f64 * step, *value);
        let points: Vec<(f64, f64)> = curve.displacement.iter().enumerate().map(place).collect();
        let trace = Trace::of(points, diagram.x.place(1.0) - diagram.x.place(0.0));
        bands |= trace.is_band;
        trace.drawn(&curve.pen(index, curves.len() > 2)).title(&curve.title())
    }));
    content.extend([
        diagram.frame(),
        diagram.x_axis(&x, "revolutions"),
        diagram.y_axis(&y, &axis, 66.0),
        key(&curves, &diagram, bands),
    ]);
    svg::document(&title, WIDTH, HEIGHT, content)
}

/// Message where no run has a line.
pub(super) const NOT_COMPLETED: &str = "Nothing to draw: no run was completed";

/// Title: number of revolutions, sensor and speed.
pub(super) fn title(histories: &Histories, sensor: usize) -> String {
    let measured =
        histories.sensors.get(sensor).map_or_else(|| "displacement".to_owned(), ToString::to_string);
    let curves = curves(histories, sensor);
    let longest = curves.iter().map(|curve| curve.displacement.len()).max().unwrap_or(0);
    let revolutions = longest as f64 / f64::from(histories.samples_per_revolution.max(1));
    match revolutions {
        0.0 => format!("First revolutions: {measured}, {} rpm", label(rpm(histories.speed_rad_s), 0)),
        _ => format!(
            "First {} revolutions: {measured}, {} rpm",
            order(revolutions),
            label(rpm(histories.speed_rad_s), 0)
        ),
    }
}

/// Paragraph below the title: one line per size of the model, and the program version.
pub(super) fn words(histories: &Histories) -> String {
    let words = "one line per size of the model, each at the finest time step that was completed";
    format!("{words} · rubmap {}", histories.version)
}

/// Title of the vertical axis.
pub(super) fn axis(histories: &Histories, sensor: usize) -> String {
    match histories.sensors.get(sensor) {
        Some(sensor) if sensor.gauge.is_some() => sensor.unit(&histories.units).to_owned(),
        _ => format!("displacement, {}", histories.units.length),
    }
}

/// Lines of a sensor.
pub(super) fn curves(histories: &Histories, sensor: usize) -> Vec<Curve<'_>> {
    histories.lines.iter().filter_map(|line| Curve::of(line, sensor)).collect()
}

/// Line of one size of the model at one sensor.
pub(super) struct Curve<'a> {
    pub(super) line: &'a HistoryLine,
    pub(super) displacement: &'a [f64],
}

impl<'a> Curve<'a> {
    fn of(line: &'a HistoryLine, sensor: usize) -> Option<Self> {
        let displacement = line.displacement.get(sensor).filter(|samples| !samples.is_empty())?;
        Some(Self { line, displacement })
    }

    /// Words for the line.
    pub(super) fn title(&self) -> String {
        let setting = &self.line.setting;
        format!(
            "{}{} modes per speed, {} unknowns, {}, {} steps a revolution",
            if self.line.reference { "reference: " } else { "" },
            setting.modes_per_speed,
            label(self.line.unknowns.into(), 0),
            scheme::words(setting.scheme),
            label(setting.steps_per_revolution.into(), 0)
        )
    }

    /// Words for the size of the model: modes per speed and unknowns.
    pub(super) fn size(&self) -> String {
        format!(
            "{}{} · {} unknowns",
            if self.line.reference { "reference: " } else { "" },
            self.line.setting.modes_per_speed,
            label(self.line.unknowns.into(), 0)
        )
    }

    /// Pen of the line: the reference is thin and black over the broad lines of the others.
    fn pen(&self, index: usize, of_many: bool) -> Pen {
        if self.line.reference {
            return Pen { colour: "black".to_owned(), width: 0.9, dashes: "", of_many };
        }
        let colour = DISTINCT[index % DISTINCT.len()].to_owned();
        Pen { colour, width: 2.2, dashes: DASHES[index % DASHES.len()], of_many }
    }
}

fn diagram(curves: &[Curve], samples_per_revolution: u32, top: f64) -> Diagram {
    let samples = curves.iter().map(|curve| curve.displacement.len()).max().unwrap_or(1);
    let revolutions = samples as f64 / f64::from(samples_per_revolution.max(1));
    let values = curves.iter().flat_map(|curve| curve.displacement.iter().copied());
    let (low, high) = values.fold((0f64, 0f64), |(low, high), value| (low.min(value), high.max(value)));
    // The axis of a tip that never moves still needs a height.
    let room = if low < high { 0.05 * (high - low) } else { 1.0 };
    let size = (PLOT_WIDTH, HEIGHT - 70.0 - top);
    Diagram::new((LEFT, top), size, (0.0, revolutions), (low - room, high + room))
}

fn key(curves: &[Curve], diagram: &Diagram, bands: bool) -> Element {
    let key = Key::new(diagram.right() + 30.0, diagram.top).heading("modes per speed · unknowns");
    let row = |key: Key, (index, curve): (usize, &Curve)| {
        let mark = curve.pen(index, curves.len() > 2).mark(bands);
        key.row(group().child(mark), &curve.size())
    };
    let key = curves.iter().enumerate().fold(key, row);
    if bands { key.heading("bands: from lowest to highest").draw() } else { key.draw() }
}
