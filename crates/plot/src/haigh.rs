//! Haigh diagram: alternating over mean stress, and the limits of the materials (Goodman, Mechanics Applied to Engineering, 1899).

use super::axis::{label, significant};
use super::cells::rpm;
use super::colour::{self, level};
use super::drawing::Drawing;
use super::heading;
use super::layer::{Course, Curve, Mark, Marks, Stroke};
use super::sketch::{Axis, Panel, Sketch};
use super::style::{Colour, Dash, Look, Pen, Symbol};
use super::svg::{group, text};
use rubmap_analysis::result::{SpeedStress, Strengths, StressCycle, SweepStress, drawn_stress_unit};
use serde_json::json;

/// Largest number of dots drawn, the most utilised first.
const MOST: usize = 3000;

/// Number of dots that are labelled.
const LABELLED: usize = 5;

/// Utilisations whose lines are drawn beside that of 1.
const LINES: [f64; 3] = [0.25, 0.5, 0.75];

/// Quantity that colours the dots of a Haigh diagram.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum HaighColour {
    /// Speed of a cycle.
    Speed,
    /// Utilisation of a cycle; cycles without one are grey.
    Utilisation,
}

/// Cycles of all speeds in the plane of mean and alternating stress, those of a material under one name, with Goodman's lines of equal
/// utilisation and the yield line of every material whose strengths are known. Below a mean of 0 only the alternating part counts. The most
/// utilised places are labelled.
pub fn haigh(stress: &SweepStress, by: HaighColour) -> Drawing<'static> {
    let (stress, unit) = &drawn(stress);
    let cycles = ranked(stress);
    let mut sketch = Sketch::new("haigh", "Haigh diagram", words(stress, &cycles, unit)).high(620);
    sketch = sketch.meta("units", json!({"x": unit, "y": unit}));
    sketch =
        sketch.meta("speed_indices", stress.speeds.iter().map(|speed| speed.index).collect::<Vec<u32>>());
    if cycles.is_empty() {
        return sketch.nothing("Nothing to draw: no stress was recorded").into();
    }
    let more = cycles.len().saturating_sub(MOST);
    let more = (more > 0).then(|| format!("{more} less utilised ones are not drawn"));
    sketch.more.extend(more.clone());
    let (x, y) = ranges(stress, &cycles);
    let x = Axis::linear(format!("mean stress (signed von Mises), {unit}"), x, 9.0);
    let y = Axis::linear(format!("alternating stress, {unit}"), y, 8.0);
    let mut panel = Panel::new((92.0, sketch.top() + 28.0), (908.0, 520.0), x, y).key_below();
    if tells_apart(&cycles, by) {
        let (range, title) = colours(&cycles, by);
        panel = panel.ramp(title, range, level);
    }
    let dot =
        Look::filled(Symbol::Circle, (3.4, 7.0), Colour::neutral("#c8c8c8")).with("#c8c8c8", "#222222", 0.5);
    panel.sample(dot.sample(), "how the stress of a place goes over a revolution");
    limits(stress, &mut panel);
    dots(&cycles[..cycles.len().min(MOST)], by, unit, &mut panel);
    more.iter().for_each(|words| panel.note(words));
    sketch.with(panel).into()
}

/// Converts stresses to the unit in which they are drawn, and names it.
fn drawn(stress: &SweepStress) -> (SweepStress, String) {
    let (unit, factor) = drawn_stress_unit(&stress.units);
    let mut stress = stress.clone();
    for cycle in stress.speeds.iter_mut().flat_map(|speed| &mut speed.stress.cycles) {
        cycle.mean *= factor;
        cycle.alternating *= factor;
    }
    for strength in stress.strengths.iter_mut() {
        for value in
            [&mut strength.fatigue, &mut strength.ultimate, &mut strength.yield_].into_iter().flatten()
        {
            *value *= factor;
        }
    }
    (stress, unit)
}

/// Whether colours distinguish cycles: utilisation where some is known, speeds where there are several.
fn tells_apart(cycles: &[Cycle], by: HaighColour) -> bool {
    match by {
        HaighColour::Speed => cycles.iter().any(|(speed, _)| speed.index != cycles[0].0.index),
        HaighColour::Utilisation => {
            cycles.iter().any(|(_, cycle)| cycle.utilisation.is_some_and(f64::is_finite))
        }
    }
}

/// Cycle and its speed.
type Cycle<'a> = (&'a SpeedStress, &'a StressCycle);

/// Cycles with finite mean and alternating stress, the most utilised first.
fn ranked(stress: &SweepStress) -> Vec<Cycle<'_>> {
    let mut cycles = stress.ranked();
    cycles.retain(|(_, cycle)| cycle.mean.is_finite() && cycle.alternating.is_finite());
    cycles
}

