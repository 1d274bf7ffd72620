//! Campbell diagram as seen from beside the wheel: the paper's Figs 5 and 11.

use std::f64::consts::TAU;

use super::axis::ticks;
use super::cells::{range, rpm};
use super::colour::ordinal;
use super::diagram::Diagram;
use super::key::{Key, MARK_WIDTH};
use super::labels::Labels;
use super::svg::{Element, document, group, line, polyline};
use super::{heading, marks};
use rubmap_analysis::result::{Campbell, Table, Wave};

const WIDTH: f64 = 1180.0;
const HEIGHT: f64 = 800.0;
const LEFT: f64 = 84.0;
const PLOT_WIDTH: f64 = 800.0;

/// Dashes of the waves that a superharmonic produces, beside those of n = 1.
const SUPERHARMONIC: [&str; 3] = ["6 3", "2 3", "7 3 2 3"];

/// Draws the frequencies at which waves of the wheel are seen from beside it, over speed: f + iΩ/2π of those that travel with the rotation,
/// |f − iΩ/2π| of those against it, and |f − i·n·Ω/2π| of the superharmonics n of Eq. 11. Where a line falls to zero the wave stands still
/// before the casing: the linear criterion's critical speeds.
pub fn campbell_fixed_frame(campbell: &Campbell) -> String {
    let title = TITLE;
    let (heading, bottom) = heading::heading(LEFT, title, &words(campbell));
    let curves = curves(campbell);
    let diagram = diagram(campbell, &curves, bottom + 24.0);
    let (x, y) = (ticks(diagram.x.values, 10.0), ticks(diagram.y.values, 10.0));
    let drawn = curves.iter().map(|curve| curve.draw(campbell, &diagram));
    let content = vec![
        heading,
        diagram.grid(&x, &y),
        diagram.region("inside"),
        group().set("clip-path", "url(#inside)").children(drawn),
        diagram.frame(),
        labels_and_crossings(campbell, &curves, &diagram),
        diagram.x_axis(&x, "rotational speed Ω, rpm"),
        diagram.y_axis(&y, "frequency in the fixed frame, Hz", 62.0),
        key(campbell, &curves, &diagram),
    ];
    document(title, WIDTH, HEIGHT, content)
}

/// Title of the diagram.
pub(super) const TITLE: &str = "Campbell diagram in the fixed frame";

/// Paragraphs below the title: modes per speed, lobes, model, and a warning about K(Ω) if there is one.
pub(super) fn words(campbell: &Campbell) -> Vec<String> {
    let words = format!(
        "{} modes per speed · {} lobes · {}",
        campbell.reduction.modes_per_speed,
        campbell.settings.lobes,
        heading::origin(&campbell.settings.model, &campbell.version)
    );
    let warning = campbell.reduction.stiffening.verdict.warning().map(str::to_owned);
    [words].into_iter().chain(warning).collect()
}

/// Wave of a mode, as seen in the fixed frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Seen {
    /// Wave that travels with the rotation, seen at f + iΩ/2π.
    Forward,
    /// Wave that travels against the rotation, seen at |f − iΩ/2π|.
    Backward,
    /// Wave of superharmonic n, seen at |f − i·n·Ω/2π|.
    Superharmonic(u32),
}

impl Seen {
    /// Words for the wave.
    pub(super) fn words(self) -> String {
        match self {
            Self::Backward => "against the rotation: |f − iΩ/2π|".to_owned(),
            Self::Forward => "with it: f + iΩ/2π".to_owned(),
            Self::Superharmonic(n) => format!("superharmonic: |f − {n}iΩ/2π|"),
        }
    }
}

/// Line of the diagram: a wave of one mode.
pub(super) struct Curve {
    pub(super) nodal_diameter: usize,
    pub(super) harmonics: usize,
    family: usize,
    pub(super) seen: Seen,
    /// Frequency in Hz at each speed.
    hz: Vec<Option<f64>>,
}

