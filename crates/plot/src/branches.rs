//! Branches of periodic responses: amplitude over the continuation parameter, with bifurcations, maxima and ends.

use super::axis::{label, significant};
use super::branch_line::{Fate, Place, Run, runs};
use super::cells::rpm;
use super::colour::DISTINCT;
use super::drawing::Drawing;
use super::layer::{self, Marks, Stroke};
use super::marched::{self, Dot};
use super::sketch::{Axis, Panel, Sketch};
use super::style::{Colour, Dash, Look, Pen, Symbol};
use super::svg::INK;
use super::{heading, scheme};
use rubmap_analysis::request::{BranchParameter, Sensor};
use rubmap_analysis::result::{
    Bifurcation, BifurcationKind, BranchEnd, BranchMaximum, BranchPoint, BranchTrack, Branches, Point,
    Stability,
};
use serde_json::json;

/// Number of points of all branches together beyond which indistinguishable ones are left out.
const MANY: usize = 4_000;

/// Distance, relative to the size of the diagram, below which points are indistinguishable.
const NEAR: f64 = 5e-4;

/// Message where there is no point.
const NONE: &str = "no point of a branch can be drawn";

/// Least part of the requested range that branches must cover for the whole range to be drawn; branches still being followed always show
/// it.
const LEAST_PART: f64 = 0.3;

/// Amplitude of a sensor along branches, stable and unstable, with bifurcations and maxima; `marched`: speeds of a sweep, as dots.
pub fn branches(branches: &Branches, sensor: usize, marched: &[Point]) -> Drawing<'static> {
    let view = View::new(branches, sensor, marched);
    let sketch = Sketch::new("branches", title(branches, sensor), words(branches));
    let sketch = sketch
        .meta("parameter", branches.head.parameter)
        .meta("units", json!({"x": view.over.unit(), "y": view.unit}))
        .meta("complete", branches.complete);
    if view.is_empty() {
        return sketch.nothing(if view.sensor.is_none() { "there is no such sensor" } else { NONE }).into();
    }
    let panel = view.panel(sketch.top() + 24.0);
    sketch.with(panel).meta("sensor", view.sensor).into()
}

