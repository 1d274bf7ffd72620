//! Spectra of one speed: the paper's Fig 9, and Fig 11 in the fixed frame.

use super::axis::{label, significant};
use super::cells::rpm;
use super::drawing::Drawing;
use super::frame::Frame;
use super::layer::{Curve, Mark, Marks, Stroke};
use super::marks;
use super::sketch::{Axis, Panel, Sketch};
use super::style::{Colour, Dash, Look, Pen, Symbol};
use super::svg::{INK, group};
use rubmap_analysis::result::{Point, SensorSpectrum, SpeedSpectra};
use rubmap_wheel::dynamics::sector::Units;
use serde_json::json;

/// Share of the largest amplitude below which lines are not drawn.
const QUIETEST: f64 = 1e-4;

/// Largest number of lines drawn; more would be a black area.
const MOST: usize = 4000;

/// Number of lines from which only peaks stand on stems, and what lies between them is a curve: stems side by side would cover those behind.
const DENSE: usize = 300;

/// Largest number of nodal diameters that the key names, one for each distinct colour; the others are one entry.
const NAMED: usize = 6;

/// Spectra of the sensor of index `sensor` at one speed: in the rotating frame its amplitude above those of the wheel's nodal diameters, in
/// the fixed frame the latter where they may be seen, a name for each nodal diameter. Amplitudes are logarithmic over four decades.
pub fn spectrum(
    spectra: &SpeedSpectra,
    point: &Point,
    units: &Units,
    sensor: usize,
    frame: Frame,
) -> Drawing<'static> {
    let Some(found) = spectra.sensors.get(sensor) else {
        let title = format!("Spectrum, {} rpm", label(rpm(point.speed_rad_s), 0));
        let words = format!("there is no sensor of index {sensor}");
        return Sketch::new("spectrum", title, Vec::new()).nothing(words).into();
    };
    let unit = found.sensor.unit(units);
    let lines = Lines::of(spectra, found, frame);
    let sketch = Sketch::new("spectrum", title(point, found, frame), words(point, frame));
    let mut sketch = sketch
        .high(if frame == Frame::Rotating { 680 } else { 520 })
        .meta("sensor", found.sensor)
        .meta("units", json!({"x": "engine_order", "y": unit}))
        .meta("speed_index", point.index)
        .meta("speed_rpm", rpm(point.speed_rad_s));
    let Some(shown) = lines.shown() else {
        return sketch.nothing("Nothing to draw: no nodal diameter moves").into();
    };
    let note = format!("the {} largest lines", label(MOST as f64, 0));
    let note = (!shown.all).then_some(note);
    sketch.more.extend(note.clone());
    let top = sketch.top() + 22.0;
    let whole = (frame == Frame::Rotating).then(|| whole_lines(spectra, found)).flatten();
    let height = if frame == Frame::Rotating { 0.5 * (608.0 - top) } else { 646.0 - top };
    let foot = if frame == Frame::Rotating { top + height + 34.0 } else { top };
    let x = || Axis::linear(lines.axis(), (0.0, lines.widest() + 0.5), 12.0);
    let y = Axis::logarithmic(format!("nodal diameters, {unit}"), shown.range, 9);
    let mut panel = Panel::new((92.0, foot), (864.0, height), x(), y);
    lines.fill(&mut panel, &shown, (point, unit));
    note.iter().for_each(|words| panel.note(words));
    let Some((range, largest)) = whole else { return sketch.with(panel).into() };
    let y = Axis::logarithmic(format!("amplitude, {unit}"), range, 9);
    let above = Panel::new((92.0, top), (864.0, height), x(), y);
    let mut above = above.domain(0.56, 1.0);
    let mark = |line: &Bin| {
        let words =
            format!("engine order {}: {} {unit}", marks::order(line.order), significant(line.amplitude));
        Mark { more: hertz(line.order, point), ..Mark::new((line.order, line.amplitude), words) }
    };
    let colour = Colour { paper: INK.to_owned(), ..Colour::curve() };
    let is_dense = largest.len() > DENSE;
    if is_dense {
        let places = largest.iter().map(|line| (line.bin, (line.order, line.amplitude)));
        skirts(&found.sensor.to_string(), places, colour.clone())
            .into_iter()
            .for_each(|curve| above.push(curve));
    }
    let look = Look::filled(Symbol::Circle, (0.0, 4.0), colour);
    let shown = largest.iter().filter(|line| line.is_peak || !is_dense);
    let stems = Marks::new(&found.sensor.to_string(), look, shown.map(mark)).unlisted();
    above.push(Marks { stems: Some(Dash::Solid), ..stems.class("whole") });
    sketch.with(panel.domain(0.0, 0.47)).with(above).into()
}

