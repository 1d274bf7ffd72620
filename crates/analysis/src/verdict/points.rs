//! Finished speeds, as verdicts look at them.

use crate::result::{Point, PointStatus};

/// Whether a point has numbers.
pub(super) fn is_completed(point: &Point) -> bool {
    point.status == PointStatus::Completed
}

/// Indices of points, ascending.
pub(super) fn indices<'a>(points: impl Iterator<Item = &'a Point>) -> Vec<u32> {
    let mut all: Vec<u32> = points.map(|point| point.index).collect();
    all.sort_unstable();
    all
}
