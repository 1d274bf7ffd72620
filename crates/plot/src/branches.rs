//! Branches of periodic responses.
use rubmap_analysis::result::{Branches, Point};

/// Draws them.
pub fn branches(_: &Branches, _: usize, _: &[Point]) -> String {
    super::svg::document("Branches", 100.0, 100.0, Vec::new())
}