/// Frequency of a line seen at this multiple of the rotational frequency, in words that follow others.
fn hertz(order: f64, point: &Point) -> String {
    format!(", {} Hz", label(order * rpm(point.speed_rad_s) / 60.0, 1))
}

/// Title: the frame, the sensor and the speed.
fn title(point: &Point, found: &SensorSpectrum, frame: Frame) -> String {
    let where_from = match frame {
        Frame::Rotating => "rotating frame",
        Frame::Fixed => "fixed frame",
    };
    format!("Spectrum in the {where_from}: {}, {} rpm", found.sensor, label(rpm(point.speed_rad_s), 0))
}

/// Paragraphs below the title: the verdict on the speed and the basis of the amplitudes.
fn words(point: &Point, frame: Frame) -> Vec<String> {
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

/// Amplitude at one engine order of a spectrum.
struct Bin {
    /// Index of the engine order.
    bin: usize,
    order: f64,
    amplitude: f64,
    /// Whether neither neighbour is larger.
    is_peak: bool,
}

/// Amplitudes of a spectrum at engine orders above 0 where they are numbers.
fn bins<'a>(orders: &'a [f64], amplitudes: &'a [f64]) -> impl Iterator<Item = Bin> + 'a {
    let at = |bin: usize| amplitudes.get(bin).copied().unwrap_or(0.0);
    let found = orders.iter().zip(amplitudes).enumerate().map(move |(bin, (&order, &amplitude))| {
        let before = if bin > 0 { at(bin - 1) } else { 0.0 };
        Bin { bin, order, amplitude, is_peak: amplitude >= before && amplitude >= at(bin + 1) }
    });
    found.filter(|bin| bin.order > 0.0 && bin.amplitude.is_finite())
}

/// Curve along the lines of a dense spectrum, given with their indices; it is interrupted where lines are left out, and absent where none is
/// beside another.
fn skirts(name: &str, lines: impl Iterator<Item = (usize, (f64, f64))>, colour: Colour) -> Option<Curve> {
    let mut lines: Vec<(usize, (f64, f64))> = lines.collect();
    lines.sort_by_key(|(bin, _)| *bin);
    let stroke = |run: &[(usize, (f64, f64))]| Stroke {
        places: run.iter().map(|(_, place)| Some(*place)).collect(),
        title: String::new(),
    };
    let runs = lines.chunk_by(|a, b| b.0 == a.0 + 1).filter(|run| run.len() > 1);
    let curve =
        Curve::of(name, runs.map(stroke), Pen::new(colour, Dash::Solid, 1.1)).class("skirts").unlisted();
    Some(curve).filter(|curve| !curve.strokes.is_empty())
}

/// Lines of the spectrum of the sensor that are drawn, the largest first, and the range of amplitudes; none if it does not move.
fn whole_lines(spectra: &SpeedSpectra, found: &SensorSpectrum) -> Option<((f64, f64), Vec<Bin>)> {
    let mut shown: Vec<Bin> = bins(&spectra.engine_orders, &found.amplitude).collect();
    let range = range(shown.iter().map(|line| line.amplitude))?;
    shown.retain(|line| (range.0..=range.1).contains(&line.amplitude));
    shown.sort_by(|a, b| b.amplitude.total_cmp(&a.amplitude));
    shown.truncate(MOST);
    Some((range, shown))
}

/// Highest engine order of the spectra.
fn highest(spectra: &SpeedSpectra) -> f64 {
    spectra.engine_orders.last().copied().filter(|order| *order > 0.0).unwrap_or(1.0)
}

/// Range of amplitudes that an axis shows; none if all are zero.
fn range(amplitudes: impl Iterator<Item = f64>) -> Option<(f64, f64)> {
    let loudest = amplitudes.filter(|amplitude| amplitude.is_finite()).fold(0.0, f64::max);
    (loudest > 0.0).then_some((QUIETEST * loudest, 1.6 * loudest))
}

/// Line of a nodal diameter.
struct Line {
    nodal_diameter: usize,
    /// Engine order in the rotating frame.
    order: f64,
    /// Multiple of the rotational frequency at which the line is seen; in the fixed frame it depends on the direction of travel.
    seen: f64,
    forward: bool,
    amplitude: f64,
    /// Index of the engine order, and whether neither neighbour is larger.
    bin: usize,
    is_peak: bool,
}

/// Lines of all nodal diameters.
struct Lines {
    frame: Frame,
    highest: f64,
    harmonics: usize,
    lines: Vec<Line>,
}

/// Lines that are drawn.
struct Shown<'a> {
    /// Range of the amplitude axis.
    range: (f64, f64),
    /// Lines, the largest first.
    lines: Vec<&'a Line>,
    /// Whether all lines in the range are drawn.
    all: bool,
}

