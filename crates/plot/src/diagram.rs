//! Rectangle of a diagram: frame, ticks and axis titles.

use super::axis::Scale;
use super::svg::{Element, INK, group, line, rectangle, text, upright};

/// Least size of a diagram with equal scales on both axes.
const SMALLEST: (f64, f64) = (320.0, 240.0);

/// Rectangle with a horizontal and a vertical axis.
#[derive(Debug, Clone, Copy)]
pub(super) struct Diagram {
    pub(super) left: f64,
    pub(super) top: f64,
    pub(super) width: f64,
    pub(super) height: f64,
    pub(super) x: Scale,
    pub(super) y: Scale,
}

impl Diagram {
    /// Builds a diagram with linear axes.
    pub(super) fn new(corner: (f64, f64), size: (f64, f64), x: (f64, f64), y: (f64, f64)) -> Self {
        Self::with_scales(corner, size, |places| Scale::linear(x, places), |places| Scale::linear(y, places))
    }

    /// Builds a diagram with a logarithmic horizontal axis, whose values must be positive, and a linear vertical one.
    pub(super) fn rightwards_logarithmic(
        corner: (f64, f64),
        size: (f64, f64),
        x: (f64, f64),
        y: (f64, f64),
    ) -> Self {
        let logarithmic = |places| Scale::logarithmic(x, places);
        Self::with_scales(corner, size, logarithmic, |places| Scale::linear(y, places))
    }

