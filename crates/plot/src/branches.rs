//! Branches of periodic responses: amplitude over the continuation parameter, with bifurcations, maxima and ends.

use super::axis::{label, significant, ticks};
use super::branch_line::{Fate, Place, Run, runs};
use super::cells::rpm;
use super::colour::DISTINCT;
use super::diagram::Diagram;
use super::key::{Key, MARK_WIDTH};
use super::labels::{Labels, traced};
use super::marched::Dot;
use super::svg::{Element, INK, document, group, line, polyline, rectangle};
use super::{heading, marched, marks, scheme};
use rubmap_analysis::request::{BranchParameter, Sensor};
use rubmap_analysis::result::{
    Bifurcation, BifurcationKind, BranchEnd, BranchMaximum, BranchPoint, BranchTrack, Branches, Point,
    Stability,
};

const WIDTH: f64 = 1180.0;
const LEFT: f64 = 92.0;
const SIZE: (f64, f64) = (800.0, 560.0);

/// Number of points of all branches together beyond which indistinguishable ones are left out.
const MANY: usize = 4_000;

/// Distance, relative to the size of the diagram, below which points are indistinguishable.
const NEAR: f64 = 5e-4;

/// Message where there is no point.
pub(super) const NONE: &str = "no point of a branch can be drawn";

/// Least part of the requested range that branches must cover for the whole range to be drawn; branches still being followed always show
/// it.
const LEAST_PART: f64 = 0.3;

/// Draws the amplitude of a sensor along branches, stable and unstable, with bifurcations and maxima; `marched`: speeds of a sweep, as
/// dots.
pub fn branches(branches: &Branches, sensor: usize, marched: &[Point]) -> String {
    let title = title(branches, sensor);
    let (heading, bottom) = heading::heading(LEFT, &title, &words(branches));
    let view = View::new(branches, sensor, marched, bottom + 24.0);
    let mut content = vec![heading];
    content.extend(view.draw());
    document(&title, WIDTH, view.diagram.bottom() + 64.0, content)
}

/// Title: the parameter of the branches and the sensor.
pub(super) fn title(branches: &Branches, sensor: usize) -> String {
    let over = match branches.head.parameter {
        BranchParameter::Speed => "speed",
        BranchParameter::Clearance => "clearance",
        BranchParameter::LobeAmplitude => "height of the lobes",
        BranchParameter::Damping => "damping",
    };
    match branches.head.sensors.get(sensor) {
        Some(sensor) => format!("Branches over {over}: {sensor}"),
        None => format!("Branches over {over}: no such sensor"),
    }
}

/// Paragraphs below the title: numbers of points, branches and bifurcations, and how branches end.
pub(super) fn words(branches: &Branches) -> Vec<String> {
    let head = &branches.head;
    let counted =
        |count: usize, one: &str, many: &str| format!("{count} {}", if count == 1 { one } else { many });
    let points = branches.branches.iter().map(|branch| branch.points.len()).sum();
    let found = branches.branches.iter().map(|branch| branch.bifurcations.len()).sum();
    let mut words = vec![
        counted(points, "point", "points"),
        counted(branches.branches.len(), "branch", "branches"),
        counted(found, "bifurcation", "bifurcations"),
    ];
    if head.parameter != BranchParameter::Speed {
        let speed = branches.branches.iter().flat_map(|branch| &branch.points).next();
        words.extend(speed.map(|point| format!("at {} rpm", label(rpm(point.speed_rad_s), 0))));
    }
    words.push(format!("{}, {} steps per revolution", scheme::words(head.scheme), head.steps_per_revolution));
    words.push(heading::origin(&head.settings.sweep.model, &head.version));
    let ends = ends(branches);
    [words.join(" · ")].into_iter().chain((!ends.is_empty()).then_some(ends)).collect()
}

