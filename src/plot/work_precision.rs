//! Error over time of every setting of a study.

use super::svg;
use crate::analysis::accuracy::errors::Quantity;
use crate::analysis::run::WorkPrecision;

/// Draws the errors of one quantity at one speed over computing time.
pub fn work_precision(_study: &WorkPrecision, _speed: usize, _quantity: Quantity) -> String {
    svg::document("Work and precision", 100.0, 100.0, Vec::new())
}
