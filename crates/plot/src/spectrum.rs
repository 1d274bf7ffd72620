//! Spectra of one speed: the paper's Fig 9, and Fig 11 in the fixed frame.

use super::axis::{decades, label, significant, ticks};
use super::cells::rpm;
use super::colour::ordinal;
use super::diagram::Diagram;
use super::key::{Key, MARK_WIDTH};
use super::svg::{Element, INK, document, group, line};
use super::{heading, marks};
use rubmap_analysis::result::{Point, SensorSpectrum, SpeedSpectra};
use rubmap_wheel::dynamics::sector::Units;

const WIDTH: f64 = 1180.0;
const HEIGHT: f64 = 720.0;
const LEFT: f64 = 96.0;
const PLOT_WIDTH: f64 = 860.0;

/// Share of the largest amplitude below which lines are not drawn.
const QUIETEST: f64 = 1e-4;

/// Largest number of lines drawn; more would be a black area.
pub(super) const MOST: usize = 4000;

/// Frame from which the wheel is observed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Frame {
    /// Rotating frame, which turns with the wheel.
    Rotating,
    /// Fixed frame beside the wheel: a wave of nodal diameter n at engine order k is seen at k + n or k − n, as it travels with the
    /// rotation or against it.
    Fixed,
}

/// Draws the spectra of the sensor of index `sensor` at one speed: in the rotating frame its amplitude above those of the wheel's nodal
/// diameters, in the fixed frame the latter where they may be seen. Amplitudes are logarithmic over four decades.
pub(super) fn spectrum(
    spectra: &SpeedSpectra,
    point: &Point,
    units: &Units,
    sensor: usize,
    frame: Frame,
) -> String {
    let speed = label(rpm(point.speed_rad_s), 0);
    let Some(found) = spectra.sensors.get(sensor) else {
        let title = format!("Spectrum, {speed} rpm");
        let (heading, _) = heading::heading(LEFT, &title, &[format!("there is no sensor of index {sensor}")]);
        return document(&title, WIDTH, HEIGHT, vec![heading]);
    };
    let title = title(point, found, frame);
    let words = words(point, frame);
    let (heading, bottom) = heading::heading(LEFT, &title, &words);
    let unit = found.sensor.unit(units);
    let lines = Lines::of(spectra, found, frame);
    let mut content = vec![heading];
    match frame {
        Frame::Rotating => {
            let height = 0.5 * (HEIGHT - 70.0 - bottom - 30.0 - 34.0);
            let above = ((LEFT, bottom + 22.0), (PLOT_WIDTH, height));
            content.extend(whole(spectra, found, unit, above));
            content.extend(lines.draw(unit, ((LEFT, bottom + 56.0 + height), (PLOT_WIDTH, height))));
        }
        Frame::Fixed => {
            let top = bottom + 22.0;
            content.extend(lines.draw(unit, ((LEFT, top), (PLOT_WIDTH, HEIGHT - 74.0 - top))));
        }
    }
    document(&title, WIDTH, HEIGHT, content)
}

/// Title: the frame, the sensor and the speed.
pub(super) fn title(point: &Point, found: &SensorSpectrum, frame: Frame) -> String {
    let where_from = match frame {
        Frame::Rotating => "rotating frame",
        Frame::Fixed => "fixed frame",
    };
    format!("Spectrum in the {where_from}: {}, {} rpm", found.sensor, label(rpm(point.speed_rad_s), 0))
}

/// Paragraphs below the title: the verdict on the speed and the basis of the amplitudes.
pub(super) fn words(point: &Point, frame: Frame) -> Vec<String> {
    let basis = "amplitudes of nodal diameters are those of the wheel, cosine and sine over all blades together: √N times a blade's";
    let mut words = vec![verdict(point), basis.to_owned()];
    if frame == Frame::Fixed {
        let both = "A wave of nodal diameter n at engine order k of the rotating frame is drawn at k + n, where one that travels with the \
                    rotation is seen, and at |k − n|, where one that travels against it is: which of both it is, spectra do not tell.";
        words.push(both.to_owned());
    }
    words
}