    /// Builds a diagram with linear axes of equal scale about all points, with some room; no wider and no higher than the points need, and
    /// at most of the size `within`.
    pub(super) fn of_one_scale(places: &[(f64, f64)], corner: (f64, f64), within: (f64, f64)) -> Self {
        let ends = |values: &mut dyn Iterator<Item = f64>| {
            values
                .filter(|value| value.is_finite())
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
                    (low.min(value), high.max(value))
                })
        };
        let x = ends(&mut places.iter().map(|place| place.0));
        let y = ends(&mut places.iter().map(|place| place.1));
        let (x, y) = if x.0 <= x.1 && y.0 <= y.1 { (x, y) } else { ((0.0, 1.0), (0.0, 1.0)) };
        let spans = (1.16 * (x.1 - x.0), 1.16 * (y.1 - y.0));
        let per_unit = f64::max(spans.0 / within.0, spans.1 / within.1);
        // A single point still needs surroundings.
        let per_unit = if per_unit > 0.0 { per_unit } else { 1.0 / within.0 };
        let about = |(low, high): (f64, f64), size: f64| {
            let (middle, half) = (0.5 * (low + high), 0.5 * size * per_unit);
            (middle - half, middle + half)
        };
        let size = (
            within.0.min(spans.0 / per_unit).max(SMALLEST.0),
            within.1.min(spans.1 / per_unit).max(SMALLEST.1),
        );
        Self::new(corner, size, about(x, size.0), about(y, size.1))
    }

    fn with_scales(
        (left, top): (f64, f64),
        (width, height): (f64, f64),
        x: impl Fn((f64, f64)) -> Scale,
        y: impl Fn((f64, f64)) -> Scale,
    ) -> Self {
        Self { left, top, width, height, x: x((left, left + width)), y: y((top + height, top)) }
    }

    pub(super) fn right(&self) -> f64 {
        self.left + self.width
    }

    pub(super) fn bottom(&self) -> f64 {
        self.top + self.height
    }

    pub(super) fn point(&self, x: f64, y: f64) -> (f64, f64) {
        (self.x.place(x), self.y.place(y))
    }

    /// Position of a point, if it lies in the diagram.
    pub(super) fn inside(&self, x: f64, y: f64) -> Option<(f64, f64)> {
        (self.x.contains(x) && self.y.contains(y)).then(|| self.point(x, y))
    }

    /// Whether a place of the drawing lies in the frame.
    pub(super) fn encloses(&self, (x, y): (f64, f64)) -> bool {
        (self.left..=self.right()).contains(&x) && (self.top..=self.bottom()).contains(&y)
    }

    /// Straight line between two points of linear axes, cut off at the frame; nothing if it lies outside.
    pub(super) fn clipped(&self, from: (f64, f64), to: (f64, f64)) -> Option<[(f64, f64); 2]> {
        let mut span = (0.0, 1.0);
        let delta = (to.0 - from.0, to.1 - from.1);
        let bounds = [(from.0, delta.0, self.x.values), (from.1, delta.1, self.y.values)];
        for (start, slope, (low, high)) in bounds {
            if slope == 0.0 {
                if start < low || start > high {
                    return None;
                }
                continue;
            }
            let (a, b) = ((low - start) / slope, (high - start) / slope);
            span = (f64::max(span.0, a.min(b)), f64::min(span.1, a.max(b)));
        }
        let at = |s: f64| (from.0 + s * delta.0, from.1 + s * delta.1);
        (span.0 < span.1).then(|| [at(span.0), at(span.1)])
    }

    /// Clipping region of this name that ends at the frame, for `clip-path`.
    pub(super) fn region(&self, name: &str) -> Element {
        let inside = rectangle(self.left, self.top, self.width, self.height);
        Element::new("defs").child(Element::new("clipPath").set("id", name).child(inside))
    }

    /// Background, to be drawn first.
    pub(super) fn background(&self, fill: &str) -> Element {
        rectangle(self.left, self.top, self.width, self.height).set("fill", fill)
    }

    /// Fine lines at ticks, to be drawn under the content.
    pub(super) fn grid(&self, x: &[(f64, String)], y: &[(f64, String)]) -> Element {
        let upright = x.iter().map(|(value, _)| self.x.place(*value));
        let upright = upright.map(|x| line((x, self.top), (x, self.bottom())));
        let level = y.iter().map(|(value, _)| self.y.place(*value));
        let level = level.map(|y| line((self.left, y), (self.right(), y)));
        group().set("stroke", "#efefef").children(upright).children(level)
    }

    /// Message in the middle of an empty diagram.
    pub(super) fn words(&self, words: &str) -> Element {
        let (x, y) = (self.left + 0.5 * self.width, self.top + 0.5 * self.height);
        text(x, y, "middle", words).set("class", "empty").set("font-size", "14")
    }

    /// Frame, to be drawn over the content.
    pub(super) fn frame(&self) -> Element {
        rectangle(self.left, self.top, self.width, self.height).set("fill", "none").set("stroke", INK)
    }

    /// Ticks and labels below, and the axis title if there is one.
    pub(super) fn x_axis(&self, ticks: &[(f64, String)], title: &str) -> Element {
        let bottom = self.bottom();
        let marks = ticks.iter().filter(|(value, _)| self.x.contains(*value)).flat_map(|(value, label)| {
            let x = self.x.place(*value);
            let tick = line((x, bottom), (x, bottom + 5.0)).set("stroke", INK);
            [tick, text(x, bottom + 19.0, "middle", label)]
        });
        let words = text(self.left + 0.5 * self.width, bottom + 42.0, "middle", title).set("font-size", "14");
        group().children(marks).children((!title.is_empty()).then(|| words.set("class", "axis")))
    }

    /// Ticks and labels on the left, and the axis title `away` from the frame.
    pub(super) fn y_axis(&self, ticks: &[(f64, String)], title: &str, away: f64) -> Element {
        let marks = ticks.iter().filter(|(value, _)| self.y.contains(*value)).flat_map(|(value, label)| {
            let y = self.y.place(*value);
            let tick = line((self.left - 5.0, y), (self.left, y)).set("stroke", INK);
            [tick, text(self.left - 9.0, y + 4.5, "end", label)]
        });
        let words = upright(self.left - away, self.top + 0.5 * self.height, "middle", title);
        let words = words.set("class", "axis").set("font-size", "14");
        group().children(marks).children((!title.is_empty()).then_some(words))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_end_at_the_frame() {
        let diagram = Diagram::new((0.0, 0.0), (100.0, 100.0), (0.0, 10.0), (0.0, 20.0));
        assert_eq!(diagram.clipped((0.0, 0.0), (10.0, 40.0)), Some([(0.0, 0.0), (5.0, 20.0)]));
        assert_eq!(diagram.clipped((0.0, 30.0), (10.0, 40.0)), None);
        assert_eq!(diagram.clipped((-5.0, 10.0), (5.0, 10.0)), Some([(0.0, 10.0), (5.0, 10.0)]));
        assert_eq!(diagram.inside(5.0, 10.0), Some((50.0, 50.0)));
        assert_eq!(diagram.inside(5.0, 21.0), None);
    }

    #[test]
    fn both_directions_have_one_scale() {
        for places in [&[(0.0, 0.0), (10.0, 1.0)][..], &[(5.0, 5.0)], &[], &[(0.0, -3.0), (0.1, 90.0)]] {
            let diagram = Diagram::of_one_scale(places, (90.0, 100.0), (790.0, 640.0));
            let a = diagram.width / (diagram.x.values.1 - diagram.x.values.0);
            let b = diagram.height / (diagram.y.values.1 - diagram.y.values.0);
            assert!((a / b - 1.0).abs() < 1e-9 || places.is_empty(), "{a} {b}");
            assert!(places.iter().all(|place| diagram.inside(place.0, place.1).is_some()));
        }
    }
}
