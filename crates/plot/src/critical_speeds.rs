//! Critical speeds beside the linear prediction.

use super::axis::{label, significant};
use super::cells::rpm;
use super::drawing::Drawing;
use super::key::MARK_WIDTH;
use super::layer::{Bars, Curve, Mark, Marks, Reach, Stroke};
use super::marks::DRIVEN;
use super::sketch::{Axis, Panel, Sketch};
use super::style::{Colour, Dash, Look, Pen, Symbol};
use super::svg::{Element, group, line, text, upright};
use super::{heading, marks, validity};
use rubmap_analysis::result::{CriticalSpeed, CriticalSpeeds, Crossing, ValidityVerdict, Verdict};
use serde_json::json;

const ROW_HEIGHT: f64 = 34.0;

/// Peaks of the response over speed with their errors, and below them the crossings of the linear prediction, a row for each superharmonic;
/// each peak is tied to the crossing nearest to it.
pub fn critical_speeds(critical: &CriticalSpeeds) -> Drawing<'_> {
    let rows = rows(critical);
    let title = format!("Critical speeds: {}", critical.sensor);
    let sketch = Sketch::new("critical_speeds", title, words(critical)).high(420 + 34 * rows.len());
    let unit = critical.sensor.unit(&critical.units);
    let speeds = range(critical, &rows);
    let left = 150.0;
    let y = Axis::linear(format!("level at the peak, {unit} rms"), (0.0, highest(critical)), 6.0).with_zero();
    let x = || Axis::speeds(speeds, 9.0).free();
    let mut peaks = Panel::new((left, sketch.top() + 26.0), (740.0, 330.0), x(), y).domain(0.42, 1.0);
    let count = rows.len().max(1) as f64;
    let names = rows.iter().enumerate().map(|(row, of)| (-(row as f64), of.name.clone())).collect();
    let y = Axis::names("", (0.4 - count, 0.6), names);
    let below = (left, peaks.diagram.bottom() + 8.0);
    let mut below = Panel::new(below, (740.0, ROW_HEIGHT * count), x(), y).domain(0.0, 0.36);
    add_peaks(critical, &mut peaks);
    ties(critical, &rows, (&mut peaks, &mut below));
    for kind in [Kind::Linear, Kind::Driven, Kind::Casing] {
        let here = rows.iter().enumerate().filter(|(_, row)| row.kind == kind);
        let mark = |(row, crossed): (usize, &Crossed)| {
            Mark::new((crossed.rpm, -(row as f64)), crossed.title.clone()).label(crossed.words.clone())
        };
        let all = here.flat_map(|(row, of)| of.marks.iter().map(move |crossed| (row, crossed)));
        let marks = Marks::new(kind.words(), kind.look(), all.map(mark));
        if !marks.marks.is_empty() {
            peaks.sample(marks.look.sample(), kind.words());
        }
        below.push(marks);
    }
    if critical.critical_speeds.is_empty() {
        peaks.push(peaks.diagram.words(NONE));
    }
    let sketch =
        Sketch { left, note: critical.critical_speeds.is_empty().then(|| NONE.to_owned()), ..sketch };
    sketch
        .meta("sensor", critical.sensor)
        .meta("units", json!({"x": "rpm", "y": unit}))
        .meta("speed_indices", critical.critical_speeds.iter().map(|peak| peak.index).collect::<Vec<u32>>())
        .with(peaks)
        .with(below)
        .into()
}

/// Message where there are no peaks.
const NONE: &str = "no critical speed stands out of the response";

/// Paragraphs below the title: peaks, missing speeds, origin, and a warning about K(Ω) if there is one.
fn words(critical: &CriticalSpeeds) -> Vec<String> {
    let found = critical.critical_speeds.len();
    let mut words = vec![match found {
        1 => "1 peak".to_owned(),
        _ => format!("{found} peaks"),
    }];
    if !critical.missing.is_empty() {
        words.push(format!("{} speeds without a result", critical.missing.len()));
    }
    words.push(heading::origin(&critical.settings.model, &critical.version));
    let warning = critical.reduction.stiffening.verdict.warning().map(str::to_owned);
    [words.join(" · ")].into_iter().chain(warning).collect()
}

