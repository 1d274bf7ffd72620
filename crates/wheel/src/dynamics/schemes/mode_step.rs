//! Numbers of the recursion of a mode.

/// Numbers of one mode's recursion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ModeStep {
    /// Share of the increment that survives a step.
    pub keep: f64,
    /// Displacement per unit force within a step.
    pub receptance: f64,
}

impl ModeStep {
    /// Dissipation c of the energy identity.
    pub fn dissipation(self) -> f64 {
        (1.0 - self.keep) / (1.0 + self.keep)
    }

    /// Inertia 1/B of the energy identity; 0 for a mode that no force moves.
    pub fn inertia(self) -> f64 {
        let b = (1.0 + self.dissipation()) * self.receptance;
        if b > 0.0 { 1.0 / b } else { 0.0 }
    }
}