/// Reasons why branches end, in words.
fn ends(branches: &Branches) -> String {
    let mut words = Vec::new();
    if !branches.complete {
        words.push("still being followed, or stopped".to_owned());
    }
    let all = || branches.branches.iter().flat_map(|branch| branch.ends.iter().map(move |end| (branch, end)));
    let left = all().filter(|(_, end)| **end == BranchEnd::LeavesRange).count();
    if left > 0 {
        words.push(format!("{left} {} the range", if left == 1 { "end leaves" } else { "ends leave" }));
    }
    for (branch, end) in all() {
        let of = format!("branch {}", branch.track.branch + 1);
        match end {
            BranchEnd::LeavesRange => {}
            BranchEnd::Joins => words.push(format!("{of} comes back to the one that it doubles")),
            BranchEnd::MostPoints => words.push(format!("{of} has as many points as were asked for")),
            BranchEnd::Lost { reason } => words.push(format!("{of} is lost: {reason}")),
        }
    }
    words.join(" · ")
}

/// Continuation parameter of the branches, in the unit in which it is drawn.
#[derive(Debug, Clone, Copy)]
pub(super) struct Over(BranchParameter);

impl Over {
    /// Reads the continuation parameter of branches.
    pub(super) fn of(branches: &Branches) -> Self {
        Self(branches.head.parameter)
    }

    /// Converts a value, or the error of one, to the unit of the axis.
    pub(super) fn drawn(self, value: f64) -> f64 {
        if self.0 == BranchParameter::Speed { rpm(value) } else { value }
    }

    /// Title of the parameter axis.
    pub(super) fn axis(self) -> &'static str {
        match self.0 {
            BranchParameter::Speed => "rotational speed Ω, rpm",
            BranchParameter::Clearance => "clearance / that of the scene",
            BranchParameter::LobeAmplitude => "height of the lobes / that of the scene",
            BranchParameter::Damping => "damping / that of the scene",
        }
    }

    /// Unit of the parameter axis.
    pub(super) fn unit(self) -> &'static str {
        if self.0 == BranchParameter::Speed { "rpm" } else { "1" }
    }

    /// Words for a value of the parameter.
    fn words(self, value: f64) -> String {
        let drawn = self.drawn(value);
        match self.0 {
            BranchParameter::Speed => format!("{} rpm", label(drawn, 0)),
            _ => format!("× {}", label(drawn, 4)),
        }
    }

    /// Words for a value of the parameter with its error bound.
    fn known(self, value: f64, error: f64) -> String {
        let (drawn, error) = (self.drawn(value), self.drawn(error).abs());
        let (before, after) = if self.0 == BranchParameter::Speed { ("", " rpm") } else { ("× ", "") };
        if !(error.is_finite() && error > 0.0) {
            return self.words(value);
        }
        // Two digits of the error.
        let decimals = (1.0 - error.log10().floor()).clamp(0.0, 9.0) as usize;
        format!("{before}{} ± {}{after}", label(drawn, decimals), label(error, decimals))
    }
}

/// Branch as it is drawn.
#[derive(Debug)]
pub(super) struct Curve<'a> {
    pub(super) branch: &'a BranchTrack,
    pub(super) name: String,
    pub(super) runs: Vec<Run>,
}

impl Curve<'_> {
    pub(super) fn colour(&self) -> &'static str {
        colour(self.branch)
    }
}

/// Colour of a branch; no other branch has that of the first.
fn colour(branch: &BranchTrack) -> &'static str {
    match branch.track.branch as usize {
        0 => DISTINCT[0],
        doubled => DISTINCT[1 + (doubled - 1) % (DISTINCT.len() - 1)],
    }
}

/// Mark on a branch.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Mark {
    Bifurcation(BifurcationKind),
    Maximum,
    End,
}

impl Mark {
    /// Marks in the order of a key.
    pub(super) const ALL: [Self; 6] = [
        Self::Bifurcation(BifurcationKind::Fold),
        Self::Bifurcation(BifurcationKind::Flip),
        Self::Bifurcation(BifurcationKind::NeimarkSacker),
        Self::Bifurcation(BifurcationKind::Branching),
        Self::Maximum,
        Self::End,
    ];

