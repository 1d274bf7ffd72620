//! History as a line, or, where its swings do not fit, as the band they fill.

use super::key::MARK_WIDTH;
use super::style::{Dash, Pen};
use super::svg::{Element, line, polyline, rectangle};

/// Path of a history.
#[derive(Debug)]
pub(super) struct Trace {
    path: Element,
    /// Whether the path is the band between the lowest and the highest value of every column.
    pub(super) is_band: bool,
}

/// Largest number of samples per column one unit wide; beyond it a line through them is but a smear.
const MOST_PER_COLUMN: f64 = 5.0;

/// Width of a revolution below which each revolution is one column.
const NARROW: f64 = 40.0;

impl Trace {
    /// Draws a history through points from left to right; `revolution`: width of a revolution in the drawing.
    pub(super) fn of(places: Vec<(f64, f64)>, revolution: f64) -> Self {
        let width = places.last().map_or(0.0, |last| last.0 - places[0].0);
        let is_band = is_band(places.len(), width);
        // Swings within a narrow revolution cannot be seen beside many others; their bounds can.
        let column = if revolution < NARROW { revolution.max(1.0) } else { 1.0 };
        let points = if is_band { band(&places, column) } else { places };
        Self { path: polyline(points.into_iter().map(Some)).set("stroke-linejoin", "round"), is_band }
    }

    /// Draws the path as a line of this pen, or as the band that goes with it, pale if it is one of many.
    pub(super) fn drawn(self, pen: &Pen, is_of_many: bool) -> Element {
        shape(pen, self.path.set("class", "history"), self.is_band, is_of_many)
    }
}

/// Whether so many samples on a stretch of the drawing are too dense for a line.
pub(super) fn is_band(samples: usize, width: f64) -> bool {
    samples as f64 > MOST_PER_COLUMN * width.max(1.0)
}

/// Sample of a history in a key.
pub(super) fn sample(pen: &Pen, is_band: bool, is_of_many: bool) -> Element {
    let line = || line((0.0, 0.0), (MARK_WIDTH, 0.0));
    shape(pen, if is_band { rectangle(0.0, -6.0, MARK_WIDTH, 12.0) } else { line() }, is_band, is_of_many)
}

fn shape(pen: &Pen, shape: Element, is_band: bool, is_of_many: bool) -> Element {
    if !is_band {
        return pen.draw(shape);
    }
    let width = if is_of_many { 1.1 } else { 0.6 };
    let rim = Pen { width, dash: if is_of_many { pen.dash } else { Dash::Solid }, ..pen.clone() };
    let opacity = if is_of_many { "0.10" } else { "0.45" };
    let fill = format!("fill:{};fill-opacity:{opacity}", pen.colour.paper);
    rim.draw(shape).set("style", fill)
}

/// Outline of a band: along the highest value of every column of this width to the right, and back along the lowest; in steps, except where
/// a column is too narrow to show any.
fn band(places: &[(f64, f64)], width: f64) -> Vec<(f64, f64)> {
    let start = places.first().map_or(0.0, |first| first.0);
    let column = |place: &(f64, f64)| ((place.0 - start) / width).floor();
    let (mut out, mut back) = (Vec::new(), Vec::new());
    for here in places.chunk_by(|a, b| column(a) == column(b)) {
        let (from, to) = (here[0].0, here[here.len() - 1].0);
        let lower = |a: &&(f64, f64), b: &&(f64, f64)| a.1.total_cmp(&b.1);
        let ends = here.iter().min_by(lower).zip(here.iter().max_by(lower));
        let Some((top, foot)) = ends else { continue };
        for (side, extreme) in [(&mut out, top), (&mut back, foot)] {
            if width > 1.0 {
                side.extend([(from, extreme.1), (to, extreme.1)]);
            } else {
                side.push(*extreme);
            }
        }
    }
    out.extend(back.into_iter().rev());
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_band_goes_around_all_samples() {
        let swing = |i: u32| (f64::from(i) / 40.0, 10.0 * f64::from(i).sin());
        let all: Vec<_> = (0..4000).map(swing).collect();
        let around = band(&all, 1.0);
        assert_eq!(around.len(), 200);
        let (out, back) = around.split_at(100);
        for ((upper, lower), column) in out.iter().zip(back.iter().rev()).zip(all.chunks(40)) {
            assert!(column.iter().all(|place| place.1 >= upper.1 && place.1 <= lower.1));
        }
        assert!(Trace::of(all, 50.0).is_band && !Trace::of(vec![(0.0, 1.0); 3], 50.0).is_band);
        assert!(!Trace::of(Vec::new(), 0.0).is_band);
    }
}
