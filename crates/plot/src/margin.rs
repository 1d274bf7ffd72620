//! Utilisation in classes: dark where little margin is left, in colour and in grey.

use super::axis::significant;
use super::cells::Cell;
use super::colour;
use super::layer::{Area, Areas};
use super::sketch::Panel;
use super::svg::rectangle;
use super::validity;
use rubmap_analysis::result::InteractionMap;

/// Lower bound of each class of utilisation, its colour as a share of the scale of amplitudes, and its words.
const CLASSES: [(f64, f64, &str); 5] = [
    (0.0, 0.97, "utilisation below 0.25"),
    (0.25, 0.83, "from 0.25"),
    (0.5, 0.66, "from 0.5"),
    (0.75, 0.42, "from 0.75"),
    (1.0, 0.12, "1 and above"),
];

/// Class of a utilisation.
fn class(utilisation: f64) -> usize {
    CLASSES.iter().rposition(|(from, ..)| utilisation >= *from).unwrap_or(0)
}

/// Colour of a class of utilisation.
fn fill(class: usize) -> String {
    colour::hex(colour::amplitude(CLASSES[class].1))
}

/// Utilisation at the speed with this index.
fn utilisation(map: &InteractionMap, index: usize) -> Option<f64> {
    validity::point(map, index)?.utilisation().filter(|value| value.is_finite())
}

/// Areas of each class, of every cell whose utilisation is known and that has a vertical extent (see [`Area::upwards`]).
pub(super) fn areas(
    map: &InteractionMap,
    cells: &[Cell],
    upwards: impl Fn(&Cell) -> Option<Option<(f64, f64)>>,
) -> Vec<Areas> {
    let of = |place: usize| {
        let areas = cells.iter().filter_map(|cell| {
            let used = utilisation(map, cell.index).filter(|used| class(*used) == place)?;
            Some(Area { across: (cell.from, cell.to), upwards: upwards(cell)?, words: words(cell, used) })
        });
        Areas { name: CLASSES[place].2, areas: areas.collect(), fill: fill(place), class: "utilisation" }
    };
    (0..CLASSES.len()).map(of).collect()
}

/// Words for the utilisation of a speed.
fn words(cell: &Cell, utilisation: f64) -> String {
    format!("{:.0} rpm: utilisation {}", cell.rpm, significant(utilisation))
}

/// Adds the classes that occur to the key of a panel.
pub(super) fn explain(map: &InteractionMap, cells: &[Cell], panel: &mut Panel<'_>) {
    let found: Vec<usize> =
        cells.iter().filter_map(|cell| Some(class(utilisation(map, cell.index)?))).collect();
    if found.is_empty() {
        panel.note("no utilisation is known");
    }
    for (place, (.., words)) in CLASSES.iter().enumerate().filter(|(place, _)| found.contains(place)) {
        let patch = rectangle(0.0, -6.0, 20.0, 12.0).set("fill", fill(place)).set("stroke", "#888888");
        panel.wide_sample(patch, 20.0, words);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn classes_begin_where_they_say() {
        assert_eq!([0.0, 0.249, 0.25, 0.74, 0.99, 1.0, 7.0, f64::NAN].map(class), [0, 0, 1, 2, 3, 4, 4, 0]);
    }
}