    /// Name of the mark.
    pub(super) fn words(self) -> &'static str {
        match self {
            Self::Bifurcation(BifurcationKind::Fold) => "fold",
            Self::Bifurcation(BifurcationKind::Flip) => "flip",
            Self::Bifurcation(BifurcationKind::NeimarkSacker) => "Neimark–Sacker",
            Self::Bifurcation(BifurcationKind::Branching) => "branching",
            Self::Maximum => "maximum",
            Self::End => "followed no further",
        }
    }

    /// Name of the mark with its meaning, for the key.
    fn meaning(self) -> &'static str {
        match self {
            Self::Bifurcation(BifurcationKind::Fold) => "fold: it turns back",
            Self::Bifurcation(BifurcationKind::Flip) => "flip: the period doubles",
            Self::Bifurcation(BifurcationKind::NeimarkSacker) => "Neimark–Sacker: lines split",
            Self::Bifurcation(BifurcationKind::Branching) => "branching: meets another",
            Self::Maximum => "maximum: a critical value",
            Self::End => "followed no further",
        }
    }

    fn draw(self, (x, y): Place, colour: &str) -> Element {
        let disc = |radius| Element::new("circle").number("cx", x).number("cy", y).number("r", radius);
        let solid = |mark: Element| mark.set("fill", INK).set("stroke", "white").set("stroke-width", "1");
        match self {
            Self::Bifurcation(BifurcationKind::Fold) => {
                let (top, bottom) = (y - 7.0, y + 4.5);
                let path = format!("M{x:.2} {top:.2}L{:.2} {bottom:.2}L{:.2} {bottom:.2}Z", x + 6.5, x - 6.5);
                solid(Element::new("path").set("d", path))
            }
            Self::Bifurcation(BifurcationKind::Flip) => marks::diamond((x, y), INK, "white"),
            Self::Bifurcation(BifurcationKind::NeimarkSacker) => {
                group().child(solid(disc(6.2))).child(disc(2.2).set("fill", "white"))
            }
            Self::Bifurcation(BifurcationKind::Branching) => solid(rectangle(x - 5.0, y - 5.0, 10.0, 10.0)),
            Self::Maximum => disc(4.6).set("fill", "white").set("stroke", colour).set("stroke-width", "1.8"),
            Self::End => {
                let stroke = |from, to| line(from, to).set("stroke", colour).set("stroke-width", "2");
                group()
                    .child(stroke((x - 5.0, y - 5.0), (x + 5.0, y + 5.0)))
                    .child(stroke((x - 5.0, y + 5.0), (x + 5.0, y - 5.0)))
            }
        }
    }
}

/// Mark with its position and its words.
#[derive(Debug)]
pub(super) struct Marked {
    pub(super) mark: Mark,
    pub(super) place: Place,
    pub(super) colour: &'static str,
    pub(super) title: String,
    label: Option<String>,
}

/// Branches at one sensor, as the drawing shows them.
pub(super) struct View<'a> {
    pub(super) branches: &'a Branches,
    pub(super) sensor: Option<&'a Sensor>,
    pub(super) unit: &'a str,
    pub(super) over: Over,
    pub(super) diagram: Diagram,
    pub(super) curves: Vec<Curve<'a>>,
    pub(super) marked: Vec<Marked>,
    pub(super) dots: Vec<Dot>,
    index: usize,
}

impl<'a> View<'a> {
    /// Lays out the branches in a frame that begins at the height `top`.
    pub(super) fn new(branches: &'a Branches, index: usize, marched: &[Point], top: f64) -> Self {
        let sensor = branches.head.sensors.get(index);
        let unit = sensor.map_or("", |sensor| sensor.unit(&branches.head.units));
        let over = Over::of(branches);
        let diagram = Diagram::new((LEFT, top), SIZE, (0.0, 1.0), (0.0, 1.0));
        let (curves, marked, dots) = (Vec::new(), Vec::new(), Vec::new());
        let mut view = Self { branches, sensor, unit, over, diagram, curves, marked, dots, index };
        let x = view.range();
        let beside = sensor.filter(|_| branches.head.parameter == BranchParameter::Speed);
        view.dots = beside.map_or_else(Vec::new, |sensor| marched::dots(marched, sensor, unit, x));
        let y = view.heights();
        view.diagram = Diagram::new((LEFT, top), SIZE, x, y);
        view.curves = view.curves();
        view.marked = view.marked();
        view
    }

