//! Largest few of many numbers.

use std::cmp::Ordering;

/// Descending order by value, then ascending by place.
pub(super) fn descending(a: &(f64, usize), b: &(f64, usize)) -> Ordering {
    b.0.total_cmp(&a.0).then(a.1.cmp(&b.1))
}

/// Largest few of some numbers.
pub(super) struct Leaders {
    count: usize,
    /// Values in descending order.
    values: Vec<f64>,
}

impl Leaders {
    pub(super) fn new(count: usize) -> Self {
        Self { count, values: Vec::new() }
    }

    pub(super) fn add(&mut self, value: f64) {
        let place = self.values.partition_point(|&known| known >= value);
        self.values.insert(place, value);
        self.values.truncate(self.count);
    }

    /// Smallest value that is among the largest few.
    pub(super) fn least(&self) -> f64 {
        if self.values.len() < self.count { f64::NEG_INFINITY } else { self.values[self.count - 1] }
    }
}
