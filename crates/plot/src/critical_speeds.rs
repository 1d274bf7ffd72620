//! Critical speeds beside the linear prediction.

use super::axis::{label, significant, ticks};
use super::cells::rpm;
use super::diagram::Diagram;
use super::key::{Key, MARK_WIDTH};
use super::labels::Labels;
use super::svg::{Element, document, group, line, rectangle, text, upright};
use super::{heading, marks, validity};
use rubmap_analysis::result::{CriticalSpeed, CriticalSpeeds, Crossing, Verdict};

const WIDTH: f64 = 1180.0;
const LEFT: f64 = 150.0;
const PLOT_WIDTH: f64 = 740.0;
const PEAKS_HEIGHT: f64 = 330.0;
const ROW_HEIGHT: f64 = 34.0;

/// Message where there are no peaks.
pub(super) const NONE: &str = "no critical speed stands out of the response";

const PEAK: &str = "#1f4e79";
const NEAREST: &str = "#d62728";

/// Draws the peaks of the response over speed with their errors, and below them the crossings of the linear prediction, a row for each
/// superharmonic; each peak is tied to the crossing nearest to it.
pub fn critical_speeds(critical: &CriticalSpeeds) -> String {
    let title = title(critical);
    let (heading, bottom) = heading::heading(LEFT, &title, &words(critical));
    let view = View::new(critical, bottom + 26.0);
    let mut content = vec![heading];
    content.extend(view.draw());
    document(&title, WIDTH, view.rows.bottom() + 66.0, content)
}

/// Title: the sensor of the critical speeds.
pub(super) fn title(critical: &CriticalSpeeds) -> String {
    format!("Critical speeds: {}", critical.sensor)
}

/// Paragraphs below the title: peaks, missing speeds, origin, and a warning about K(Ω) if there is one.
pub(super) fn words(critical: &CriticalSpeeds) -> Vec<String> {
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

/// Row of crossings of one kind, with its name.
pub(super) struct Row {
    pub(super) name: String,
    pub(super) kind: Kind,
    pub(super) marks: Vec<Mark>,
}

/// Kind of crossings in a row.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    /// Crossings of the linear criterion.
    Linear,
    /// Crossings that the lobes drive.
    Driven,
    /// Crossings with waves of an elastic casing.
    Casing,
}

impl Kind {
    /// Words for the marks of a row.
    pub(super) fn words(self) -> &'static str {
        match self {
            Self::Linear => "linear criterion, (i, j, n)",
            Self::Driven => "driven by the lobes, (i, j)",
            Self::Casing => "wave of the casing, (n, i)",
        }
    }

    fn mark(self, place: (f64, f64)) -> Element {
        match self {
            Self::Linear => marks::ring(place, "black"),
            Self::Driven => marks::diamond(place, "#ff9d5c", "black"),
            Self::Casing => square(place),
        }
    }
}

pub(super) struct Mark {
    pub(super) rpm: f64,
    pub(super) words: String,
    pub(super) title: String,
}

struct View<'a> {
    critical: &'a CriticalSpeeds,
    peaks: Diagram,
    rows: Diagram,
    lines: Vec<Row>,
}