/// Speeds of all peaks with their errors and of all crossings, with some room.
fn range(critical: &CriticalSpeeds, rows: &[Row]) -> (f64, f64) {
    let ends = critical.critical_speeds.iter().flat_map(|peak| {
        [peak.speed_rad_s - peak.speed_error_rad_s, peak.speed_rad_s + peak.speed_error_rad_s].map(rpm)
    });
    let crossings = rows.iter().flat_map(|row| row.marks.iter().map(|mark| mark.rpm));
    let all = ends.chain(crossings).filter(|speed| speed.is_finite());
    let (slow, fast) = all
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(slow, fast), speed| (slow.min(speed), fast.max(speed)));
    if slow > fast {
        return (0.0, 1.0);
    }
    let room = (0.03 * (fast - slow)).max(0.002 * fast).max(1.0);
    ((slow - room).max(0.0), fast + room)
}

/// Height of the highest peak, with room for the labels above; one with a utilisation is longer.
fn highest(critical: &CriticalSpeeds) -> f64 {
    let peaks = &critical.critical_speeds;
    let tops = peaks.iter().map(|peak| peak.rms * (1.0 + peak.amplitude_error.unwrap_or(0.0)));
    let highest = tops.filter(|top| top.is_finite()).fold(0.0, f64::max);
    let room = if peaks.iter().any(|peak| peak.utilisation.is_some()) { 2.2 } else { 1.7 };
    if highest > 0.0 { room * highest } else { 1.0 }
}

/// Adds the peaks with their error bars and labels, rings where linear theory is doubtful or left, and their key.
fn add_peaks(critical: &CriticalSpeeds, panel: &mut Panel) {
    let all = &critical.critical_speeds;
    for (is_resolved, name) in [(true, "critical speed"), (false, "peak not resolved")] {
        let of: Vec<&CriticalSpeed> = all.iter().filter(|peak| peak.resolved == is_resolved).collect();
        let mark = |peak: &&CriticalSpeed| {
            let nearest = nearest_words(peak).map(|words| format!("; {words}")).unwrap_or_default();
            let more = format!("{}{nearest}", marks::known_to(peak));
            let mark = Mark::new((rpm(peak.speed_rad_s), peak.rms), peak_words(peak));
            Mark { more, index: Some(peak.index as usize), ..mark }
        };
        let colour = Colour::curve();
        let look = match is_resolved {
            true => Look::filled(Symbol::Circle, (4.6, 10.0), colour).with("#1f4e79", "#1f4e79", 1.6),
            false => Look::open(Symbol::Circle, (4.6, 10.0), colour).with("white", "#1f4e79", 1.6),
        };
        let bars = |lengths| Some(Bars { lengths, colour: Colour::curve(), class: "error" });
        let across = of.iter().map(|peak| Reach::even(rpm(peak.speed_error_rad_s))).collect();
        let error = |peak: &&CriticalSpeed| {
            peak.amplitude_error.map_or(Reach::even(f64::NAN), |error| Reach::of_factor(peak.rms, error))
        };
        let upwards = of.iter().map(error).collect();
        let marks = Marks::new(name, look, of.iter().map(mark)).class("peak");
        panel.marks(name, Marks { across: bars(across), bars: bars(upwards), ..marks });
    }
    let labels = labels(all, panel);
    panel.push(labels);
    key(all, panel);
    for verdict in validity::MARKED {
        let of = all.iter().filter(|peak| peak.validity == Some(verdict));
        let words = validity::words(verdict);
        let ring = ring(verdict);
        let marks = Marks::new(
            words,
            ring,
            of.map(|peak| Mark::new((rpm(peak.speed_rad_s), peak.rms), words.to_owned())),
        );
        if !marks.marks.is_empty() {
            panel.sample(marks.look.sample().set("class", "validity"), words);
        }
        panel.push(marks.class("validity"));
    }
}

