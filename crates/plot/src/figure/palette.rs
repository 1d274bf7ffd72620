//! Colours, dashes and symbols that are told apart on light and on dark, and by the colour-blind.

use plotly::common::{DashType, MarkerSymbol};

use crate::colour::{self, DISTINCT};

/// What is neither this nor that: as far from white as from black.
pub(super) const NEUTRAL: &str = "#808080";

/// What warns.
pub(super) const WARNING: &str = DISTINCT[1];

/// The one curve of a diagram.
pub(super) const CURVE: &str = DISTINCT[0];

/// Colour of one of `count` things in a natural order.
pub(super) fn colour(index: usize, count: usize) -> String {
    match DISTINCT.get(index).filter(|_| count <= DISTINCT.len()) {
        Some(colour) => (*colour).to_owned(),
        // Neither the darkest nor the brightest, which a background may have.
        None => colour::hex(colour::level(0.2 + 0.7 * index as f64 / count.saturating_sub(1).max(1) as f64)),
    }
}

/// Dashes to be taken in turn.
pub(super) fn dash(index: usize) -> DashType {
    [DashType::Solid, DashType::Dash, DashType::Dot, DashType::DashDot][index % 4].clone()
}

/// Symbols to be taken in turn, filled or open.
pub(super) fn symbol(index: usize, filled: bool) -> MarkerSymbol {
    use MarkerSymbol::{
        Circle, CircleOpen, Diamond, DiamondOpen, Hexagon, HexagonOpen, Square, SquareOpen, TriangleDown,
        TriangleDownOpen, TriangleUp, TriangleUpOpen,
    };
    let [full, open] = [
        [Circle, CircleOpen],
        [Square, SquareOpen],
        [TriangleUp, TriangleUpOpen],
        [Diamond, DiamondOpen],
        [TriangleDown, TriangleDownOpen],
        [Hexagon, HexagonOpen],
    ][index % 6]
        .clone();
    if filled { full } else { open }
}