    /// Whether there is no line to draw.
    pub(super) fn is_empty(&self) -> bool {
        self.curves.iter().all(|curve| curve.runs.is_empty())
    }

    /// Position of a response, if both its values are finite.
    fn place(&self, value: f64, half_peak_to_peak: &[f64]) -> Option<Place> {
        let place = (self.over.drawn(value), *half_peak_to_peak.get(self.index)?);
        (place.0.is_finite() && place.1.is_finite()).then_some(place)
    }

    fn places(&self) -> impl Iterator<Item = Place> + '_ {
        self.branches.branches.iter().flat_map(move |branch| {
            let points = branch.points.iter().map(|point| (point.value, &point.half_peak_to_peak));
            let bends = branch.bifurcations.iter().map(|found| (found.value, &found.half_peak_to_peak));
            points.chain(bends).filter_map(|(value, amplitudes)| self.place(value, amplitudes))
        })
    }

    /// Range of the parameter axis: the requested one, or that of the points where complete branches cover little of it.
    fn range(&self) -> (f64, f64) {
        let along = self.branches.head.settings.along;
        let asked = (self.over.drawn(along.from), self.over.drawn(along.to));
        let (low, high) = bounds(self.places().map(|place| place.0));
        let (low, high) = if low <= high { (low, high) } else { asked };
        let is_range = asked.0.is_finite() && asked.1.is_finite() && asked.0 < asked.1;
        if is_range && (!self.branches.complete || high - low >= LEAST_PART * (asked.1 - asked.0)) {
            return (asked.0.min(low), asked.1.max(high));
        }
        let room = (0.06 * (high - low)).max(1e-3 * high.abs()).max(1e-9);
        (low - room, high + room)
    }

    /// Range of the amplitude axis: from 0, unless all amplitudes are nearly equal.
    fn heights(&self) -> (f64, f64) {
        let maxima = self.maxima().filter_map(|(_, one)| self.maximum(one)).map(|place| place.1);
        let dots = self.dots.iter().map(|dot| dot.place.1);
        let (low, high) = bounds(self.places().map(|place| place.1).chain(maxima).chain(dots));
        match low <= high && high > 0.0 {
            true if low > 0.7 * high => {
                let room = (0.12 * (high - low)).max(1e-3 * high);
                (low - room, high + room)
            }
            // Room for the label above the highest mark.
            true => (0.0, 1.1 * high),
            false => (0.0, 1.0),
        }
    }

    fn maxima(&self) -> impl Iterator<Item = (&'a BranchTrack, &'a BranchMaximum)> + use<'a> {
        let (all, index) = (&self.branches.branches, self.index);
        let of = all.iter().flat_map(|branch| branch.maxima.iter().map(move |one| (branch, one)));
        of.filter(move |(_, one)| one.sensor as usize == index)
    }

    fn maximum(&self, one: &BranchMaximum) -> Option<Place> {
        let place = (self.over.drawn(one.value), one.half_peak_to_peak);
        (place.0.is_finite() && place.1.is_finite()).then_some(place)
    }

    fn scale(&self) -> (f64, f64) {
        let span = |(low, high): (f64, f64)| high - low;
        (span(self.diagram.x.values), span(self.diagram.y.values))
    }

    fn curves(&self) -> Vec<Curve<'a>> {
        let all: usize = self.branches.branches.iter().map(|branch| branch.points.len()).sum();
        let curve = |branch: &'a BranchTrack| {
            let point = |point: &BranchPoint| {
                Some((self.place(point.value, &point.half_peak_to_peak)?, Fate::of(point.stability)))
            };
            let points: Vec<_> = branch.points.iter().map(point).collect();
            let bends: Vec<Place> = branch
                .bifurcations
                .iter()
                .filter_map(|found| self.place(found.value, &found.half_peak_to_peak))
                .collect();
            let mut runs = runs(&points, &bends, self.scale());
            if all > MANY {
                runs.iter_mut().for_each(|run| thin(&mut run.corners, self.scale()));
            }
            Curve { branch, name: self.name(branch), runs }
        };
        self.branches.branches.iter().map(curve).collect()
    }

    /// Words for a branch.
    fn name(&self, branch: &BranchTrack) -> String {
        let track = &branch.track;
        let mut words = format!("branch {}", track.branch + 1);
        if let Some(lobes) = track.lobe_passages {
            words += &format!(", repeats after {lobes} passages of a lobe");
        }
        if let Some((from, value)) = track.doubles {
            words += &format!(", from the flip of branch {} at {}", from + 1, self.over.words(value));
        }
        words
    }

    /// Words for a point.
    pub(super) fn point_words(&self, branch: &BranchTrack, point: &BranchPoint) -> String {
        let amplitude = point.half_peak_to_peak.get(self.index).copied().unwrap_or(f64::NAN);
        let leading = point.multipliers.first();
        let leading =
            leading.map_or_else(String::new, |one| format!(", largest |μ| = {}", significant(one.modulus)));
        format!(
            "branch {}, {}: {} {}, {}{leading}",
            branch.track.branch + 1,
            self.over.words(point.value),
            significant(amplitude),
            self.unit,
            stability(point.stability)
        )
    }

    fn marked(&self) -> Vec<Marked> {
        let of = |branch: &'a BranchTrack| {
            let found = branch.bifurcations.iter().filter_map(move |found| {
                let mark = Mark::Bifurcation(found.kind);
                Some(Marked {
                    mark,
                    place: self.place(found.value, &found.half_peak_to_peak)?,
                    colour: colour(branch),
                    title: self.bifurcation_words(found),
                    label: Some(format!("{} {}", mark.words(), self.over.words(found.value))),
                })
            });
            found.chain(self.ended(branch))
        };
        let maxima = self.maxima().filter_map(|(branch, one)| {
            let last = if Fate::of(one.stability) == Fate::Stable {
                ""
            } else {
                ", of a response that does not last"
            };
            let known = self.over.known(one.value, one.error);
            Some(Marked {
                mark: Mark::Maximum,
                place: self.maximum(one)?,
                colour: colour(branch),
                title: format!(
                    "maximum: {} {} at {known}{last}",
                    significant(one.half_peak_to_peak),
                    self.unit
                ),
                label: Some(self.over.words(one.value)),
            })
        });
        self.branches.branches.iter().flat_map(of).chain(maxima).collect()
    }

    /// Words for a bifurcation.
    pub(super) fn bifurcation_words(&self, found: &Bifurcation) -> String {
        let mark = Mark::Bifurcation(found.kind);
        let mut words = format!("{} at {}", mark.meaning(), self.over.known(found.value, found.error));
        if let Some(leading) = &found.multiplier {
            if found.kind == BifurcationKind::NeimarkSacker {
                words += &format!(", lines at k ± δ with δ = {}", significant(leading.order_offset));
            }
            words += &format!(", nodal diameter {}", leading.nodal_diameter);
        }
        if let Some(modulus) = found.stable_modulus.filter(|modulus| *modulus < 0.9) {
            words += &format!(", stability is lost at once: |μ| = {} before", significant(modulus));
        }
        words
    }

    /// Marks at the ends of a branch that stops within the range.
    fn ended(&self, branch: &'a BranchTrack) -> Vec<Marked> {
        let points = &branch.points;
        let (Some(first), Some(last)) = (points.first(), points.last()) else { return Vec::new() };
        // A branch with one end begins elsewhere: at its starting point, or at the end of the range.
        let along = self.branches.head.settings.along;
        let at: &[&BranchPoint] = match branch.ends.len() {
            1 if branch.track.branch == 0 && last.value == along.to => &[first],
            1 => &[last],
            _ => &[first, last],
        };
        let ended = branch.ends.iter().zip(at).filter_map(|(end, point)| {
            let why = match end {
                BranchEnd::LeavesRange | BranchEnd::Joins => return None,
                BranchEnd::MostPoints => "as many points as were asked for",
                BranchEnd::Lost { reason } => reason,
            };
            Some(Marked {
                mark: Mark::End,
                place: self.place(point.value, &point.half_peak_to_peak)?,
                colour: colour(branch),
                title: format!("{}: {why}", Mark::End.words()),
                label: None,
            })
        });
        ended.collect()
    }

    fn draw(&self) -> Vec<Element> {
        let diagram = &self.diagram;
        let (x, y) = (ticks(diagram.x.values, 8.0), ticks(diagram.y.values, 8.0));
        let mut content = vec![diagram.grid(&x, &y)];
        content.extend(self.dots.iter().filter_map(|dot| {
            let place = diagram.inside(dot.place.0, dot.place.1)?;
            Some(marched::mark(place, dot.settled).title(&dot.title))
        }));
        // The first branch lies over those that start from it.
        content.extend(self.curves.iter().rev().map(|curve| self.curve(curve)));
        content.push(self.marks());
        let nothing = if self.sensor.is_none() { "there is no such sensor" } else { NONE };
        content.extend(self.is_empty().then(|| diagram.words(nothing)));
        content.push(diagram.frame());
        content.push(diagram.x_axis(&x, self.over.axis()));
        content.push(diagram.y_axis(&y, &self.height(), 68.0));
        content.push(self.key());
        content
    }

    /// Title of the amplitude axis.
    pub(super) fn height(&self) -> String {
        match self.unit {
            "" => "half peak to peak".to_owned(),
            unit => format!("half peak to peak, {unit}"),
        }
    }

    fn curve(&self, curve: &Curve<'_>) -> Element {
        let drawn = curve.runs.iter().map(|run| {
            let places = run.corners.iter().map(|((x, y), _)| self.diagram.inside(*x, *y));
            if let [alone] = run.corners[..] {
                let (x, y) = self.diagram.point(alone.0.0, alone.0.1);
                let dot = Element::new("circle").number("cx", x).number("cy", y).number("r", 2.4);
                return dot.set("fill", curve.colour());
            }
            pen(polyline(places).set("class", run.fate.words()), curve.branch, run.fate)
        });
        group().set("class", "branch").children(drawn).title(&curve.name)
    }

    /// Positions in the drawing, close together, along all lines.
    fn traced(&self) -> Vec<Place> {
        let runs = self.curves.iter().flat_map(|curve| &curve.runs);
        let lines = runs.map(|run| run.corners.iter().map(|((x, y), _)| self.diagram.point(*x, *y)));
        lines.flat_map(traced).collect()
    }

    fn marks(&self) -> Element {
        let mut labels = Labels::inside(&self.diagram);
        let inside = |one: &'_ Marked| self.diagram.inside(one.place.0, one.place.1);
        for place in self.marked.iter().filter_map(inside) {
            labels.keep_off(place, 5.0);
        }
        let lines = self.traced();
        let mut drawn = group();
        // Ends and maxima lie under bifurcations.
        let is_bifurcation = |one: &&Marked| matches!(one.mark, Mark::Bifurcation(_));
        let (above, below): (Vec<&Marked>, Vec<&Marked>) = self.marked.iter().partition(is_bifurcation);
        for one in below.iter().chain(&above) {
            if let Some(place) = inside(one) {
                let mark = group().set("class", "mark").child(one.mark.draw(place, one.colour));
                drawn = drawn.child(mark.title(&one.title));
            }
        }
        for one in above.into_iter().chain(below) {
            let (Some(place), Some(words)) = (inside(one), &one.label) else { continue };
            let label = labels.beside_off(&lines, place, 8.0, words, 11.0);
            drawn = drawn.children(label.map(|label| label.rimmed("white")));
        }
        drawn
    }

    fn key(&self) -> Element {
        /// Largest number of branches that the key names; more are named under the pointer only.
        const MOST: usize = 10;
        let middle = (0.5 * MARK_WIDTH, 0.0);
        let mut key = Key::new(self.diagram.right() + 24.0, self.diagram.top + 8.0);
        let stroke = || line((0.0, 0.0), (MARK_WIDTH, 0.0));
        let shown: Vec<&Curve<'_>> = self.curves.iter().filter(|curve| !curve.runs.is_empty()).collect();
        for curve in shown.iter().take(MOST) {
            let track = &curve.branch.track;
            let words = match track.lobe_passages {
                None => format!("branch {}", track.branch + 1),
                Some(lobes) => format!("branch {}, after {lobes} lobes", track.branch + 1),
            };
            key = key.row(pen(stroke(), curve.branch, Fate::Stable), &words);
        }
        if shown.len() > MOST {
            key = key.note(&format!("and {} more branches", shown.len() - MOST));
        }
        for fate in Fate::ALL {
            let is_drawn = |run: &Run| run.fate == fate && run.corners.len() > 1;
            if shown.iter().any(|curve| curve.runs.iter().any(is_drawn)) {
                let pen = stroke().set("stroke", INK).set("stroke-width", "1.8");
                key = key.row(pen.set("stroke-dasharray", dashes(fate)), fate.words());
            }
        }
        for mark in Mark::ALL {
            if self.marked.iter().any(|one| one.mark == mark) {
                key = key.row(group().child(mark.draw(middle, INK)), mark.meaning());
            }
        }
        for (settled, words) in marched::KINDS {
            if self.dots.iter().any(|dot| dot.settled == settled) {
                key = key.row(marched::mark(middle, settled), words);
            }
        }
        key.draw()
    }
}

