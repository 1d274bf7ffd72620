//! Campbell diagram as seen from beside the wheel: the paper's Figs 5 and 11.

use std::f64::consts::TAU;

use super::campbell::{begin, family, name_families};
use super::cells::{range, rpm};
use super::drawing::Drawing;
use super::labels::Labels;
use super::layer::{self, Course, Mark, Marks};
use super::marks;
use super::sketch::{Axis, Panel};
use super::style::{Colour, Dash, Look, Pen, Symbol};
use super::svg::{Element, group};
use rubmap_analysis::result::{Campbell, Table, Wave};

/// Frequencies at which waves of the wheel are seen from beside it, over speed: f + iΩ/2π of those that travel with the rotation,
/// |f − iΩ/2π| of those against it, and |f − i·n·Ω/2π| of the superharmonics n of Eq. 11. Where a line falls to zero the wave stands still
/// before the casing: the linear criterion's critical speeds.
pub fn campbell_fixed_frame(campbell: &Campbell) -> Drawing<'_> {
    let curves = curves(campbell);
    let mut kinds: Vec<Seen> = Vec::new();
    for curve in &curves {
        if !kinds.contains(&curve.seen) {
            kinds.push(curve.seen);
        }
    }
    let mut sketch = begin("campbell_fixed_frame", "Campbell diagram in the fixed frame", campbell).high(640);
    sketch.more = kinds.iter().map(|seen| format!("{}: {}", seen.style().2, seen.words())).collect();
    let x = Axis::speeds(range(&campbell.speeds_rad_s), 10.0);
    let y = Axis::linear("frequency in the fixed frame, Hz", heights(&curves), 10.0);
    let top = sketch.top() + 24.0;
    let mut panel = Panel::new((92.0, top), (792.0, 734.0 - top), x, y);
    let families = curves.iter().map(|curve| curve.family + 1).max().unwrap_or(0);
    for curve in &curves {
        let (dash, width, _) = curve.seen.style();
        let pen = Pen::new(Colour::family(curve.family, families), dash, width);
        let line = layer::Curve::new(&family(curve.family), curve.places(campbell), pen);
        let line = line.title(&curve.words()).over(curve.words(), "%{x:.0f} rpm, %{y:.1f} Hz");
        panel.push(line.course(Course::Cut).class("wave"));
    }
    name_families(families, &mut panel);
    for seen in kinds {
        let (dash, width, _) = seen.style();
        panel.sample(Pen::new(Colour::of("#444444"), dash, width).sample(), &seen.words());
    }
    let standing = campbell.crossings.iter().filter(|found| panel.diagram.x.contains(rpm(found.speed_rad_s)));
    let standing = standing.map(|found| Mark::new((rpm(found.speed_rad_s), 0.0), marks::linear_words(found)));
    let ring = Look::open(Symbol::Circle, (4.5, 10.0), Colour::neutral("black"));
    panel.marks("stands still: (i, j, n)", Marks::new("stands still: (i, j, n)", ring, standing));
    if families > 0 {
        panel.note("numbers at the lines: nodal diameters");
    }
    let labels = labels(campbell, (&curves, families), &panel);
    panel.push(labels);
    sketch.with(panel).into()
}

/// Wave of a mode, as seen in the fixed frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Seen {
    /// Wave that travels with the rotation, seen at f + iΩ/2π.
    Forward,
    /// Wave that travels against the rotation, seen at |f − iΩ/2π|.
    Backward,
    /// Wave of superharmonic n, seen at |f − i·n·Ω/2π|.
    Superharmonic(u32),
}

impl Seen {
    /// Words for the wave.
    fn words(self) -> String {
        match self {
            Self::Backward => "against the rotation: |f − iΩ/2π|".to_owned(),
            Self::Forward => "with it: f + iΩ/2π".to_owned(),
            Self::Superharmonic(n) => format!("superharmonic: |f − {n}iΩ/2π|"),
        }
    }

    /// Dashes and width of the lines, and a word for them.
    fn style(self) -> (Dash, f64, &'static str) {
        match self {
            Self::Backward => (Dash::Solid, 1.8, "drawn through"),
            Self::Forward => (Dash::Solid, 0.7, "thin"),
            Self::Superharmonic(n) if n % 2 == 0 => (Dash::Dashed, 1.0, "dashed"),
            Self::Superharmonic(_) => (Dash::Dotted, 1.0, "dotted"),
        }
    }
}

/// Line of the diagram: a wave of one mode.
struct Curve {
    nodal_diameter: usize,
    family: usize,
    seen: Seen,
    /// Frequency in Hz at each speed.
    hz: Vec<Option<f64>>,
}

