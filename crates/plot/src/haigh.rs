//! Haigh diagram: alternating over mean stress, and the limits of the materials (Goodman, Mechanics Applied to Engineering, 1899).

use super::axis::{Scale, label, significant, ticks};
use super::cells::rpm;
use super::colour::{DASHES, level};
use super::diagram::Diagram;
use super::key::Flow;
use super::labels::Labels;
use super::svg::{Element, document, group, line, polyline};
use super::{colour, colour_bar, heading};
use rubmap_analysis::result::{SpeedStress, Strengths, StressCycle, SweepStress, drawn_stress_unit};

const WIDTH: f64 = 1180.0;
const LEFT: f64 = 100.0;
const PLOT: (f64, f64) = (900.0, 520.0);

/// Largest number of dots drawn, the most utilised first.
pub(super) const MOST: usize = 3000;

/// Number of dots that are labelled.
const LABELLED: usize = 5;

/// Utilisations whose lines are drawn beside that of 1.
pub(super) const LINES: [f64; 3] = [0.25, 0.5, 0.75];

const GOODMAN: &str = "#b01f20";
const YIELD: &str = "#555555";

/// Quantity that colours the dots of a Haigh diagram.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum HaighColour {
    /// Speed of a cycle.
    Speed,
    /// Utilisation of a cycle; cycles without one are grey.
    Utilisation,
}

/// Message where no stress was recorded.
pub(super) const NO_STRESS: &str = "Nothing to draw: no stress was recorded";

/// Draws the cycles of all speeds in the plane of mean and alternating stress, with Goodman's lines of equal utilisation and the yield
/// line of every material whose strengths are known. Below a mean of 0 only the alternating part counts. The most utilised places are
/// labelled.
pub fn haigh(stress: &SweepStress, by: HaighColour) -> String {
    let title = "Haigh diagram";
    let (stress, unit) = &drawn(stress);
    let cycles = ranked(stress);
    let (heading, bottom) = heading::heading(LEFT, title, &words(stress, &cycles, unit));
    let diagram = diagram(stress, &cycles, bottom + 28.0);
    let (x, y) = (ticks(diagram.x.values, 9.0), ticks(diagram.y.values, 8.0));
    let mut content = vec![heading, diagram.grid(&x, &y), diagram.region("cycles")];
    let lines = group().set("clip-path", "url(#cycles)").children(limits(stress, &diagram));
    content.push(lines);
    let (scale, colour) = colours(&cycles, by, &diagram);
    if cycles.is_empty() {
        content.push(diagram.words(NO_STRESS));
    }
    let all = cycles.iter().take(MOST).rev();
    content.push(group().children(all.filter_map(|cycle| dot(cycle, &diagram, &scale, by, unit))));
    content.extend([
        names(&cycles, &diagram),
        diagram.frame(),
        diagram.x_axis(&x, &mean_axis(unit)),
        diagram.y_axis(&y, &alternating_axis(unit), 72.0),
        key(stress, &cycles, diagram.bottom() + 66.0),
    ]);
    if tells_apart(&cycles, by) {
        let stops = (0..=32).map(|i| f64::from(i) / 32.0).map(|share| (share, level(share)));
        let bar = ticks(scale.values, 8.0);
        content.push(colour_bar::draw_colours(stops, &scale, diagram.right() + 26.0, &bar, colour));
    }
    document(title, WIDTH, diagram.bottom() + 116.0, content)
}

/// Title of the axis of mean stress.
pub(super) fn mean_axis(unit: &str) -> String {
    format!("mean stress (signed von Mises), {unit}")
}

/// Title of the axis of alternating stress.
pub(super) fn alternating_axis(unit: &str) -> String {
    format!("alternating stress, {unit}")
}