fn bounds(values: impl Iterator<Item = f64>) -> (f64, f64) {
    values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)))
}

/// Leaves out corners that are indistinguishable from the one before; the ends stay.
fn thin(corners: &mut Vec<(Place, Option<usize>)>, scale: (f64, f64)) {
    let Some((&last, before)) = corners.split_last() else { return };
    let mut kept: Vec<(Place, Option<usize>)> = Vec::new();
    for corner in before {
        let is_near = kept.last().is_some_and(|(place, _)| {
            f64::hypot((place.0 - corner.0.0) / scale.0, (place.1 - corner.0.1) / scale.1) < NEAR
        });
        if !is_near {
            kept.push(*corner);
        }
    }
    kept.push(last);
    *corners = kept;
}

fn dashes(fate: Fate) -> &'static str {
    match fate {
        Fate::Stable => "",
        Fate::Unstable => "7 4",
        Fate::Undecided => "1.5 3.5",
    }
}

fn pen(stroke: Element, branch: &BranchTrack, fate: Fate) -> Element {
    let width = if branch.track.branch == 0 { "2.2" } else { "1.6" };
    let stroke = stroke.set("stroke", colour(branch)).set("stroke-width", width);
    match dashes(fate) {
        "" => stroke.set("stroke-linejoin", "round"),
        dashes => stroke.set("stroke-linejoin", "round").set("stroke-dasharray", dashes),
    }
}

/// Words for a stability.
pub(super) fn stability(stability: Stability) -> &'static str {
    match stability {
        Stability::Stable => "stable",
        Stability::Narrow => "stable against very small disturbances only",
        Stability::Flip => "unstable: the period doubles",
        Stability::Fold => "unstable: another response takes over",
        Stability::NeimarkSacker => "unstable: a second frequency",
        Stability::Undecided => "stability undecided",
    }
}