/// Lines of all waves of all modes.
pub(super) fn curves(campbell: &Campbell) -> Vec<Curve> {
    let branches = campbell.branches();
    let table = |wanted: Wave| {
        let found = branches.iter().find(|(wave, _)| wave.is_none_or(|wave| wave == wanted));
        found.map_or(&campbell.frequencies_hz, |(_, table)| *table)
    };
    let modes = |table: &Table| {
        let first = table.first();
        let harmonics = first.map_or(0, Vec::len);
        let families = first.into_iter().flatten().map(Vec::len).max().unwrap_or(0);
        (0..harmonics).flat_map(move |i| (0..families).map(move |j| (i, j, harmonics)))
    };
    let mut curves = Vec::new();
    for (seen, sign, table) in
        [(Seen::Backward, -1.0, table(Wave::Backward)), (Seen::Forward, 1.0, table(Wave::Forward))]
    {
        for (nodal_diameter, family, harmonics) in modes(table) {
            // A wave of nodal diameter 0 does not travel.
            if nodal_diameter == 0 && seen == Seen::Forward {
                continue;
            }
            let at = |(speed, row): (&f64, &Vec<Vec<f64>>)| {
                let hz = row.get(nodal_diameter)?.get(family)?;
                Some((hz + sign * nodal_diameter as f64 * speed / TAU).abs())
            };
            let hz = campbell.speeds_rad_s.iter().zip(table).map(at).collect();
            curves.push(Curve { nodal_diameter, harmonics, family, seen, hz });
        }
    }
    for absolute in campbell.absolute_frequencies_hz.iter().filter(|absolute| absolute.superharmonic > 1) {
        let table = &absolute.frequencies_hz;
        for (nodal_diameter, family, harmonics) in modes(table).filter(|(i, ..)| *i > 0) {
            let hz = table.iter().map(|row| row.get(nodal_diameter)?.get(family).copied()).collect();
            let seen = Seen::Superharmonic(absolute.superharmonic);
            curves.push(Curve { nodal_diameter, harmonics, family, seen, hz });
        }
    }
    curves
}

impl Curve {
    /// Speed in rpm and frequency in Hz along the line, with the points where it falls to zero.
    pub(super) fn places(&self, campbell: &Campbell) -> Vec<Option<(f64, f64)>> {
        let mut points = Vec::new();
        let mut before: Option<(f64, f64)> = None;
        for (speed, hz) in campbell.speeds_rad_s.iter().zip(&self.hz) {
            let now = hz.map(|hz| (rpm(*speed), hz));
            // |f − kΩ/2π| falls to zero between two speeds if its two values add up to the change of kΩ/2π.
            if let (Some(from), Some(to), true) = (before, now, self.seen != Seen::Forward) {
                points.extend(self.foot(from, to).map(|rpm| Some((rpm, 0.0))));
            }
            points.push(now);
            before = now;
        }
        points
    }

    fn draw(&self, campbell: &Campbell, diagram: &Diagram) -> Element {
        let points = self.places(campbell).into_iter();
        let points = points.map(|place| place.map(|(rpm, hz)| diagram.point(rpm, hz)));
        let (width, dashes, opacity) = self.style();
        polyline(points)
            .set("class", "wave")
            .set("stroke", ordinal(self.nodal_diameter, self.harmonics))
            .set("stroke-width", width)
            .set("stroke-dasharray", dashes)
            .set("stroke-opacity", opacity)
            .title(&self.words())
    }

    /// Speed at which the line touches zero between two points: where going straight through zero fits its slope better than staying above.
    fn foot(&self, from: (f64, f64), to: (f64, f64)) -> Option<f64> {
        let order = match self.seen {
            Seen::Superharmonic(n) => f64::from(n) * self.nodal_diameter as f64,
            Seen::Backward | Seen::Forward => self.nodal_diameter as f64,
        };
        let fall = order * (to.0 - from.0) / 60.0;
        let through = (from.1 + to.1 - fall.abs()).abs();
        let above = ((to.1 - from.1).abs() - fall.abs()).abs();
        (through < above && from.1 + to.1 > 0.0).then(|| from.0 + (to.0 - from.0) * from.1 / (from.1 + to.1))
    }

    fn style(&self) -> (&'static str, &'static str, &'static str) {
        match self.seen {
            Seen::Backward => ("1.8", "", "1"),
            Seen::Forward => ("0.8", "", "0.9"),
            Seen::Superharmonic(n) => ("1", SUPERHARMONIC[(n as usize + 1) % SUPERHARMONIC.len()], "0.6"),
        }
    }

    /// Words for the mode and the wave of the line.
    pub(super) fn words(&self) -> String {
        let (i, family) = (self.nodal_diameter, self.family + 1);
        match self.seen {
            Seen::Forward => format!("nodal diameter {i}, family {family}: f + iΩ/2π"),
            Seen::Backward => format!("nodal diameter {i}, family {family}: |f − iΩ/2π|"),
            Seen::Superharmonic(n) => format!("nodal diameter {i}, family {family}: |f − i·{n}·Ω/2π|"),
        }
    }
}