fn verdict(point: &Point) -> String {
    let settled = point.settling.as_ref().map_or("no steady state is known", |settling| {
        use rubmap_analysis::result::Verdict::{Aperiodic, NotSettled, Periodic, Subharmonic};
        match settling.verdict {
            Periodic => "repeats every revolution",
            Subharmonic => "repeats every few revolutions",
            Aperiodic => "steady, never repeating",
            NotSettled => "not settled",
        }
    });
    format!("{settled} · amplitudes are single-sided, the mean is left out · rubmap {}", point.version)
}

/// Draws the spectrum of the sensor.
fn whole(
    spectra: &SpeedSpectra,
    found: &SensorSpectrum,
    unit: &str,
    (corner, size): ((f64, f64), (f64, f64)),
) -> Vec<Element> {
    let Some((range, shown)) = whole_lines(spectra, found) else {
        let empty = Diagram::new(corner, size, (0.0, 1.0), (0.0, 1.0));
        return vec![empty.frame(), empty.words(STILL)];
    };
    let diagram = Diagram::upwards_logarithmic(corner, size, (0.0, highest(spectra) + 0.5), range);
    let stems = shown.into_iter().map(|(order, amplitude)| {
        let words = whole_words(order, amplitude, unit);
        stem(&diagram, order, amplitude).set("stroke", INK).set("stroke-width", "1.6").title(&words)
    });
    let title = format!("amplitude, {unit}");
    framed(&diagram, group().set("class", "whole").children(stems), &title, "")
}

/// Message for a sensor that does not move.
pub(super) const STILL: &str = "Nothing to draw: the sensor does not move";

/// Message where no nodal diameter has lines.
pub(super) const ALL_STILL: &str = "Nothing to draw: no nodal diameter moves";

/// Range of amplitudes, and engine orders with amplitudes.
type WholeLines = ((f64, f64), Vec<(f64, f64)>);

/// Lines of the spectrum of the sensor that are drawn, as engine orders with amplitudes, the largest first, and the range of amplitudes;
/// none if it does not move.
pub(super) fn whole_lines(spectra: &SpeedSpectra, found: &SensorSpectrum) -> Option<WholeLines> {
    let lines = spectra.engine_orders.iter().copied().zip(found.amplitude.iter().copied());
    let mut shown: Vec<(f64, f64)> = lines.filter(|(order, _)| *order > 0.0).collect();
    let range = range(shown.iter().map(|line| line.1))?;
    shown.retain(|(_, amplitude)| (range.0..=range.1).contains(amplitude));
    shown.sort_by(|a, b| b.1.total_cmp(&a.1));
    shown.truncate(MOST);
    Some((range, shown))
}

/// Words for a line of the spectrum of the sensor.
pub(super) fn whole_words(order: f64, amplitude: f64, unit: &str) -> String {
    format!("engine order {}: {} {}", marks::order(order), significant(amplitude), unit)
}

/// Highest engine order of the spectra.
pub(super) fn highest(spectra: &SpeedSpectra) -> f64 {
    spectra.engine_orders.last().copied().filter(|order| *order > 0.0).unwrap_or(1.0)
}

/// Range of amplitudes that an axis shows; none if all are zero.
fn range(amplitudes: impl Iterator<Item = f64>) -> Option<(f64, f64)> {
    let loudest = amplitudes.filter(|amplitude| amplitude.is_finite()).fold(0.0, f64::max);
    (loudest > 0.0).then_some((QUIETEST * loudest, 1.6 * loudest))
}

fn stem(diagram: &Diagram, order: f64, amplitude: f64) -> Element {
    let (x, y) = diagram.point(order, amplitude);
    line((x, diagram.bottom()), (x, y))
}

