//! Clearances that follow the speed: within a segment of a run-up they go straight from what they are at its beginning to what they are
//! at its end (docs/method.md, Run-up and run-down).

/// What is added to the clearance of every contact node.
#[derive(Debug, Clone, PartialEq)]
pub struct ClearanceDrift {
    /// Revolutions after the start of the run at which it begins and ends.
    pub revolutions: [f64; 2],
    /// Then, length.
    pub first: Vec<f64>,
    /// At the end, length.
    pub last: Vec<f64>,
}

impl ClearanceDrift {
    /// Largest that it adds or takes.
    pub(crate) fn largest(&self) -> f64 {
        self.first.iter().chain(&self.last).fold(0.0, |most, shift| most.max(shift.abs()))
    }

    /// Adds to the gaps of all sectors, their nodes padded to `stride`.
    pub(crate) fn add(&self, revolutions: f64, stride: usize, gaps: &mut [f64]) {
        let [from, to] = self.revolutions;
        let share = ((revolutions - from) / (to - from)).clamp(0.0, 1.0);
        for sector in gaps.chunks_exact_mut(stride) {
            for (gap, (first, last)) in sector.iter_mut().zip(self.first.iter().zip(&self.last)) {
                *gap += first + share * (last - first);
            }
        }
    }
}
