//! Colours, dashes and symbols that can be distinguished on light and on dark, and by the colour-blind.

use crate::colour::{self, DISTINCT};

/// Neutral grey, as far from white as from black.
pub(super) const NEUTRAL: &str = "#808080";

/// Colour of warnings.
pub(super) const WARNING: &str = DISTINCT[1];

/// Colour of the only curve of a diagram.
pub(super) const CURVE: &str = DISTINCT[0];

/// Colour of one of `count` things in a natural order.
pub(super) fn colour(index: usize, count: usize) -> String {
    match DISTINCT.get(index).filter(|_| count <= DISTINCT.len()) {
        Some(colour) => (*colour).to_owned(),
        // The darkest and the brightest colours are left out: a background may have them.
        None => colour::hex(colour::level(0.2 + 0.7 * index as f64 / count.saturating_sub(1).max(1) as f64)),
    }
}

/// Dashes of the line with this index; they repeat.
pub(super) fn dash(index: usize) -> &'static str {
    ["solid", "dash", "dot", "dashdot"][index % 4]
}
