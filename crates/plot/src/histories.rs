//! Displacements over the first revolutions, one line per size: the paper's Figs 6 and 7.

use super::axis::label;
use super::cells::rpm;
use super::colour::DISTINCT;
use super::drawing::Drawing;
use super::layer::Curve;
use super::marks::order;
use super::scheme;
use super::sketch::{Axis, Panel, Sketch};
use super::style::{Colour, Dash, Pen};
use rubmap_analysis::result::HistoryLine;
use rubmap_analysis::run::Histories;

/// Displacements of the sensor of index `sensor` over revolutions, one line per size of the model; the reference is thin over the broad
/// lines of the others.
pub fn histories(histories: &Histories, sensor: usize) -> Drawing<'static> {
    let lines: Vec<Line> = histories.lines.iter().filter_map(|line| Line::of(line, sensor)).collect();
    let sketch = Sketch::new("histories", title(histories, sensor, &lines), vec![words(histories)]).high(520);
    let sketch =
        sketch.meta("sensor", histories.sensors.get(sensor)).meta("speed_rpm", rpm(histories.speed_rad_s));
    if lines.is_empty() {
        return sketch.nothing("Nothing to draw: no run was completed").into();
    }
    let per_revolution = f64::from(histories.samples_per_revolution.max(1));
    let revolutions = longest(&lines) as f64 / per_revolution;
    let values = lines.iter().flat_map(|line| line.displacement.iter().copied());
    let (low, high) = values.fold((0f64, 0f64), |(low, high), value| (low.min(value), high.max(value)));
    // The axis of a tip that never moves still needs a height.
    let room = if low < high { 0.05 * (high - low) } else { 1.0 };
    let x = Axis::linear("revolutions", (0.0, revolutions), 8.0).free();
    let y = Axis::linear(axis(histories, sensor), (low - room, high + room), 8.0).free();
    let top = sketch.top() + 24.0;
    let mut panel = Panel::new((92.0, top), (800.0, 570.0 - top), x, y);
    panel.heading("modes per speed · unknowns");
    let curve = |(index, line): (usize, &Line)| {
        let place = |(j, value): (usize, &f64)| Some(((j + 1) as f64 / per_revolution, *value));
        let curve = Curve::new(
            &line.size(),
            line.displacement.iter().enumerate().map(place),
            line.pen(index, lines.len()),
        );
        curve.title(&line.title()).over(line.title(), "%{x:.4f} revolutions: %{y:.4~g}")
    };
    if panel.histories(lines.iter().enumerate().map(curve).collect()) {
        panel.heading("bands: from lowest to highest");
    }
    sketch.with(panel).into()
}

fn longest(lines: &[Line]) -> usize {
    lines.iter().map(|line| line.displacement.len()).max().unwrap_or(0)
}

/// Title: number of revolutions, sensor and speed.
fn title(histories: &Histories, sensor: usize, lines: &[Line]) -> String {
    let measured =
        histories.sensors.get(sensor).map_or_else(|| "displacement".to_owned(), ToString::to_string);
    let revolutions = longest(lines) as f64 / f64::from(histories.samples_per_revolution.max(1));
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
fn words(histories: &Histories) -> String {
    let words = "one line per size of the model, each at the finest time step that was completed";
    format!("{words} · rubmap {}", histories.version)
}

/// Title of the vertical axis.
fn axis(histories: &Histories, sensor: usize) -> String {
    match histories.sensors.get(sensor) {
        Some(sensor) if sensor.gauge.is_some() => sensor.unit(&histories.units).to_owned(),
        _ => format!("displacement, {}", histories.units.length),
    }
}

/// Line of one size of the model at one sensor.
struct Line<'a> {
    line: &'a HistoryLine,
    displacement: &'a [f64],
}

impl<'a> Line<'a> {
    fn of(line: &'a HistoryLine, sensor: usize) -> Option<Self> {
        let displacement = line.displacement.get(sensor).filter(|samples| !samples.is_empty())?;
        Some(Self { line, displacement })
    }

    /// Words for the line.
    fn title(&self) -> String {
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
    fn size(&self) -> String {
        format!(
            "{}{} · {} unknowns",
            if self.line.reference { "reference: " } else { "" },
            self.line.setting.modes_per_speed,
            label(self.line.unknowns.into(), 0)
        )
    }

    fn pen(&self, index: usize, count: usize) -> Pen {
        if self.line.reference {
            return Pen::new(Colour::neutral("black"), Dash::Solid, 0.9);
        }
        let paper = DISTINCT[index % DISTINCT.len()].to_owned();
        Pen::new(Colour { paper, ..Colour::ordinal(index, count) }, Dash::nth(index), 2.2)
    }
}