fn framed(diagram: &Diagram, content: Element, y_title: &str, x_title: &str) -> Vec<Element> {
    let (x, y) = (ticks(diagram.x.values, 12.0), decades(diagram.y.values, 9));
    vec![
        diagram.grid(&x, &y),
        content,
        diagram.frame(),
        diagram.x_axis(&x, x_title),
        diagram.y_axis(&y, y_title, 70.0),
    ]
}

/// Line of a nodal diameter.
pub(super) struct Line {
    pub(super) nodal_diameter: usize,
    /// Engine order in the rotating frame.
    pub(super) order: f64,
    /// Multiple of the rotational frequency at which the line is seen; in the fixed frame it depends on the direction of travel.
    pub(super) seen: f64,
    pub(super) forward: bool,
    pub(super) amplitude: f64,
}

/// Lines of all nodal diameters.
pub(super) struct Lines {
    frame: Frame,
    highest: f64,
    pub(super) harmonics: usize,
    lines: Vec<Line>,
}

/// Lines that are drawn.
pub(super) struct Shown<'a> {
    /// Range of the amplitude axis.
    pub(super) range: (f64, f64),
    /// Lines, the largest first.
    pub(super) lines: Vec<&'a Line>,
    /// Whether all lines in the range are drawn.
    pub(super) all: bool,
}

impl Lines {
    pub(super) fn of(spectra: &SpeedSpectra, found: &SensorSpectrum, frame: Frame) -> Self {
        let mut lines = Vec::new();
        for (nodal_diameter, row) in found.nodal_diameters.iter().enumerate() {
            for (&order, &amplitude) in spectra.engine_orders.iter().zip(row) {
                if order <= 0.0 || !amplitude.is_finite() {
                    continue;
                }
                let n = nodal_diameter as f64;
                let here = |seen, forward| Line { nodal_diameter, order, seen, forward, amplitude };
                match frame {
                    Frame::Rotating => lines.push(here(order, true)),
                    // A standing wave is seen at its own order.
                    Frame::Fixed if nodal_diameter == 0 => lines.push(here(order, true)),
                    Frame::Fixed => lines.extend([here(order + n, true), here((order - n).abs(), false)]),
                }
            }
        }
        Self { frame, highest: highest(spectra), harmonics: found.nodal_diameters.len(), lines }
    }

    /// Highest multiple of the rotational frequency at which a line is seen.
    pub(super) fn widest(&self) -> f64 {
        match self.frame {
            Frame::Rotating => self.highest,
            Frame::Fixed => self.highest + self.harmonics.saturating_sub(1) as f64,
        }
    }

