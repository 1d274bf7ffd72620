//! Clearances that close and open while the wheel turns, as they do where casing and wheel warm at different rates.
//!
//! ```text
//! c_k(t) = c_k + s_k Δ(t),   Δ from 0 through the given points, x²(3 − 2x) between two, then the last
//! ```
//!
//! The motion of the wall is prescribed: what it costs is part of the work of contact.

use super::casing::ramp;

/// Change Δ(t) of the clearances, and its share at every contact node.
#[derive(Debug, Clone, PartialEq)]
pub struct ClearanceChange {
    /// Points of the course: revolutions after the start, ascending from above 0, and Δ there, length; negative where clearances close.
    pub course: Vec<(f64, f64)>,
    /// Shares s_k of every contact node; absent: 1.
    pub along_chord: Option<Vec<f64>>,
}

impl ClearanceChange {
    /// Change Δ after `revolutions`.
    pub fn at(&self, revolutions: f64) -> f64 {
        let next = self.course.partition_point(|(instant, _)| *instant <= revolutions);
        let (from, before) = next.checked_sub(1).map_or((0.0, 0.0), |last| self.course[last]);
        match self.course.get(next) {
            Some((to, after)) => before + (after - before) * ramp(revolutions - from, to - from),
            None => before,
        }
    }

    /// Revolutions after which the clearances change no more.
    pub fn ends_after(&self) -> f64 {
        self.course.last().map_or(0.0, |(instant, _)| *instant)
    }

    /// Change s_k Δ at contact node k after the last point.
    pub fn lasting(&self, node: usize) -> f64 {
        self.share(node) * self.course.last().map_or(0.0, |(_, change)| *change)
    }

    /// Largest |Δ| of the course.
    pub(crate) fn largest(&self) -> f64 {
        self.course.iter().fold(0.0, |most, (_, change)| most.max(change.abs()))
    }

    /// Share s_k of contact node k.
    pub(crate) fn share(&self, node: usize) -> f64 {
        self.along_chord.as_ref().map_or(1.0, |along| along[node])
    }
}

/// Change of the gaps by a [`ClearanceChange`], with all that can be known before the loop.
#[derive(Debug)]
pub(crate) struct ClearanceShift {
    change: ClearanceChange,
    /// Shares `[node]`, padded.
    shares: Vec<f64>,
}

impl ClearanceShift {
    /// Prepares the change of `contact_nodes` nodes, padded to `stride`.
    pub(crate) fn new(change: &ClearanceChange, contact_nodes: usize, stride: usize) -> Self {
        let mut shares: Vec<f64> = (0..contact_nodes).map(|node| change.share(node)).collect();
        shares.resize(stride, 0.0);
        Self { change: change.clone(), shares }
    }

    /// Adds the change after `revolutions` to the gaps of all sectors.
    pub(crate) fn add(&self, revolutions: f64, gaps: &mut [f64]) {
        let change = self.change.at(revolutions);
        for sector in gaps.chunks_exact_mut(self.shares.len()) {
            for (gap, share) in sector.iter_mut().zip(&self.shares) {
                *gap += share * change;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn goes_smoothly_through_its_points_and_stays() {
        let change =
            ClearanceChange { course: vec![(2.0, -0.4), (3.0, -0.4), (5.0, 0.1)], along_chord: None };
        let at = [0.0, 1.0, 2.0, 2.5, 3.0, 4.0, 5.0, 99.0].map(|revolutions| change.at(revolutions));
        for (found, expected) in at.into_iter().zip([0.0, -0.2, -0.4, -0.4, -0.4, -0.15, 0.1, 0.1]) {
            assert!((found - expected).abs() < 1e-15, "{at:?}");
        }
        // No corner: as much before a point as behind it, to second order.
        for (instant, value) in change.course.iter().copied().chain([(0.0, 0.0)]) {
            for h in [1e-3, 1e-4] {
                assert!((change.at(instant + h) - value).abs() < 3.0 * h * h);
                assert!((change.at((instant - h).max(0.0)) - value).abs() < 3.0 * h * h);
            }
        }
        let shared = ClearanceChange { along_chord: Some(vec![1.0, -0.5]), ..change.clone() };
        let mut gaps = vec![1.0; 16];
        ClearanceShift::new(&shared, 2, 8).add(4.0, &mut gaps);
        for (found, expected) in gaps.iter().zip([[0.85, 1.075, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0]; 2].concat()) {
            assert!((found - expected).abs() < 1e-15, "{gaps:?}");
        }
        assert_eq!((shared.lasting(0), shared.lasting(1), shared.ends_after()), (0.1, -0.05, 5.0));
        let nothing = ClearanceChange { course: Vec::new(), along_chord: None };
        assert_eq!((nothing.at(3.0), nothing.ends_after(), nothing.lasting(0)), (0.0, 0.0, 0.0));
    }
}