/// Lines of all waves of all modes.
fn curves(campbell: &Campbell) -> Vec<Curve> {
    let branches = campbell.branches();
    let table = |wanted: Wave| {
        let found = branches.iter().find(|(wave, _)| wave.is_none_or(|wave| wave == wanted));
        found.map_or(&campbell.frequencies_hz, |(_, table)| *table)
    };
    let modes = |table: &Table| {
        let first = table.first();
        let harmonics = first.map_or(0, Vec::len);
        let families = first.into_iter().flatten().map(Vec::len).max().unwrap_or(0);
        (0..harmonics).flat_map(move |i| (0..families).map(move |j| (i, j)))
    };
    let mut curves = Vec::new();
    for (seen, sign, table) in
        [(Seen::Backward, -1.0, table(Wave::Backward)), (Seen::Forward, 1.0, table(Wave::Forward))]
    {
        for (nodal_diameter, family) in modes(table) {
            // A wave of nodal diameter 0 does not travel.
            if nodal_diameter == 0 && seen == Seen::Forward {
                continue;
            }
            let at = |(speed, row): (&f64, &Vec<Vec<f64>>)| {
                let hz = row.get(nodal_diameter)?.get(family)?;
                Some((hz + sign * nodal_diameter as f64 * speed / TAU).abs())
            };
            let hz = campbell.speeds_rad_s.iter().zip(table).map(at).collect();
            curves.push(Curve { nodal_diameter, family, seen, hz });
        }
    }
    for absolute in campbell.absolute_frequencies_hz.iter().filter(|absolute| absolute.superharmonic > 1) {
        let table = &absolute.frequencies_hz;
        for (nodal_diameter, family) in modes(table).filter(|(i, _)| *i > 0) {
            let hz = table.iter().map(|row| row.get(nodal_diameter)?.get(family).copied()).collect();
            let seen = Seen::Superharmonic(absolute.superharmonic);
            curves.push(Curve { nodal_diameter, family, seen, hz });
        }
    }
    curves
}

impl Curve {
    /// Speed in rpm and frequency in Hz along the line, with the points where it falls to zero.
    fn places(&self, campbell: &Campbell) -> Vec<Option<(f64, f64)>> {
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

    /// Words for the mode and the wave of the line.
    fn words(&self) -> String {
        let (i, family) = (self.nodal_diameter, self.family + 1);
        match self.seen {
            Seen::Forward => format!("nodal diameter {i}, family {family}: f + iΩ/2π"),
            Seen::Backward => format!("nodal diameter {i}, family {family}: |f − iΩ/2π|"),
            Seen::Superharmonic(n) => format!("nodal diameter {i}, family {family}: |f − i·{n}·Ω/2π|"),
        }
    }
}

/// Range of frequencies. It may cut off forward waves: the lines that fall to zero matter.
fn heights(curves: &[Curve]) -> (f64, f64) {
    let slow = curves.iter().filter(|curve| curve.seen != Seen::Forward);
    let all = slow.flat_map(|curve| curve.hz.iter().flatten().copied()).filter(|hz| hz.is_finite());
    let at_rest = curves.iter().filter_map(|curve| curve.hz.first().copied().flatten()).fold(0.0, f64::max);
    let highest = all.fold(0.0, f64::max).min(if at_rest > 0.0 { 1.6 * at_rest } else { f64::INFINITY });
    (0.0, if highest > 0.0 { 1.05 * highest } else { 1.0 })
}

/// Labels of the standing waves above the line of zero frequency, and the nodal diameters at the lines of n = 1.
fn labels(campbell: &Campbell, (curves, families): (&[Curve], usize), panel: &Panel) -> Element {
    let diagram = &panel.diagram;
    let mut labels = Labels::inside(diagram);
    let mut drawn = group();
    for crossing in &campbell.crossings {
        let Some(place) = diagram.inside(rpm(crossing.speed_rad_s), 0.0) else { continue };
        let heights = [16.0, 30.0, 44.0, 58.0, 72.0].map(|up| (place.0, place.1 - up));
        let label = labels.at_first(heights, &marks::triple(crossing), 10.5);
        drawn = drawn.children(label.map(|label| label.rimmed("white")));
    }
    for curve in curves.iter().filter(|curve| !matches!(curve.seen, Seen::Superharmonic(_))) {
        let place = |(speed, hz): (&f64, &Option<f64>)| diagram.inside(rpm(*speed), (*hz)?);
        let seen: Vec<(f64, f64)> = campbell.speeds_rad_s.iter().zip(&curve.hz).filter_map(place).collect();
        let tried = [0.95, 0.85, 0.7, 0.55, 0.4].map(|share| seen.get((share * seen.len() as f64) as usize));
        let words = curve.nodal_diameter.to_string();
        let label = labels.at_first(tried.into_iter().flatten().copied(), &words, 11.0);
        let colour = Colour::family(curve.family, families).paper;
        drawn = drawn.children(
            label.map(|label| label.set("fill", colour).set("font-weight", "bold").rimmed("white")),
        );
    }
    drawn
}
