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

    /// Index of the speed at the top of the peak to which a completed speed belongs; its own where the level rises to both sides.
    pub(super) fn summit(&self, index: u32) -> u32 {
        let level = |place: usize| self.ascending[place].tip.map_or(0.0, |tip| tip.rms);
        let higher = |place: usize| {
            let beside = [place.checked_sub(1), Some(place + 1).filter(|&next| next < self.ascending.len())];
            beside.into_iter().flatten().filter(move |&next| level(next) > level(place))
        };
        let Some(mut at) = self.ascending.iter().position(|point| point.index == index) else { return index };
        if higher(at).count() == 2 {
            return index;
        }
        while let Some(next) = higher(at).max_by(|&a, &b| level(a).total_cmp(&level(b))) {
            at = next;
        }
        self.ascending[at].index
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