/// Converts stresses to the unit in which they are drawn, and names it.
pub(super) fn drawn(stress: &SweepStress) -> (SweepStress, String) {
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
pub(super) fn tells_apart(cycles: &[Cycle], by: HaighColour) -> bool {
    match by {
        HaighColour::Speed => cycles.iter().any(|(speed, _)| speed.index != cycles[0].0.index),
        HaighColour::Utilisation => {
            cycles.iter().any(|(_, cycle)| cycle.utilisation.is_some_and(f64::is_finite))
        }
    }
}

/// Cycle and its speed.
pub(super) type Cycle<'a> = (&'a SpeedStress, &'a StressCycle);

/// Cycles with finite mean and alternating stress, the most utilised first.
pub(super) fn ranked(stress: &SweepStress) -> Vec<Cycle<'_>> {
    let mut cycles = stress.ranked();
    cycles.retain(|(_, cycle)| cycle.mean.is_finite() && cycle.alternating.is_finite());
    cycles
}

/// Paragraphs below the title: number of speeds, the most utilised cycle, and what limits are known.
pub(super) fn words(stress: &SweepStress, cycles: &[Cycle], unit: &str) -> Vec<String> {
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

/// Diagram whose axes hold all cycles and the limits of the materials.
pub(super) fn diagram(stress: &SweepStress, cycles: &[Cycle], top: f64) -> Diagram {
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
    Diagram::new((LEFT, top), PLOT, about(low, right), about(0.0, upwards))
}

/// Draws Goodman's lines and the yield lines of all materials.
fn limits(stress: &SweepStress, diagram: &Diagram) -> Vec<Element> {
    let mut lines = Vec::new();
    let left = diagram.x.values.0;
    for (index, set) in stress.strengths.iter().enumerate() {
        let dashes = DASHES[index % DASHES.len()];
        if let (Some(fatigue), Some(ultimate)) = (set.fatigue, set.ultimate) {
            for used in LINES.into_iter().chain([1.0]) {
                let corners = goodman(left, used, (fatigue, ultimate));
                let places = corners.map(|(x, y)| Some(diagram.point(x, y)));
                let whole = used == 1.0;
                lines.push(
                    polyline(places)
                        .set("class", "goodman")
                        .set("stroke", GOODMAN)
                        .set("stroke-width", if whole { "1.8" } else { "0.7" })
                        .set("stroke-dasharray", dashes)
                        .title(&format!("{}: utilisation {used}", set.set)),
                );
                if !whole && index == 0 {
                    let (x, y) = diagram.point(0.0, used * fatigue);
                    let words = super::svg::text(x + 5.0, y - 4.0, "start", &format!("{used}"));
                    lines.push(words.set("fill", GOODMAN).set("font-size", "11").rimmed("white"));
                }
            }
        }
        if let Some(bears) = set.yield_ {
            let places = yields(bears).map(|(x, y)| Some(diagram.point(x, y)));
            let drawn =
                polyline(places).set("class", "yield").set("stroke", YIELD).set("stroke-width", "1.2");
            lines.push(drawn.set("stroke-dasharray", dashes).title(&format!("{}: yield", set.set)));
        }
    }
    lines
}

/// Goodman's line of a utilisation, from the left of the diagram to its foot, for these fatigue and ultimate strengths.
pub(super) fn goodman(left: f64, used: f64, (fatigue, ultimate): (f64, f64)) -> [(f64, f64); 3] {
    [(left, used * fatigue), (0.0, used * fatigue), (used * ultimate, 0.0)]
}

/// Yield line: the largest magnitude of mean ± alternating stress equals the yield strength.
pub(super) fn yields(bears: f64) -> [(f64, f64); 3] {
    [(-bears, 0.0), (0.0, bears), (bears, 0.0)]
}

/// Colour scale of the dots, as high as the diagram, and its title.
pub(super) fn colours(cycles: &[Cycle], by: HaighColour, diagram: &Diagram) -> (Scale, &'static str) {
    let places = (diagram.bottom(), diagram.top);
    let finite = |values: &mut dyn Iterator<Item = f64>| {
        values
            .filter(|value| value.is_finite())
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)))
    };
    match by {
        HaighColour::Speed => {
            let (slow, fast) = finite(&mut cycles.iter().map(|(speed, _)| rpm(speed.speed_rad_s)));
            let speeds = if slow < fast { (slow, fast) } else { (0.0, fast.max(1.0)) };
            (Scale::linear(speeds, places), "rotational speed Ω, rpm")
        }
        HaighColour::Utilisation => {
            let (_, most) = finite(&mut cycles.iter().filter_map(|(_, cycle)| cycle.utilisation));
            (Scale::linear((0.0, if most > 0.0 { most } else { 1.0 }), places), "utilisation")
        }
    }
}