    /// Title of the horizontal axis.
    pub(super) fn axis(&self) -> &'static str {
        match self.frame {
            Frame::Rotating => "engine order k in the rotating frame",
            Frame::Fixed => "multiple of the rotational frequency in the fixed frame",
        }
    }

    /// Lines that are drawn; none if nothing moves.
    pub(super) fn shown(&self) -> Option<Shown<'_>> {
        let range = range(self.lines.iter().map(|line| line.amplitude))?;
        let inside = |line: &&Line| (range.0..=range.1).contains(&line.amplitude);
        let mut lines: Vec<&Line> = self.lines.iter().filter(inside).collect();
        lines.sort_by(|a, b| b.amplitude.total_cmp(&a.amplitude));
        let all = lines.len() <= MOST;
        lines.truncate(MOST);
        Some(Shown { range, lines, all })
    }

    fn draw(&self, unit: &str, (corner, size): ((f64, f64), (f64, f64))) -> Vec<Element> {
        let Some(shown) = self.shown() else {
            let empty = Diagram::new(corner, size, (0.0, 1.0), (0.0, 1.0));
            return vec![empty.frame(), empty.words(ALL_STILL)];
        };
        let diagram = Diagram::upwards_logarithmic(corner, size, (0.0, self.widest() + 0.5), shown.range);
        // Smaller lines lie in front of larger ones.
        let drawn = shown.lines.iter().map(|found| self.line(&diagram, found, unit));
        let content = group().set("class", "lines").children(drawn);
        let title = format!("nodal diameters, {unit}");
        let mut all = framed(&diagram, content, &title, self.axis());
        all.push(self.key(&diagram, &shown.lines, shown.all));
        all
    }

    /// Words for a line.
    pub(super) fn words(&self, found: &Line, unit: &str) -> String {
        let direction = match (self.frame, found.nodal_diameter, found.forward) {
            (Frame::Rotating, ..) | (_, 0, _) => "",
            (Frame::Fixed, _, true) => ", if it travels forwards",
            (Frame::Fixed, _, false) => ", if it travels backwards",
        };
        format!(
            "nodal diameter {}, engine order {}: {} {}{direction}",
            found.nodal_diameter,
            marks::order(found.order),
            significant(found.amplitude),
            unit
        )
    }

    fn line(&self, diagram: &Diagram, found: &Line, unit: &str) -> Element {
        let colour = ordinal(found.nodal_diameter, self.harmonics);
        let words = self.words(found, unit);
        let stem =
            stem(diagram, found.seen, found.amplitude).set("stroke", &colour).set("stroke-width", "1.4");
        let stem = if found.forward { stem } else { stem.set("stroke-dasharray", "2 2") };
        let place = diagram.point(found.seen, found.amplitude);
        group().child(stem).child(symbol(place, &colour, found.nodal_diameter, found.forward)).title(&words)
    }

    fn key(&self, diagram: &Diagram, shown: &[&Line], all_shown: bool) -> Element {
        let mut key = Key::new(diagram.right() + 34.0, diagram.top + 8.0).heading("nodal diameter");
        for nodal_diameter in 0..self.harmonics {
            if shown.iter().any(|line| line.nodal_diameter == nodal_diameter) {
                let colour = ordinal(nodal_diameter, self.harmonics);
                let stem =
                    line((0.0, 0.0), (MARK_WIDTH, 0.0)).set("stroke", &colour).set("stroke-width", "1.4");
                let mark = symbol((0.5 * MARK_WIDTH, 0.0), &colour, nodal_diameter, true);
                key = key.row(group().child(stem).child(mark), &nodal_diameter.to_string());
            }
        }
        if self.frame == Frame::Fixed && shown.iter().any(|line| line.nodal_diameter > 0) {
            key = key.heading("direction of travel");
            let middle = (0.5 * MARK_WIDTH, 0.0);
            key = key.row(group().child(symbol(middle, INK, 1, true)), "k + n: forwards");
            key = key.row(group().child(symbol(middle, INK, 1, false)), "|k − n|: backwards");
        }
        if !all_shown {
            key = key.note(&format!("the {} largest lines", label(MOST as f64, 0)));
        }
        key.draw()
    }
}

/// Mark whose shape and colour show the nodal diameter; open for waves that travel backwards.
fn symbol((x, y): (f64, f64), colour: &str, nodal_diameter: usize, filled: bool) -> Element {
    let corners: &[(f64, f64)] = match nodal_diameter % 6 {
        0 => &[],
        1 => &[(-4.0, -4.0), (4.0, -4.0), (4.0, 4.0), (-4.0, 4.0)],
        2 => &[(0.0, -5.0), (4.8, 4.0), (-4.8, 4.0)],
        3 => &[(0.0, -5.5), (5.0, 0.0), (0.0, 5.5), (-5.0, 0.0)],
        4 => &[(-4.8, -4.0), (4.8, -4.0), (0.0, 5.0)],
        _ => &[(-1.6, -5.0), (1.6, -5.0), (1.6, 5.0), (-1.6, 5.0)],
    };
    let shape = if corners.is_empty() {
        Element::new("circle").number("cx", x).number("cy", y).number("r", 4.2)
    } else {
        let place = |(dx, dy): &(f64, f64)| format!("{:.2} {:.2}", x + dx, y + dy);
        let corners: Vec<String> = corners.iter().map(place).collect();
        Element::new("path").set("d", format!("M{}Z", corners.join("L")))
    };
    shape.set("fill", if filled { colour } else { "white" }).set("stroke", colour).set("stroke-width", "1.2")
}