impl<'a> View<'a> {
    fn new(critical: &'a CriticalSpeeds, top: f64) -> Self {
        let lines = rows(critical);
        let peaks = critical.critical_speeds.iter();
        let ends = peaks.clone().flat_map(|peak| {
            [peak.speed_rad_s - peak.speed_error_rad_s, peak.speed_rad_s + peak.speed_error_rad_s].map(rpm)
        });
        let crossings = lines.iter().flat_map(|row| row.marks.iter().map(|mark| mark.rpm));
        let (slow, fast) = ends
            .chain(crossings)
            .filter(|speed| speed.is_finite())
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(slow, fast), speed| {
                (slow.min(speed), fast.max(speed))
            });
        let speeds = match slow <= fast {
            true => {
                let room = (0.03 * (fast - slow)).max(0.002 * fast).max(1.0);
                ((slow - room).max(0.0), fast + room)
            }
            false => (0.0, 1.0),
        };
        let tops = peaks.map(|peak| peak.rms * (1.0 + peak.amplitude_error.unwrap_or(0.0)));
        let highest = tops.filter(|top| top.is_finite()).fold(0.0, f64::max);
        // Labels stand above the peaks; one with a utilisation is longer.
        let used = critical.critical_speeds.iter().any(|peak| peak.utilisation.is_some());
        let room = if used { 2.2 } else { 1.7 };
        let highest = if highest > 0.0 { room * highest } else { 1.0 };
        let peaks = Diagram::new((LEFT, top), (PLOT_WIDTH, PEAKS_HEIGHT), speeds, (0.0, highest));
        let count = lines.len().max(1) as f64;
        let below = (LEFT, peaks.bottom() + 14.0);
        let rows = Diagram::new(below, (PLOT_WIDTH, ROW_HEIGHT * count), speeds, (0.0, count));
        Self { critical, peaks, rows, lines }
    }

    fn draw(&self) -> Vec<Element> {
        let (peaks, rows) = (&self.peaks, &self.rows);
        let (x, y) = (ticks(peaks.x.values, 9.0), ticks(peaks.y.values, 6.0));
        let length = self.critical.sensor.unit(&self.critical.units);
        let empty = self.critical.critical_speeds.is_empty();
        let mut content = vec![peaks.grid(&x, &y), rows.grid(&x, &[])];
        content.extend(self.critical.critical_speeds.iter().filter_map(|peak| self.tie(peak)));
        content.push(self.crossings());
        content.push(self.peaks());
        content.extend(empty.then(|| peaks.words(NONE)));
        content.extend([peaks.frame(), rows.frame()]);
        content.push(peaks.y_axis(&y, &format!("level at the peak, {length} rms"), 72.0));
        content.push(rows.x_axis(&x, "rotational speed Ω, rpm"));
        content.push(self.key());
        content
    }

    /// Draws the tie of a peak: down to the axis, and from there to the nearest crossing.
    fn tie(&self, peak: &CriticalSpeed) -> Option<Element> {
        let nearest = peak.nearest_crossing.as_ref()?;
        let row = self.lines.iter().position(|row| row.name == linear_row(nearest.superharmonic))?;
        let from = self.peaks.inside(rpm(peak.speed_rad_s), peak.rms)?;
        let x = self.rows.x.place(rpm(nearest.speed_rad_s));
        let foot = (from.0, self.peaks.bottom());
        let tie = group().set("class", "nearest").set("stroke", NEAREST).set("stroke-width", "1.1");
        let down = line(from, foot).set("stroke-opacity", "0.35");
        let tie = tie.child(down).child(line(foot, (x, self.height(row))));
        Some(tie.title(&nearest_words(peak)?))
    }

    /// Height of the middle of a row.
    fn height(&self, row: usize) -> f64 {
        self.rows.top + ROW_HEIGHT * (row as f64 + 0.5)
    }

    fn crossings(&self) -> Element {
        let mut labels = Labels::inside(&self.rows);
        for (row, line) in self.lines.iter().enumerate() {
            for mark in &line.marks {
                labels.keep_off((self.rows.x.place(mark.rpm), self.height(row)), 4.0);
            }
        }
        let mut drawn = group();
        for (row, line) in self.lines.iter().enumerate() {
            let y = self.height(row);
            drawn = drawn.child(text(LEFT - 10.0, y + 4.5, "end", &line.name));
            for mark in &line.marks {
                let place = (self.rows.x.place(mark.rpm), y);
                let label =
                    labels.level_with(place, 5.0, &mark.words, 10.5).map(|label| label.rimmed("white"));
                drawn = drawn.child(line.kind.mark(place).title(&mark.title)).children(label);
            }
        }
        drawn
    }

    fn peaks(&self) -> Element {
        let inside =
            |peak: &'a CriticalSpeed| Some((self.peaks.inside(rpm(peak.speed_rad_s), peak.rms)?, peak));
        let mut shown: Vec<_> = self.critical.critical_speeds.iter().filter_map(inside).collect();
        shown.sort_by(|a, b| a.0.0.total_cmp(&b.0.0));
        let places: Vec<f64> = shown.iter().map(|(place, _)| place.0).collect();
        let apart = marks::spread(&places, self.peaks.right() - 6.0);
        let drawn = shown.into_iter().zip(apart).map(|((place, peak), x)| {
            let words = peak_words(peak);
            let lead = line((place.0, place.1 - 6.0), (x, place.1 - 14.0)).set("stroke", "#888888");
            let name = upright(x + 4.0, place.1 - 18.0, "start", &words).set("font-size", "11");
            let mark = peak_mark(place, peak.resolved).title(&words);
            let ring = validity::ring(place, peak.validity, 7.5);
            group().child(lead).child(self.bars(peak)).child(mark).children(ring).child(name.rimmed("white"))
        });
        group().children(drawn)
    }

    /// Draws the error bars of a peak, in speed and in amplitude.
    fn bars(&self, peak: &CriticalSpeed) -> Element {
        let speed =
            |off: f64| rpm(peak.speed_rad_s + off).clamp(self.peaks.x.values.0, self.peaks.x.values.1);
        let level = |share: f64| (peak.rms * (1.0 + share)).max(0.0);
        let at = |x: f64, y: f64| self.peaks.point(x, y);
        let middle = rpm(peak.speed_rad_s);
        let (slow, fast) =
            (at(speed(-peak.speed_error_rad_s), peak.rms), at(speed(peak.speed_error_rad_s), peak.rms));
        let bars = group().set("class", "error").set("stroke", PEAK).set("stroke-width", "1.3");
        let bars = bars.child(line(slow, fast)).child(cap(slow, true)).child(cap(fast, true));
        let Some(error) = peak.amplitude_error.filter(|error| error.is_finite()) else { return bars };
        let (low, high) = (at(middle, level(-error)), at(middle, level(error)));
        bars.child(line(low, high)).child(cap(low, false)).child(cap(high, false))
    }

    fn key(&self) -> Element {
        let middle = (0.5 * MARK_WIDTH, 0.0);
        let mut key = Key::new(self.peaks.right() + 24.0, self.peaks.top + 8.0);
        let peaks = &self.critical.critical_speeds;
        if peaks.iter().any(|peak| peak.resolved) {
            key = key.row(peak_mark(middle, true), "critical speed");
        }
        if peaks.iter().any(|peak| !peak.resolved) {
            key = key.row(peak_mark(middle, false), "peak not resolved");
        }
        let bar = |from, to, upright| {
            let bar = group().set("stroke", PEAK).set("stroke-width", "1.3").child(line(from, to));
            group().child(bar.child(cap(from, upright)).child(cap(to, upright)))
        };
        if !peaks.is_empty() {
            let bar = bar((4.0, 0.0), (MARK_WIDTH - 4.0, 0.0), true);
            key = key.row(bar, "between neighbouring speeds");
        }
        if peaks.iter().any(|peak| peak.amplitude_error.is_some()) {
            key = key.row(bar((middle.0, -8.0), (middle.0, 8.0), false), "estimated error of the level");
        }
        if peaks.iter().any(|peak| peak.settling == Verdict::NotSettled) {
            key = key.row(text(middle.0, 4.5, "middle", "*"), "not settled");
        }
        if peaks.iter().any(|peak| peak.utilisation.is_some()) {
            key = key.row(text(middle.0, 4.5, "middle", "U"), "utilisation");
        }
        for verdict in validity::MARKED {
            if peaks.iter().any(|peak| peak.validity == Some(verdict)) {
                let ring = validity::ring(middle, Some(verdict), 7.5);
                key = key.row(group().children(ring), validity::words(verdict));
            }
        }
        if peaks.iter().any(|peak| self.tie(peak).is_some()) {
            let tie = line((2.0, -6.0), (MARK_WIDTH - 2.0, 6.0)).set("stroke", NEAREST);
            key = key.row(tie.set("stroke-width", "1.2"), "to the nearest crossing");
        }
        for kind in [Kind::Linear, Kind::Driven, Kind::Casing] {
            if self.lines.iter().any(|row| row.kind == kind) {
                key = key.row(kind.mark(middle), kind.words());
            }
        }
        key.draw()
    }
}