/// Value that colours a cycle, if it is known.
pub(super) fn value((speed, cycle): &Cycle, by: HaighColour) -> Option<f64> {
    let value = match by {
        HaighColour::Speed => Some(rpm(speed.speed_rad_s)),
        HaighColour::Utilisation => cycle.utilisation,
    };
    value.filter(|value| value.is_finite())
}

/// Words for a cycle.
pub(super) fn told((speed, cycle): &Cycle, unit: &str) -> String {
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

fn dot(
    (speed, cycle): &Cycle,
    diagram: &Diagram,
    scale: &Scale,
    by: HaighColour,
    unit: &str,
) -> Option<Element> {
    let (x, y) = diagram.inside(cycle.mean, cycle.alternating)?;
    let value = value(&(speed, cycle), by);
    let fill = value.map_or_else(|| "#c8c8c8".to_owned(), |value| colour::hex(level(scale.share(value))));
    let words = told(&(speed, cycle), unit);
    let dot = Element::new("circle").set("class", "cycle").number("cx", x).number("cy", y).number("r", 3.4);
    let dot = dot.set("fill", fill).set("stroke", "#222222").set("stroke-width", "0.5");
    Some(dot.title(&words))
}

/// Labels with node and blade of the most utilised places, each place once.
fn names(cycles: &[Cycle], diagram: &Diagram) -> Element {
    let mut labels = Labels::inside(diagram);
    let mut named: Vec<(u64, u32)> = Vec::new();
    let mut words = group();
    for (_, cycle) in cycles {
        let place = (cycle.node, cycle.sector);
        if named.len() == LABELLED {
            break;
        }
        let Some(at) = diagram.inside(cycle.mean, cycle.alternating).filter(|_| !named.contains(&place))
        else {
            continue;
        };
        named.push(place);
        let name = format!("node {}, blade {}", cycle.node, cycle.sector);
        words = words.children(labels.beside(at, 4.0, &name, 11.0).map(|label| label.rimmed("white")));
    }
    words
}

/// Key of the marks that occur.
fn key(stress: &SweepStress, cycles: &[Cycle], y: f64) -> Element {
    let mut flow = Flow::new(LEFT, WIDTH - 20.0, y);
    let stroke = |colour: &str, width: &str, dashes: &str| {
        let stroke = line((0.0, 0.0), (30.0, 0.0)).set("stroke", colour).set("stroke-width", width);
        stroke.set("stroke-dasharray", dashes)
    };
    if !cycles.is_empty() {
        let dot = Element::new("circle").number("cx", 4.0).number("cy", 0.0).number("r", 3.4);
        let dot = dot.set("fill", "#c8c8c8").set("stroke", "#222222").set("stroke-width", "0.5");
        flow = flow.entry(dot, 8.0, "how the stress of a place goes over a revolution");
    }
    for (index, set) in stress.strengths.iter().enumerate() {
        let dashes = DASHES[index % DASHES.len()];
        if set.fatigue.is_some() && set.ultimate.is_some() {
            flow = flow.entry(
                stroke(GOODMAN, "1.8", dashes),
                30.0,
                &format!("Goodman, utilisation 1: {}", set.set),
            );
        }
        if set.yield_.is_some() {
            flow = flow.entry(stroke(YIELD, "1.2", dashes), 30.0, &format!("yield: {}", set.set));
        }
    }
    let lines = stress.strengths.iter().any(|set| set.fatigue.is_some() && set.ultimate.is_some());
    if lines {
        flow = flow.entry(stroke(GOODMAN, "0.7", ""), 30.0, "utilisation 0.25, 0.5, 0.75");
    }
    if cycles.len() > MOST {
        flow = flow.entry(group(), 0.0, &format!("{} less utilised ones are not drawn", cycles.len() - MOST));
    }
    flow.draw()
}
