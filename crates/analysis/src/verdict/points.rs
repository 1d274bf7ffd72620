//! Finished speeds, as verdicts look at them.

use std::collections::BTreeSet;

use crate::result::{Point, PointStatus};

/// Finished speeds of a sweep.
pub(super) struct Finished<'a> {
    pub(super) points: &'a [Point],
    /// Indices of `points`.
    pub(super) indices: BTreeSet<u32>,
    /// Speeds that were completed, in ascending order.
    pub(super) ascending: Vec<&'a Point>,
}

impl<'a> Finished<'a> {
    pub(super) fn of(points: &'a [Point]) -> Self {
        let mut ascending: Vec<&Point> = points.iter().filter(|point| is_completed(point)).collect();
        ascending.sort_by(|a, b| a.speed_rad_s.total_cmp(&b.speed_rad_s));
        Self { points, indices: points.iter().map(|point| point.index).collect(), ascending }
    }

    /// Completed speeds next to a speed, below and above it.
    pub(super) fn beside(&self, speed: f64) -> [Option<&'a Point>; 2] {
        let below = self.ascending.partition_point(|point| point.speed_rad_s < speed);
        let above = self.ascending.partition_point(|point| point.speed_rad_s <= speed);
        let last_below = below.checked_sub(1).and_then(|place| self.ascending.get(place));
        [last_below, self.ascending.get(above)].map(|point| point.copied())
    }
}

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
