//! Branches of periodic responses.
use super::document::Figure;
use rubmap_analysis::result::{Branches, Point};

/// Shows them.
pub fn branches(_: &Branches, _: usize, _: &[Point]) -> Figure {
    Figure::new("branches", "Branches", &[])
}
