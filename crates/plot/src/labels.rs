//! Labels beside marks, where there is room for them.

use super::diagram::Diagram;
use super::svg::{Element, text, text_width};

/// What is taken of a diagram: `[left, top, right, bottom]` each.
#[derive(Debug)]
pub(super) struct Labels {
    bounds: [f64; 4],
    taken: Vec<[f64; 4]>,
}

impl Labels {
    /// For labels inside a diagram, of which nothing is taken yet.
    pub(super) fn inside(diagram: &Diagram) -> Self {
        let bounds = [diagram.left + 2.0, diagram.top + 2.0, diagram.right() - 2.0, diagram.bottom() - 2.0];
        Self { bounds, taken: Vec::new() }
    }

    /// Keeps labels off a mark of this half width.
    pub(super) fn keep_off(&mut self, (x, y): (f64, f64), half: f64) {
        self.taken.push([x - half, y - half, x + half, y + half]);
    }

    /// Words beside a mark of this half width, off the lines that meet in it where possible; none where all places are taken.
    pub(super) fn beside(
        &mut self,
        (x, y): (f64, f64),
        half: f64,
        words: &str,
        size: f64,
    ) -> Option<Element> {
        let (width, rise) = (text_width(words, size), 0.36 * size);
        let (near, far) = (0.6 * half + 3.0, half + 4.0);
        let (up, down) = (y - near - rise, y + near + rise);
        let places = [
            (x + near, up, "start", x + near),
            (x - near, up, "end", x - near - width),
            (x + near, down, "start", x + near),
            (x - near, down, "end", x - near - width),
            (x + far, y, "start", x + far),
            (x - far, y, "end", x - far - width),
            (x, y - far - rise, "middle", x - 0.5 * width),
            (x, y + far + rise, "middle", x - 0.5 * width),
        ];
        places.into_iter().find_map(|(x, y, anchor, left)| {
            let area = [left - 1.0, y - 0.5 * size, left + width + 1.0, y + 0.5 * size];
            self.take(area).then(|| {
                text(x, y + rise, anchor, words).set("class", "label").set("font-size", format!("{size}"))
            })
        })
    }

    /// Words centred at one of the places, the first that is free.
    pub(super) fn at_first(
        &mut self,
        places: impl IntoIterator<Item = (f64, f64)>,
        words: &str,
        size: f64,
    ) -> Option<Element> {
        let (half, rise) = (0.5 * text_width(words, size), 0.36 * size);
        places.into_iter().find_map(|(x, y)| {
            let area = [x - half - 1.0, y - 0.5 * size, x + half + 1.0, y + 0.5 * size];
            self.take(area).then(|| {
                text(x, y + rise, "middle", words).set("class", "label").set("font-size", format!("{size}"))
            })
        })
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

#[cfg(test)]
mod tests {
    use super::*;

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