/// Title: the parameter of the branches and the sensor.
fn title(branches: &Branches, sensor: usize) -> String {
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
fn words(branches: &Branches) -> Vec<String> {
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
struct Over(BranchParameter);

impl Over {
    /// Reads the continuation parameter of branches.
    fn of(branches: &Branches) -> Self {
        Self(branches.head.parameter)
    }

    /// Converts a value, or the error of one, to the unit of the axis.
    fn drawn(self, value: f64) -> f64 {
        if self.0 == BranchParameter::Speed { rpm(value) } else { value }
    }

    /// Title of the parameter axis.
    fn axis(self) -> &'static str {
        match self.0 {
            BranchParameter::Speed => "rotational speed Ω, rpm",
            BranchParameter::Clearance => "clearance / that of the scene",
            BranchParameter::LobeAmplitude => "height of the lobes / that of the scene",
            BranchParameter::Damping => "damping / that of the scene",
        }
    }

    /// Unit of the parameter axis.
    fn unit(self) -> &'static str {
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
struct Curve<'a> {
    branch: &'a BranchTrack,
    name: String,
    runs: Vec<Run>,
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
enum Mark {
    Bifurcation(BifurcationKind),
    Maximum,
    End,
}

impl Mark {
    /// Marks in the order of a key.
    const ALL: [Self; 6] = [
        Self::Bifurcation(BifurcationKind::Fold),
        Self::Bifurcation(BifurcationKind::Flip),
        Self::Bifurcation(BifurcationKind::NeimarkSacker),
        Self::Bifurcation(BifurcationKind::Branching),
        Self::Maximum,
        Self::End,
    ];

    /// Name of the mark.
    fn words(self) -> &'static str {
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

    fn look(self) -> Look {
        let colour = Colour::neutral(INK);
        let solid = |symbol, size| Look::filled(symbol, size, colour.clone()).with(INK, "white", 1.0);
        match self {
            Self::Bifurcation(BifurcationKind::Fold) => solid(Symbol::TriangleUp, (5.0, 12.0)),
            Self::Bifurcation(BifurcationKind::Flip) => solid(Symbol::Diamond, (4.6, 11.0)),
            Self::Bifurcation(BifurcationKind::NeimarkSacker) => {
                Look::open(Symbol::Target, (6.2, 12.0), colour.clone()).with(INK, "white", 1.0)
            }
            Self::Bifurcation(BifurcationKind::Branching) => solid(Symbol::Square, (5.6, 10.0)),
            Self::Maximum => Look::open(Symbol::Circle, (4.6, 10.0), colour.clone()).with("white", INK, 1.8),
            Self::End => Look::filled(Symbol::Cross, (5.0, 11.0), colour.clone()).with("none", INK, 2.0),
        }
    }
}

/// Mark with its position and its words.
#[derive(Debug)]
struct Marked {
    mark: Mark,
    place: Place,
    colour: &'static str,
    title: String,
    label: Option<String>,
}

impl Marked {
    fn mark(&self) -> layer::Mark {
        let mark = layer::Mark::new(self.place, self.title.clone());
        let label = self.label.clone().unwrap_or_default();
        let own = matches!(self.mark, Mark::Maximum | Mark::End);
        layer::Mark { colour: own.then(|| self.colour.to_owned()), ..mark.label(label) }
    }
}

/// Branches at one sensor, as the drawing shows them.
struct View<'a> {
    branches: &'a Branches,
    sensor: Option<&'a Sensor>,
    unit: &'a str,
    over: Over,
    /// Ranges of the parameter and of the amplitude.
    x: (f64, f64),
    y: (f64, f64),
    curves: Vec<Curve<'a>>,
    marked: Vec<Marked>,
    dots: Vec<Dot>,
    index: usize,
}

impl<'a> View<'a> {
    /// Reads the branches at the sensor of this index.
    fn new(branches: &'a Branches, index: usize, marched: &[Point]) -> Self {
        let sensor = branches.head.sensors.get(index);
        let unit = sensor.map_or("", |sensor| sensor.unit(&branches.head.units));
        let over = Over::of(branches);
        let (x, y) = ((0.0, 1.0), (0.0, 1.0));
        let (curves, marked, dots) = (Vec::new(), Vec::new(), Vec::new());
        let mut view = Self { branches, sensor, unit, over, x, y, curves, marked, dots, index };
        view.x = view.range();
        let beside = sensor.filter(|_| branches.head.parameter == BranchParameter::Speed);
        view.dots = beside.map_or_else(Vec::new, |sensor| marched::dots(marched, sensor, unit, view.x));
        view.y = view.heights();
        view.curves = view.curves();
        view.marked = view.marked();
        view
    }

    /// Whether there is no line to draw.
    fn is_empty(&self) -> bool {
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
        (span(self.x), span(self.y))
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
    fn point_words(&self, branch: &BranchTrack, point: &BranchPoint) -> String {
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
    fn bifurcation_words(&self, found: &Bifurcation) -> String {
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

    /// Title of the amplitude axis.
    fn height(&self) -> String {
        match self.unit {
            "" => "half peak to peak".to_owned(),
            unit => format!("half peak to peak, {unit}"),
        }
    }

    fn panel(&self, top: f64) -> Panel<'static> {
        let x = match self.over.0 {
            BranchParameter::Speed => Axis::speeds(self.x, 8.0),
            _ => Axis::linear(self.over.axis(), self.x, 8.0),
        };
        let mut panel = Panel::new((92.0, top), (800.0, 560.0), x, Axis::linear(self.height(), self.y, 8.0));
        let dots = marched::layers(&self.dots);
        let samples = dots
            .each_ref()
            .map(|dots| (!dots.marks.is_empty()).then(|| (dots.look.sample(), dots.name.clone())));
        panel.layers.extend(dots.into_iter().filter(|dots| !dots.marks.is_empty()).map(Into::into));
        // The first branch lies over those that start from it.
        for curve in self.curves.iter().rev() {
            panel
                .layers
                .extend(Fate::ALL.into_iter().filter_map(|fate| self.line(curve, fate)).map(Into::into));
        }
        self.key(&mut panel);
        for mark in Mark::ALL {
            if self.marked.iter().any(|one| one.mark == mark) {
                panel.sample(mark.look().sample(), mark.meaning());
            }
        }
        // Ends and maxima lie under bifurcations.
        for mark in Mark::ALL.into_iter().rev() {
            let here = self.marked.iter().filter(|one| one.mark == mark).map(Marked::mark);
            panel.push(Marks::new(mark.words(), mark.look(), here).class("mark"));
        }
        for (sample, words) in samples.into_iter().flatten() {
            panel.sample(sample, &words);
        }
        panel
    }

    /// Stretches of a branch with this stability.
    fn line(&self, curve: &Curve<'_>, fate: Fate) -> Option<layer::Curve> {
        let group = format!("branch {}", curve.branch.track.branch + 1);
        let runs: Vec<&Run> = curve.runs.iter().filter(|run| run.fate == fate).collect();
        let strokes = runs.iter().map(|run| Stroke {
            places: run.corners.iter().map(|(place, _)| Some(*place)).collect(),
            title: curve.name.clone(),
        });
        let corners = runs.iter().flat_map(|run| &run.corners);
        let told = corners.map(|(_, point)| {
            let point = point.and_then(|index| curve.branch.points.get(index));
            point.map_or_else(String::new, |point| self.point_words(curve.branch, point))
        });
        let name = format!("{group}, {}", fate.words());
        let line = layer::Curve::of(&name, strokes, pen(curve.branch, fate)).each(told.collect());
        (!runs.is_empty()).then(|| line.class(fate.words()).group(group))
    }

    /// Adds the rows of branches and stabilities to the key.
    fn key(&self, panel: &mut Panel) {
        /// Largest number of branches that the key names; more are named under the pointer only.
        const MOST: usize = 10;
        let shown: Vec<&Curve<'_>> = self.curves.iter().filter(|curve| !curve.runs.is_empty()).collect();
        for curve in shown.iter().take(MOST) {
            let track = &curve.branch.track;
            let words = match track.lobe_passages {
                None => format!("branch {}", track.branch + 1),
                Some(lobes) => format!("branch {}, after {lobes} lobes", track.branch + 1),
            };
            panel.sample(pen(curve.branch, Fate::Stable).sample(), &words);
        }
        if shown.len() > MOST {
            panel.note(&format!("and {} more branches", shown.len() - MOST));
        }
        for fate in Fate::ALL {
            let is_drawn = |run: &Run| run.fate == fate && run.corners.len() > 1;
            if shown.iter().any(|curve| curve.runs.iter().any(is_drawn)) {
                panel.sample(Pen::new(Colour::of(INK), dash(fate), 1.8).sample(), fate.words());
            }
        }
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

fn dash(fate: Fate) -> Dash {
    match fate {
        Fate::Stable => Dash::Solid,
        Fate::Unstable => Dash::Dashed,
        Fate::Undecided => Dash::Dotted,
    }
}

fn pen(branch: &BranchTrack, fate: Fate) -> Pen {
    let width = if branch.track.branch == 0 { 2.2 } else { 1.6 };
    Pen::new(Colour::of(colour(branch)), dash(fate), width)
}

/// Words for a stability.
fn stability(stability: Stability) -> &'static str {
    match stability {
        Stability::Stable => "stable",
        Stability::Narrow => "stable against very small disturbances only",
        Stability::Flip => "unstable: the period doubles",
        Stability::Fold => "unstable: another response takes over",
        Stability::NeimarkSacker => "unstable: a second frequency",
        Stability::Undecided => "stability undecided",
    }
}