/// Ring about a peak at which linear theory has this verdict.
fn ring(verdict: ValidityVerdict) -> Look {
    let paper = validity::colour(verdict).unwrap_or_default();
    let ring =
        Look::open(Symbol::Circle, (7.5, 16.0), Colour { paper: paper.to_owned(), ..Colour::warning() });
    if verdict == ValidityVerdict::Beyond { ring } else { ring.dashed() }
}

/// Upright labels above the peaks, moved apart.
fn labels(all: &[CriticalSpeed], panel: &Panel) -> Element {
    let inside = |peak| {
        let peak: &CriticalSpeed = peak;
        Some((panel.diagram.inside(rpm(peak.speed_rad_s), peak.rms)?, peak))
    };
    let mut shown: Vec<_> = all.iter().filter_map(inside).collect();
    shown.sort_by(|a, b| a.0.0.total_cmp(&b.0.0));
    let places: Vec<f64> = shown.iter().map(|(place, _)| place.0).collect();
    let apart = marks::spread(&places, panel.diagram.right() - 6.0);
    group().children(shown.into_iter().zip(apart).map(|((place, peak), x)| {
        let lead = line((place.0, place.1 - 6.0), (x, place.1 - 14.0)).set("stroke", "#888888");
        let name = upright(x + 4.0, place.1 - 18.0, "start", &peak_words(peak)).set("font-size", "11");
        group().child(lead).child(name.rimmed("white"))
    }))
}

/// Adds what the key says of bars and letters.
fn key(all: &[CriticalSpeed], panel: &mut Panel) {
    let middle = 0.5 * MARK_WIDTH;
    let bar = |from: (f64, f64), to: (f64, f64), cap: (f64, f64)| {
        let ends = [from, to].map(|(x, y)| line((x - cap.0, y - cap.1), (x + cap.0, y + cap.1)));
        group().set("stroke", "#1f4e79").set("stroke-width", "1.3").child(line(from, to)).children(ends)
    };
    if !all.is_empty() {
        panel.sample(bar((4.0, 0.0), (MARK_WIDTH - 4.0, 0.0), (0.0, 3.5)), "between neighbouring speeds");
    }
    if all.iter().any(|peak| peak.amplitude_error.is_some()) {
        panel.sample(bar((middle, -8.0), (middle, 8.0), (3.5, 0.0)), "estimated error of the level");
    }
    if all.iter().any(|peak| peak.settling == Verdict::NotSettled) {
        panel.sample(text(middle, 4.5, "middle", "*"), "not settled");
    }
    if all.iter().any(|peak| peak.utilisation.is_some()) {
        panel.sample(text(middle, 4.5, "middle", "U"), "utilisation");
    }
}

/// Adds the ties: from each peak down to its axis, and from there to the nearest crossing.
fn ties(critical: &CriticalSpeeds, rows: &[Row], (peaks, below): (&mut Panel, &mut Panel)) {
    let name = "to the nearest crossing";
    let (mut down, mut across, mut told) = (Vec::new(), Vec::new(), Vec::new());
    for peak in &critical.critical_speeds {
        let Some((nearest, words)) = peak.nearest_crossing.as_ref().zip(nearest_words(peak)) else {
            continue;
        };
        let row = rows.iter().position(|row| row.name == linear_row(nearest.superharmonic));
        let (Some(row), speed) = (row, rpm(peak.speed_rad_s)) else { continue };
        let stroke = |ends: [(f64, f64); 2]| Stroke { places: ends.map(Some).to_vec(), title: words.clone() };
        down.push(stroke([(speed, peak.rms), (speed, 0.0)]));
        across.push(stroke([(speed, 0.6), (rpm(nearest.speed_rad_s), -(row as f64))]));
        told.extend([words.clone(), words.clone()]);
    }
    if down.is_empty() {
        return;
    }
    let pen = Pen::new(Colour::neutral("#d62728"), Dash::Solid, 1.1);
    peaks.sample(pen.sample(), name);
    below.push(Curve::of(name, across, pen.clone()).each(told).class("nearest"));
    peaks.push(Curve { opacity: 0.35, ..Curve::of(name, down, pen).unlisted() });
}