/// Words for a peak.
pub(super) fn peak_words(peak: &CriticalSpeed) -> String {
    let order = marks::engine_order(peak);
    let star = if peak.settling == Verdict::NotSettled { " *" } else { "" };
    let used = marks::utilisation(peak);
    format!("{} rpm · EO {order}{used}{star}", label(rpm(peak.speed_rad_s), 0))
}

/// Words for the crossing nearest to a peak.
pub(super) fn nearest_words(peak: &CriticalSpeed) -> Option<String> {
    let nearest = peak.nearest_crossing.as_ref()?;
    let distance = peak
        .distance_rad_s
        .map_or_else(String::new, |distance| format!(", {} rpm away", significant(rpm(distance))));
    Some(format!("nearest linear crossing: {}{distance}", marks::triple(nearest)))
}

/// Name of the row of a superharmonic.
pub(super) fn linear_row(superharmonic: u32) -> String {
    format!("linear, n = {superharmonic}")
}

/// Rows of crossings: one for each superharmonic of the linear criterion, then the driven ones and those of an elastic casing if there are
/// any.
pub(super) fn rows(critical: &CriticalSpeeds) -> Vec<Row> {
    let mut orders: Vec<u32> =
        critical.linear_crossings.iter().map(|crossing| crossing.superharmonic).collect();
    orders.sort_unstable();
    orders.dedup();
    let linear = orders.into_iter().map(|order| {
        let here = critical.linear_crossings.iter().filter(|crossing| crossing.superharmonic == order);
        let mark = |crossing: &Crossing| Mark {
            rpm: rpm(crossing.speed_rad_s),
            words: marks::triple(crossing),
            title: marks::linear_words(crossing),
        };
        Row { name: linear_row(order), kind: Kind::Linear, marks: here.map(mark).collect() }
    });
    let driven = critical.driven_crossings.iter().map(|crossing| Mark {
        rpm: rpm(crossing.speed_rad_s),
        words: marks::pair(crossing),
        title: marks::driven_words(crossing),
    });
    let casing = critical.casing_coincidences.iter().map(|found| {
        let words = format!("({}, {})", found.casing_nodal_diameter, found.nodal_diameter);
        let title = format!("wave of the casing, (n, i) = {words}: {} rpm", label(rpm(found.speed_rad_s), 0));
        Mark { rpm: rpm(found.speed_rad_s), words, title }
    });
    let others = [
        Row { name: "driven".to_owned(), kind: Kind::Driven, marks: driven.collect() },
        Row { name: "elastic casing".to_owned(), kind: Kind::Casing, marks: casing.collect() },
    ];
    linear.chain(others.into_iter().filter(|row| !row.marks.is_empty())).collect()
}

fn peak_mark((x, y): (f64, f64), resolved: bool) -> Element {
    let mark = Element::new("circle").number("cx", x).number("cy", y).number("r", 4.6).set("stroke", PEAK);
    mark.set("class", "peak").set("stroke-width", "1.6").set("fill", if resolved { PEAK } else { "white" })
}

fn square((x, y): (f64, f64)) -> Element {
    rectangle(x - 4.0, y - 4.0, 8.0, 8.0).set("fill", "#9ec9a5").set("stroke", "black")
}

/// End of an error bar.
fn cap((x, y): (f64, f64), upright: bool) -> Element {
    if upright { line((x, y - 3.5), (x, y + 3.5)) } else { line((x - 3.5, y), (x + 3.5, y)) }
}