impl Shown<'_> {
    /// Nodal diameters with the largest lines, which have a name each, and the others that move; both in their order.
    fn named(&self) -> (Vec<usize>, Vec<usize>) {
        let mut all: Vec<usize> = Vec::new();
        for line in &self.lines {
            if !all.contains(&line.nodal_diameter) {
                all.push(line.nodal_diameter);
            }
        }
        let mut others = all.split_off(all.len().min(NAMED));
        all.sort_unstable();
        others.sort_unstable();
        (all, others)
    }
}

impl Lines {
    fn of(spectra: &SpeedSpectra, found: &SensorSpectrum, frame: Frame) -> Self {
        let mut lines = Vec::new();
        for (nodal_diameter, row) in found.nodal_diameters.iter().enumerate() {
            for Bin { bin, order, amplitude, is_peak } in bins(&spectra.engine_orders, row) {
                let n = nodal_diameter as f64;
                let here =
                    |seen, forward| Line { nodal_diameter, order, seen, forward, amplitude, bin, is_peak };
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
    fn widest(&self) -> f64 {
        match self.frame {
            Frame::Rotating => self.highest,
            Frame::Fixed => self.highest + self.harmonics.saturating_sub(1) as f64,
        }
    }

    /// Title of the horizontal axis.
    fn axis(&self) -> &'static str {
        match self.frame {
            Frame::Rotating => "engine order k in the rotating frame",
            Frame::Fixed => "multiple of the rotational frequency in the fixed frame",
        }
    }

    /// Lines that are drawn; none if nothing moves.
    fn shown(&self) -> Option<Shown<'_>> {
        let range = range(self.lines.iter().map(|line| line.amplitude))?;
        let inside = |line: &&Line| (range.0..=range.1).contains(&line.amplitude);
        let mut lines: Vec<&Line> = self.lines.iter().filter(inside).collect();
        lines.sort_by(|a, b| b.amplitude.total_cmp(&a.amplitude));
        let all = lines.len() <= MOST;
        lines.truncate(MOST);
        Some(Shown { range, lines, all })
    }

    /// Words for a line.
    fn words(&self, found: &Line, unit: &str) -> String {
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

    /// Adds the lines of every nodal diameter, one layer for each direction of travel, and their key.
    fn fill(&self, panel: &mut Panel, shown: &Shown, (point, unit): (&Point, &str)) {
        let look = |i: usize, is_filled: bool, colour: Colour| {
            let paper = colour.paper.clone();
            let (symbol, size) = (Symbol::nth(i), (4.2, 8.0));
            match is_filled {
                true => Look::filled(symbol, size, colour).with(&paper, &paper, 1.2),
                false => Look::open(symbol, size, colour).with("white", &paper, 1.2),
            }
        };
        panel.heading("nodal diameter");
        let is_dense = shown.lines.len() > DENSE;
        let (named, others) = shown.named();
        let of = |i: usize| move |line: &&&Line| line.nodal_diameter == i;
        for &i in others.iter().chain(&named) {
            let (name, colour, words) = match named.iter().position(|&other| other == i) {
                Some(_) if self.harmonics <= NAMED => {
                    (format!("nodal diameter {i}"), Colour::ordinal(i, self.harmonics), i.to_string())
                }
                Some(place) => {
                    (format!("nodal diameter {i}"), Colour::ordinal(place, named.len()), i.to_string())
                }
                None => ("other nodal diameters".to_owned(), Colour::neutral("#999999"), "others".to_owned()),
            };
            for forward in [true, false] {
                let here = || shown.lines.iter().filter(of(i)).filter(|line| line.forward == forward);
                if is_dense {
                    let places = here().map(|line| (line.bin, (line.seen, line.amplitude)));
                    skirts(&name, places, colour.clone()).into_iter().for_each(|curve| panel.push(curve));
                }
                let mark = |line: &&Line| Mark {
                    more: hertz(line.seen, point),
                    ..Mark::new((line.seen, line.amplitude), self.words(line, unit))
                };
                let peaks = here().filter(|line| line.is_peak || !is_dense);
                let marks = Marks::new(&name, look(i, forward, colour.clone()), peaks.map(mark));
                let is_last_other = named.contains(&i) || others.last() == Some(&i);
                if forward && is_last_other && !marks.marks.is_empty() {
                    let stem = Pen::new(colour.clone(), Dash::Solid, 1.4).sample();
                    panel.sample(group().child(stem).child(marks.look.sample()), &words);
                }
                let dash = if forward { Dash::Solid } else { Dash::Dotted };
                panel.push(Marks { stems: Some(dash), ..marks });
            }
        }
        if self.frame == Frame::Fixed && shown.lines.iter().any(|line| line.nodal_diameter > 0) {
            panel.heading("direction of travel");
            panel.sample(look(1, true, Colour::of(INK)).sample(), "k + n: forwards");
            panel.sample(look(1, false, Colour::of(INK)).sample(), "|k − n|: backwards");
        }
    }
}
