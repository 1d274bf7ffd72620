//! Labels beside marks, where there is room for them.

use super::diagram::Diagram;
use super::svg::{Element, text, text_width};

/// Labels of a diagram: the areas taken so far, `[left, top, right, bottom]` each, and the bounds.
#[derive(Debug)]
pub(super) struct Labels {
    bounds: [f64; 4],
    taken: Vec<[f64; 4]>,
}

impl Labels {
    /// Prepares labels inside a diagram, with no area taken yet.
    pub(super) fn inside(diagram: &Diagram) -> Self {
        let bounds = [diagram.left + 2.0, diagram.top + 2.0, diagram.right() - 2.0, diagram.bottom() - 2.0];
        Self { bounds, taken: Vec::new() }
    }

    /// Keeps labels off a mark of this half width.
    pub(super) fn keep_off(&mut self, (x, y): (f64, f64), half: f64) {
        self.taken.push([x - half, y - half, x + half, y + half]);
    }

    /// Label beside a mark of this half width, off the lines that meet in the mark where possible; none where there is no room.
    pub(super) fn beside(&mut self, mark: (f64, f64), half: f64, words: &str, size: f64) -> Option<Element> {
        let [level, slanted] = around(mark, half, size, text_width(words, size));
        self.first(slanted.into_iter().chain(level), words, size)
    }

    /// Label beside a mark of this half width, where possible off points that lines go through; none where there is no room.
    pub(super) fn beside_off(
        &mut self,
        lines: &[(f64, f64)],
        mark: (f64, f64),
        half: f64,
        words: &str,
        size: f64,
    ) -> Option<Element> {
        let [level, slanted] = around(mark, half, size, text_width(words, size));
        let width = text_width(words, size);
        let covers = |place: &Place| {
            let area = [place.left, place.y - 0.5 * size, place.left + width, place.y + 0.5 * size];
            let is_in =
                |(x, y): &(f64, f64)| (area[0]..=area[2]).contains(x) && (area[1]..=area[3]).contains(y);
            lines.iter().any(is_in)
        };
        let (clear, covering): (Vec<Place>, Vec<Place>) =
            slanted.into_iter().chain(level).partition(|place| !covers(place));
        self.first(clear.into_iter().chain(covering), words, size)
    }

    fn first(&mut self, places: impl IntoIterator<Item = Place>, words: &str, size: f64) -> Option<Element> {
        let (width, rise) = (text_width(words, size), 0.36 * size);
        places.into_iter().find_map(|Place { x, y, anchor, left }| {
            let area = [left - 1.0, y - 0.5 * size, left + width + 1.0, y + 0.5 * size];
            self.take(area).then(|| {
                text(x, y + rise, anchor, words).set("class", "label").set("font-size", format!("{size}"))
            })
        })
    }

    /// Label centred at the first of some positions that is free.
    pub(super) fn at_first(
        &mut self,
        places: impl IntoIterator<Item = (f64, f64)>,
        words: &str,
        size: f64,
    ) -> Option<Element> {
        let half = 0.5 * text_width(words, size);
        let place = |(x, y): (f64, f64)| Place { x, y, anchor: "middle", left: x - half };
        self.first(places.into_iter().map(place), words, size)
    }

    fn take(&mut self, area: [f64; 4]) -> bool {
        let [left, top, right, bottom] = area;
        let within = left >= self.bounds[0]
            && top >= self.bounds[1]
            && right <= self.bounds[2]
            && bottom <= self.bounds[3];
        let meets =
            |other: &[f64; 4]| left < other[2] && right > other[0] && top < other[3] && bottom > other[1];
        let free = within && !self.taken.iter().any(meets);
        if free {
            self.taken.push(area);
        }
        free
    }
}

/// Points close together along a line with these corners.
pub(super) fn traced(corners: impl IntoIterator<Item = (f64, f64)>) -> Vec<(f64, f64)> {
    const APART: f64 = 4.0;
    /// Largest number of points per stretch; a longer stretch crosses the whole diagram.
    const MOST: f64 = 200.0;
    let corners: Vec<(f64, f64)> = corners.into_iter().collect();
    let stretch = |pair: &[(f64, f64)]| {
        let [from, to] = [pair[0], pair[1]];
        let steps = (f64::hypot(to.0 - from.0, to.1 - from.1) / APART).clamp(1.0, MOST).ceil();
        let at = move |share: f64| (from.0 + share * (to.0 - from.0), from.1 + share * (to.1 - from.1));
        (1..=steps as u32).map(move |k| at(f64::from(k) / steps))
    };
    corners.windows(2).flat_map(stretch).collect()
}

/// Position of a text: its middle height, its anchor, and its left end.
#[derive(Debug, Clone, Copy)]
struct Place {
    x: f64,
    y: f64,
    anchor: &'static str,
    left: f64,
}

/// Positions right, left, above and below of a mark, and in between.
fn around((x, y): (f64, f64), half: f64, size: f64, width: f64) -> [[Place; 4]; 2] {
    let rise = 0.36 * size;
    let (near, far) = (0.6 * half + 3.0, half + 4.0);
    let start = |x, y| Place { x, y, anchor: "start", left: x };
    let end = |x: f64, y| Place { x, y, anchor: "end", left: x - width };
    let middle = |x: f64, y| Place { x, y, anchor: "middle", left: x - 0.5 * width };
    let level = [start(x + far, y), end(x - far, y), middle(x, y - far - rise), middle(x, y + far + rise)];
    let (up, down) = (y - near - rise, y + near + rise);
    let slanted = [start(x + near, up), end(x - near, up), start(x + near, down), end(x - near, down)];
    [level, slanted]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_keep_off_lines_where_they_can() {
        let diagram = Diagram::new((0.0, 0.0), (400.0, 100.0), (0.0, 1.0), (0.0, 1.0));
        let mut labels = Labels::inside(&diagram);
        let rising: Vec<_> = (0..100).map(|k| (200.0 + f64::from(k), 50.0 - 0.3 * f64::from(k))).collect();
        labels.beside_off(&rising, (200.0, 50.0), 5.0, "a fold", 11.0).unwrap();
        assert!(labels.taken[0][2] < 200.0, "on the left: {:?}", labels.taken);
        let all: Vec<_> = (0..4000).map(|k| (f64::from(k % 80) * 5.0, f64::from(k / 80) * 2.0)).collect();
        assert!(labels.beside_off(&all, (200.0, 50.0), 5.0, "a fold", 11.0).is_some(), "rather than none");
    }

    #[test]
    fn labels_neither_meet_nor_leave() {
        let diagram = Diagram::new((0.0, 0.0), (200.0, 100.0), (0.0, 1.0), (0.0, 1.0));
        let mut labels = Labels::inside(&diagram);
        let found: Vec<_> =
            (0..20).filter_map(|_| labels.beside((100.0, 50.0), 5.0, "(1, 2, 3)", 11.0)).collect();
        assert!((2..=8).contains(&found.len()), "{}", found.len());
        assert!(labels.beside((198.0, 20.0), 5.0, "beyond", 11.0).is_some(), "on the left");
        for (i, a) in labels.taken.iter().enumerate() {
            for b in &labels.taken[..i] {
                assert!(a[0] >= b[2] || b[0] >= a[2] || a[1] >= b[3] || b[1] >= a[3], "{a:?} {b:?}");
            }
        }
    }
}