/// Paragraphs below the title: number of speeds, the most utilised cycle, and what limits are known.
fn words(stress: &SweepStress, cycles: &[Cycle], unit: &str) -> Vec<String> {
    let mut words = vec![match stress.speeds.len() {
        1 => "1 speed".to_owned(),
        count => format!("{count} speeds"),
    }];
    if let Some((speed, cycle)) = cycles.first() {
        let place = format!(
            "at node {}, blade {}, {} rpm",
            cycle.node,
            cycle.sector,
            label(rpm(speed.speed_rad_s), 0)
        );
        words.push(match cycle.utilisation {
            Some(used) => format!("largest utilisation {} {place}", significant(used)),
            None => format!("largest alternating stress {} {unit} {place}", significant(cycle.alternating)),
        });
    }
    words.push(heading::origin(&stress.settings.model, &stress.version));
    let mut paragraphs = vec![words.join(" · ")];
    if let Some(speed) = stress.speeds.first() {
        let found = &speed.stress;
        paragraphs.push(format!(
            "of every speed the {} places; {} nodes of a sector within {} {} of a contact node are left out",
            if cycles.iter().any(|(_, cycle)| cycle.utilisation.is_some()) {
                "most utilised"
            } else {
                "most alternating"
            },
            found.excluded_nodes,
            significant(found.excluded_radius),
            stress.units.length
        ));
        paragraphs.extend(found.lacking.as_ref().map(|lacking| format!("no utilisation: {lacking}")));
    }
    let sources = stress.strengths.iter().filter_map(|set| Some((set, set.fatigue?, set.source.as_ref()?)));
    paragraphs.extend(sources.map(|(set, fatigue, source)| {
        format!("fatigue strength of {}: {} {unit}, {source}", set.set, significant(fatigue))
    }));
    paragraphs
}

/// Ranges of mean and alternating stress that hold all cycles and the limits of the materials.
fn ranges(stress: &SweepStress, cycles: &[Cycle]) -> ((f64, f64), (f64, f64)) {
    let bears = |of: fn(&Strengths) -> Option<f64>| {
        stress.strengths.iter().filter_map(of).filter(|value| value.is_finite()).fold(0.0, f64::max)
    };
    let ends = |of: fn(&StressCycle) -> f64| {
        let values = cycles.iter().map(|(_, cycle)| of(cycle));
        values.fold((0f64, 0f64), |(low, high), value| (low.min(value), high.max(value)))
    };
    let (low, high) = ends(|cycle| cycle.mean);
    let right = high.max(bears(|set| set.ultimate)).max(bears(|set| set.yield_));
    let upwards = ends(|cycle| cycle.alternating).1.max(bears(|set| set.fatigue));
    // An axis from a to b with some room beyond both.
    let about = |low: f64, high: f64| if low < high { (1.08 * low, 1.08 * high) } else { (0.0, 1.0) };
    (about(low, right), about(0.0, upwards))
}

/// Adds Goodman's lines and the yield lines of all materials.
fn limits(stress: &SweepStress, panel: &mut Panel) {
    let left = panel.x.range.0;
    let stroke =
        |corners: [(f64, f64); 3], title: String| Stroke { places: corners.map(Some).to_vec(), title };
    for (index, set) in stress.strengths.iter().enumerate() {
        let dash = Dash::nth(index);
        let red = |width| Pen::new(Colour { paper: "#b01f20".to_owned(), ..Colour::warning() }, dash, width);
        if let (Some(fatigue), Some(ultimate)) = (set.fatigue, set.ultimate) {
            let line = |used: f64| {
                stroke(goodman(left, used, (fatigue, ultimate)), format!("{}: utilisation {used}", set.set))
            };
            let parts = Curve::of("utilisation 0.25, 0.5, 0.75", LINES.map(line), red(0.7));
            let whole = Curve::of(&format!("Goodman, utilisation 1: {}", set.set), [line(1.0)], red(1.8));
            panel.sample(whole.sample(), &whole.name);
            if index == 0 {
                panel.sample(parts.sample(), &parts.name);
                let words = LINES.map(|used| {
                    let (x, y) = panel.diagram.point(0.0, used * fatigue);
                    let words = text(x + 5.0, y - 4.0, "start", &format!("{used}"));
                    words.set("fill", "#b01f20").set("font-size", "11").rimmed("white")
                });
                panel.push(group().children(words));
            }
            panel.push(parts.course(Course::Cut).class("goodman"));
            panel.push(whole.course(Course::Cut).class("goodman"));
        }
        if let Some(bears) = set.yield_ {
            let pen = Pen::new(Colour::neutral("#555555"), dash, 1.2);
            let line = stroke(yields(bears), format!("{}: yield", set.set));
            let curve = Curve::of(&format!("yield: {}", set.set), [line], pen);
            panel.sample(curve.sample(), &curve.name);
            panel.push(curve.course(Course::Cut).class("yield"));
        }
    }
}

