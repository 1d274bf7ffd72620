//! Utilisation in classes: dark where little margin is left, in colour and in grey.

use super::axis::significant;
use super::cells::Cell;
use super::colour;
use super::diagram::Diagram;
use super::key::Flow;
use super::svg::{Element, group, rectangle};
use super::validity;
use rubmap_analysis::result::InteractionMap;

/// Lower bound of each class of utilisation, its colour as a share of the scale of amplitudes, and its words.
pub(super) const CLASSES: [(f64, f64, &str); 5] = [
    (0.0, 0.97, "utilisation below 0.25"),
    (0.25, 0.83, "from 0.25"),
    (0.5, 0.66, "from 0.5"),
    (0.75, 0.42, "from 0.75"),
    (1.0, 0.12, "1 and above"),
];

/// The class of a utilisation.
pub(super) fn class(utilisation: f64) -> usize {
    CLASSES.iter().rposition(|(from, ..)| utilisation >= *from).unwrap_or(0)
}

/// Colour of a class of utilisation.
pub(super) fn fill(class: usize) -> String {
    colour::hex(colour::amplitude(CLASSES[class].1))
}

/// The utilisation at the speed with this index.
pub(super) fn utilisation(map: &InteractionMap, index: usize) -> Option<f64> {
    validity::point(map, index)?.utilisation().filter(|value| value.is_finite())
}

/// The area below a curve over speed, in the colours of the utilisation.
pub(super) fn area(
    map: &InteractionMap,
    cells: &[Cell],
    diagram: &Diagram,
    curve: impl Fn(&Cell) -> Option<f64>,
) -> Element {
    bars(map, cells, diagram, |cell| Some((diagram.y.place(curve(cell)?), diagram.bottom())))
}

/// Strip of this height on top of a diagram, in the colours of the utilisation.
pub(super) fn strip(map: &InteractionMap, cells: &[Cell], diagram: &Diagram, height: f64) -> Element {
    bars(map, cells, diagram, |_| Some((diagram.top - height, diagram.top)))
}

/// A bar for each cell whose utilisation is known, from its top to its bottom.
fn bars(
    map: &InteractionMap,
    cells: &[Cell],
    diagram: &Diagram,
    ends: impl Fn(&Cell) -> Option<(f64, f64)>,
) -> Element {
    let (low, high) = diagram.x.values;
    let seen = cells.iter().filter(|cell| cell.to > low && cell.from < high);
    let bars = seen.filter_map(|cell| {
        let used = utilisation(map, cell.index)?;
        let (top, bottom) = ends(cell)?;
        let (from, to) = (diagram.x.place(cell.from.max(low)), diagram.x.place(cell.to.min(high)));
        let bar = rectangle(from, top, to - from, bottom - top).set("class", "utilisation");
        Some(bar.set("fill", fill(class(used))).title(&words(cell, used)))
    });
    group().children(bars)
}

/// The utilisation of a speed in words.
pub(super) fn words(cell: &Cell, utilisation: f64) -> String {
    format!("{:.0} rpm: utilisation {}", cell.rpm, significant(utilisation))
}

/// The classes that occur, for a key.
pub(super) fn explained(mut flow: Flow, map: &InteractionMap, cells: &[Cell]) -> Flow {
    let found: Vec<usize> =
        cells.iter().filter_map(|cell| Some(class(utilisation(map, cell.index)?))).collect();
    if found.is_empty() {
        return flow.entry(group(), 0.0, "no utilisation is known");
    }
    for (place, (.., words)) in CLASSES.iter().enumerate().filter(|(place, _)| found.contains(place)) {
        let patch = rectangle(0.0, -6.0, 20.0, 12.0).set("fill", fill(place)).set("stroke", "#888888");
        flow = flow.entry(patch, 20.0, words);
    }
    flow
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn classes_begin_where_they_say() {
        assert_eq!([0.0, 0.249, 0.25, 0.74, 0.99, 1.0, 7.0, f64::NAN].map(class), [0, 0, 1, 2, 3, 4, 4, 0]);
    }
}
