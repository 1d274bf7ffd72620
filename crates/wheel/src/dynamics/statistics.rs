//! Counters of a run.

use rubmap_numerics::complementarity::active_set::PivotStatistics;

/// Work and contact counters of one run.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct RunStatistics {
    /// Number of steps taken.
    pub steps: u64,
    /// Number of steps with at least one contact force.
    pub contact_steps: u64,
    /// Sum of λh over nodes and steps, force·time.
    pub contact_impulse: f64,
    /// Largest penetration left after a step's contact solution, and of the state itself at every sample, length.
    pub largest_penetration: f64,
    /// Smallest multiplier of an active node; none without contact.
    pub smallest_multiplier: Option<f64>,
    /// Largest radial amplitude of any wave of an elastic casing, length.
    pub casing_amplitude: Option<f64>,
    /// Number of contact forces, counted by nodes and steps, under which tips stick; 0 unless the law of friction tells sticking from sliding.
    pub sticking: u64,
    /// Number of contact forces under which tips slide; see [`Self::sticking`].
    pub sliding: u64,
    /// Work of the complementarity solver.
    pub pivots: PivotStatistics,
}

impl RunStatistics {
    /// Share of the steps with a contact force.
    pub fn contact_share(&self) -> f64 {
        if self.steps == 0 { 0.0 } else { self.contact_steps as f64 / self.steps as f64 }
    }
}
