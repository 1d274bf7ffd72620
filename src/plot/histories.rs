//! Displacements over the first revolutions, one line per size.

use super::svg;
use crate::analysis::run::Histories;

/// Draws the displacements of one sensor.
pub fn histories(_histories: &Histories, _sensor: usize) -> String {
    svg::document("Histories", 100.0, 100.0, Vec::new())
}