/// Empty diagram, from `top` downwards.
pub(super) fn diagram(campbell: &Campbell, curves: &[Curve], top: f64) -> Diagram {
    let highest = curves
        .iter()
        .filter(|curve| curve.seen != Seen::Forward)
        .flat_map(|curve| curve.hz.iter().flatten().copied())
        .filter(|hz| hz.is_finite());
    // The axis may cut off forward waves: the lines that fall to zero matter.
    let at_rest = curves.iter().filter_map(|curve| curve.hz.first().copied().flatten()).fold(0.0, f64::max);
    let highest = highest.fold(0.0, f64::max).min(if at_rest > 0.0 { 1.6 * at_rest } else { f64::INFINITY });
    let speeds = range(&campbell.speeds_rad_s);
    let size = (PLOT_WIDTH, HEIGHT - 66.0 - top);
    Diagram::new((LEFT, top), size, speeds, (0.0, if highest > 0.0 { 1.05 * highest } else { 1.0 }))
}

/// Marks where a wave stands still, on the line of zero frequency, and the nodal diameters at the lines of n = 1.
fn labels_and_crossings(campbell: &Campbell, curves: &[Curve], diagram: &Diagram) -> Element {
    let mut labels = Labels::inside(diagram);
    let mut drawn = group();
    for crossing in &campbell.crossings {
        let Some(place) = diagram.inside(rpm(crossing.speed_rad_s), 0.0) else { continue };
        let heights = [16.0, 30.0, 44.0, 58.0, 72.0].map(|up| (place.0, place.1 - up));
        let label =
            labels.at_first(heights, &marks::triple(crossing), 10.5).map(|label| label.rimmed("white"));
        drawn = drawn.child(marks::linear(place, "black", crossing)).children(label);
    }
    for curve in curves.iter().filter(|curve| !matches!(curve.seen, Seen::Superharmonic(_))) {
        let place = |(speed, hz): (&f64, &Option<f64>)| diagram.inside(rpm(*speed), (*hz)?);
        let seen: Vec<(f64, f64)> = campbell.speeds_rad_s.iter().zip(&curve.hz).filter_map(place).collect();
        let tried = [0.95, 0.85, 0.7, 0.55, 0.4].map(|share| seen.get((share * seen.len() as f64) as usize));
        let words = curve.nodal_diameter.to_string();
        let label = labels.at_first(tried.into_iter().flatten().copied(), &words, 11.0);
        let colour = ordinal(curve.nodal_diameter, curve.harmonics);
        drawn = drawn.children(
            label.map(|label| label.set("fill", colour).set("font-weight", "bold").rimmed("white")),
        );
    }
    drawn
}

fn key(campbell: &Campbell, curves: &[Curve], diagram: &Diagram) -> Element {
    /// Largest number of nodal diameters that the key names; more are named at the ends of their lines only.
    const MOST: usize = 16;
    let mut key = Key::new(diagram.right() + 30.0, diagram.top + 8.0);
    let stroke = |colour: &str, width: &str, dashes: &str| {
        let stroke = line((0.0, 0.0), (MARK_WIDTH, 0.0)).set("stroke", colour).set("stroke-width", width);
        stroke.set("stroke-dasharray", dashes)
    };
    let harmonics = curves.iter().map(|curve| curve.harmonics).max().unwrap_or(0);
    for i in (0..harmonics).filter(|i| harmonics <= MOST || *i == 0 || i + 1 == harmonics) {
        key = key.row(stroke(&ordinal(i, harmonics), "1.8", ""), &format!("nodal diameter {i}"));
    }
    let mut kinds: Vec<Seen> = Vec::new();
    for curve in curves {
        if !kinds.contains(&curve.seen) {
            kinds.push(curve.seen);
            let (width, dashes, _) = curve.style();
            key = key.row(stroke("#444444", width, dashes), &curve.seen.words());
        }
    }
    if campbell.crossings.iter().any(|crossing| diagram.x.contains(rpm(crossing.speed_rad_s))) {
        key = key.row(marks::ring((16.0, 0.0), "black"), "stands still: (i, j, n)");
    }
    let families: Vec<usize> = curves.iter().map(|curve| curve.family).collect();
    if let Some(last) = families.iter().max() {
        key = key.note("numbers at the lines: nodal diameters");
        key = key.note(&match last {
            0 => "the first family".to_owned(),
            last => format!("families 1 to {}, alike", last + 1),
        });
    }
    key.draw()
}