/// Row of crossings of one kind, with its name.
struct Row {
    name: String,
    kind: Kind,
    marks: Vec<Crossed>,
}

/// Kind of crossings in a row.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    /// Crossings of the linear criterion.
    Linear,
    /// Crossings that the lobes drive.
    Driven,
    /// Crossings with waves of an elastic casing.
    Casing,
}

impl Kind {
    /// Words for the marks of a row.
    fn words(self) -> &'static str {
        match self {
            Self::Linear => "linear criterion, (i, j, n)",
            Self::Driven => "driven by the lobes, (i, j)",
            Self::Casing => "wave of the casing, (n, i)",
        }
    }

    fn look(self) -> Look {
        match self {
            Self::Linear => Look::open(Symbol::Circle, (4.5, 10.0), Colour::neutral("black")),
            Self::Driven => {
                Look::filled(Symbol::Diamond, (4.4, 10.0), Colour::of(DRIVEN)).with(DRIVEN, "black", 1.0)
            }
            Self::Casing => {
                let colour = Colour { paper: "#9ec9a5".to_owned(), screen: "#009e73".to_owned() };
                Look::filled(Symbol::Square, (4.5, 9.0), colour).with("#9ec9a5", "black", 1.0)
            }
        }
    }
}

struct Crossed {
    rpm: f64,
    words: String,
    title: String,
}

/// Words for a peak.
fn peak_words(peak: &CriticalSpeed) -> String {
    let order = marks::engine_order(peak);
    let star = if peak.settling == Verdict::NotSettled { " *" } else { "" };
    let used = marks::utilisation(peak);
    format!("{} rpm · EO {order}{used}{star}", label(rpm(peak.speed_rad_s), 0))
}

/// Words for the crossing nearest to a peak.
fn nearest_words(peak: &CriticalSpeed) -> Option<String> {
    let nearest = peak.nearest_crossing.as_ref()?;
    let distance = peak
        .distance_rad_s
        .map_or_else(String::new, |distance| format!(", {} rpm away", significant(rpm(distance))));
    Some(format!("nearest linear crossing: {}{distance}", marks::triple(nearest)))
}

/// Name of the row of a superharmonic.
fn linear_row(superharmonic: u32) -> String {
    format!("linear, n = {superharmonic}")
}

/// Rows of crossings: one for each superharmonic of the linear criterion, then the driven ones and those of an elastic casing if there are
/// any.
fn rows(critical: &CriticalSpeeds) -> Vec<Row> {
    let mut orders: Vec<u32> =
        critical.linear_crossings.iter().map(|crossing| crossing.superharmonic).collect();
    orders.sort_unstable();
    orders.dedup();
    let linear = orders.into_iter().map(|order| {
        let here = critical.linear_crossings.iter().filter(|crossing| crossing.superharmonic == order);
        let mark = |crossing: &Crossing| Crossed {
            rpm: rpm(crossing.speed_rad_s),
            words: marks::triple(crossing),
            title: marks::linear_words(crossing),
        };
        Row { name: linear_row(order), kind: Kind::Linear, marks: here.map(mark).collect() }
    });
    let driven = critical.driven_crossings.iter().map(|crossing| Crossed {
        rpm: rpm(crossing.speed_rad_s),
        words: marks::pair(crossing),
        title: marks::driven_words(crossing),
    });
    let casing = critical.casing_coincidences.iter().map(|found| {
        let words = format!("({}, {})", found.casing_nodal_diameter, found.nodal_diameter);
        let title = format!("wave of the casing, (n, i) = {words}: {} rpm", label(rpm(found.speed_rad_s), 0));
        Crossed { rpm: rpm(found.speed_rad_s), words, title }
    });
    let others = [
        Row { name: "driven".to_owned(), kind: Kind::Driven, marks: driven.collect() },
        Row { name: "elastic casing".to_owned(), kind: Kind::Casing, marks: casing.collect() },
    ];
    linear.chain(others.into_iter().filter(|row| !row.marks.is_empty())).collect()
}
