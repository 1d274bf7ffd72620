//! Speeds of a sweep as dots.

use super::attributes::Scatter;
use super::marks::marks;
use super::palette::NEUTRAL;
use crate::marched::{Dot, KINDS};

/// Traces of the speeds of a sweep: one of those that have settled, one of those that have not.
pub(super) fn dots(dots: &[Dot]) -> Vec<Scatter> {
    let of = |(settled, name): (bool, &str)| {
        let symbol = if settled { "circle" } else { "circle-open" };
        let dots = dots.iter().filter(|dot| dot.settled == settled);
        marks(name, dots.map(|dot| (dot.place, dot.title.clone())), (symbol, 6, NEUTRAL))
    };
    KINDS.into_iter().filter_map(of).collect()
}
