//! Clearances that follow the speed: within a segment of a run-up they go straight from their values at its beginning to those at its end
//! (docs/method.md, Run-up and run-down).
//!
//! A negative clearance presses by as much as the casing has grown: c as long as it is positive, otherwise c times the growth of the restriction.

/// Clearances of every contact node, lengths; negative ones press.
#[derive(Debug, Clone, PartialEq)]
pub struct ClearanceDrift {
    /// Revolutions after the start of the run at which the segment begins and ends.
    pub revolutions: [f64; 2],
    /// Clearances of the casing without the drift.
    pub without: Vec<f64>,
    /// Clearances at the beginning of the segment.
    pub first: Vec<f64>,
    /// Clearances at the end of the segment.
    pub last: Vec<f64>,
}

impl ClearanceDrift {
    /// Largest change of a clearance against the casing without the drift.
    pub(crate) fn largest(&self) -> f64 {
        let off = |ends: &[f64]| {
            ends.iter().zip(&self.without).map(|(end, without)| (end - without).abs()).fold(0.0, f64::max)
        };
        off(&self.first).max(off(&self.last))
    }

    /// Adds the drift to the gaps of all sectors, their nodes padded to `stride`, of a restriction that has grown to the share `growth`.
    pub(crate) fn add(&self, revolutions: f64, growth: f64, stride: usize, gaps: &mut [f64]) {
        let [from, to] = self.revolutions;
        let share = ((revolutions - from) / (to - from)).clamp(0.0, 1.0);
        let grown = |clearance: f64| if clearance >= 0.0 { clearance } else { clearance * growth };
        let ends = || self.first.iter().zip(&self.last).zip(&self.without);
        for sector in gaps.chunks_exact_mut(stride) {
            for (gap, ((first, last), without)) in sector.iter_mut().zip(ends()) {
                *gap += grown(first + share * (last - first)) - grown(*without);
            }
        }
    }
}