/// Goodman's line of a utilisation, from the left of the diagram to its foot, for these fatigue and ultimate strengths.
fn goodman(left: f64, used: f64, (fatigue, ultimate): (f64, f64)) -> [(f64, f64); 3] {
    [(left, used * fatigue), (0.0, used * fatigue), (used * ultimate, 0.0)]
}

/// Yield line: the largest magnitude of mean ± alternating stress equals the yield strength.
fn yields(bears: f64) -> [(f64, f64); 3] {
    [(-bears, 0.0), (0.0, bears), (bears, 0.0)]
}

/// Range of the values that colour the dots, and its title.
fn colours(cycles: &[Cycle], by: HaighColour) -> ((f64, f64), &'static str) {
    let values = cycles.iter().filter_map(|cycle| value(cycle, by));
    let (low, high) = values
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)));
    match by {
        HaighColour::Speed => {
            (if low < high { (low, high) } else { (0.0, high.max(1.0)) }, "rotational speed Ω, rpm")
        }
        HaighColour::Utilisation => ((0.0, if high > 0.0 { high } else { 1.0 }), "utilisation"),
    }
}

/// Value that colours a cycle, if it is known.
fn value((speed, cycle): &Cycle, by: HaighColour) -> Option<f64> {
    let value = match by {
        HaighColour::Speed => Some(rpm(speed.speed_rad_s)),
        HaighColour::Utilisation => cycle.utilisation,
    };
    value.filter(|value| value.is_finite())
}

/// Words for a cycle.
fn told((speed, cycle): &Cycle, unit: &str) -> String {
    let used =
        cycle.utilisation.map(|used| format!(", utilisation {}", significant(used))).unwrap_or_default();
    format!(
        "{} rpm, node {}, blade {}, {}: {} ± {} {unit}{used}",
        label(rpm(speed.speed_rad_s), 0),
        cycle.node,
        cycle.sector,
        cycle.set,
        significant(cycle.mean),
        significant(cycle.alternating)
    )
}

/// Adds the cycles of every material, the most utilised over the others; those without a known colour value are grey.
fn dots(cycles: &[Cycle], by: HaighColour, unit: &str, panel: &mut Panel) {
    let mut sets: Vec<&str> = Vec::new();
    for (_, cycle) in cycles {
        if !sets.contains(&cycle.set.as_str()) {
            sets.push(&cycle.set);
        }
    }
    let named = named(cycles);
    let ramp = panel.ramp.clone();
    for (index, set) in sets.into_iter().enumerate() {
        for is_known in [true, false] {
            let of = |cycle: &&Cycle| cycle.1.set == set && value(cycle, by).is_some() == is_known;
            let here: Vec<&Cycle> = cycles.iter().rev().filter(of).collect();
            let values: Vec<f64> = here.iter().filter_map(|cycle| value(cycle, by)).collect();
            let mark = |cycle: &&Cycle| {
                let mark = Mark::new((cycle.1.mean, cycle.1.alternating), told(cycle, unit));
                let is_named = named.iter().any(|other| std::ptr::eq(*other, cycle.1));
                let name = format!("node {}, blade {}", cycle.1.node, cycle.1.sector);
                let mark = if is_named { mark.label(name) } else { mark };
                let colour = ramp.as_ref().zip(value(cycle, by)).map(|(ramp, value)| {
                    colour::hex(level((value - ramp.range.0) / (ramp.range.1 - ramp.range.0)))
                });
                Mark { index: Some(cycle.0.index as usize), colour, ..mark }
            };
            let unknown = ramp.as_ref().map_or("", |ramp| ramp.title.as_str());
            let name = if is_known { set.to_owned() } else { format!("{set}, {unknown} not known") };
            let look = Look::filled(Symbol::nth(index), (3.4, 7.0), Colour::neutral("#c8c8c8"));
            let marks = Marks::new(&name, look.with("#c8c8c8", "#222222", 0.5), here.iter().map(mark));
            let values = if ramp.is_some() { values } else { Vec::new() };
            panel.push(Marks { values, ..marks.class("cycle") });
        }
    }
}

/// Most utilised cycles, each place once.
fn named<'a>(cycles: &[Cycle<'a>]) -> Vec<&'a StressCycle> {
    let mut named: Vec<&StressCycle> = Vec::new();
    for (_, cycle) in cycles {
        let is_new = named.iter().all(|other| (other.node, other.sector) != (cycle.node, cycle.sector));
        if is_new && named.len() < LABELLED {
            named.push(cycle);
        }
    }
    named
}
