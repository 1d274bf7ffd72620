//! A history as a line, or, where its swings do not fit, as the band they fill.

use super::svg::{Element, polyline};

/// What shows of a history.
#[derive(Debug)]
pub(super) struct Trace {
    path: Element,
    /// Whether it is the band between the lowest and the highest value of every column.
    pub(super) is_band: bool,
}

/// Samples that a column one unit wide may have before a line through them is but a smear.
const MOST_PER_COLUMN: f64 = 5.0;

impl Trace {
    /// Of places from left to right.
    pub(super) fn of(places: Vec<(f64, f64)>) -> Self {
        let width = places.last().map_or(0.0, |last| last.0 - places[0].0);
        let is_band = places.len() as f64 > MOST_PER_COLUMN * width.max(1.0);
        let points = if is_band { band(&places) } else { places };
        Self { path: polyline(points.into_iter().map(Some)).set("stroke-linejoin", "round"), is_band }
    }

    /// In a colour, with these dashes where it is a line.
    pub(super) fn coloured(self, colour: &str, width: f64, dashes: &str) -> Element {
        let path = self.path.set("stroke", colour).set("class", "history");
        if self.is_band {
            return path.set("stroke-width", "0.6").set("style", format!("fill:{colour};fill-opacity:0.45"));
        }
        path.number("stroke-width", width).set("stroke-dasharray", dashes)
    }
}

/// Along the highest of every column to the right, and back along the lowest.
fn band(places: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let columns = || places.chunk_by(|a, b| a.0.floor() == b.0.floor());
    let of = |column: &[(f64, f64)], least: bool| {
        let places = column.iter().copied();
        if least {
            places.min_by(|a, b| a.1.total_cmp(&b.1))
        } else {
            places.max_by(|a, b| a.1.total_cmp(&b.1))
        }
    };
    let mut out: Vec<(f64, f64)> = columns().filter_map(|column| of(column, true)).collect();
    let back: Vec<(f64, f64)> = columns().filter_map(|column| of(column, false)).collect();
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
        let around = band(&all);
        assert_eq!(around.len(), 200);
        let (out, back) = around.split_at(100);
        for ((upper, lower), column) in out.iter().zip(back.iter().rev()).zip(all.chunks(40)) {
            assert!(column.iter().all(|place| place.1 >= upper.1 && place.1 <= lower.1));
        }
        assert!(Trace::of(all).is_band && !Trace::of(vec![(0.0, 1.0); 3]).is_band);
        assert!(!Trace::of(Vec::new()).is_band);
    }
}
