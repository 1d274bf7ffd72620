//! What a reduction is found to be worth.

use serde::{Deserialize, Serialize};

/// The verdict on K(Ω).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum InterpolationVerdict {
    /// One stiffness matrix: nothing to interpolate.
    Absent,
    /// Linear in Ω², as on the undeformed geometry.
    Sound,
    /// K2 does not vanish: a sign of deformed-geometry stiffness; usable with the stated error.
    Suspect,
    /// K(Ω) is indefinite, or the lowest frequencies are not smooth, between the given speeds.
    Unsound,
}

/// What was found about K(Ω).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct InterpolationCheck {
    /// The verdict.
    pub verdict: InterpolationVerdict,
    /// ‖Ω1²K1‖/‖K0‖ (largest entries of the sector's own block).
    pub linear_ratio: f64,
    /// ‖Ω1⁴K2‖/‖K0‖ (largest entries).
    pub quadratic_ratio: f64,
    /// Largest relative deviation, at ¼ and ¾ Ω1, of the lowest frequency of any nodal diameter from the smooth curve
    /// through its values at the given speeds: an estimate of the interpolation error. Infinite where K(Ω) is
    /// indefinite there.
    pub frequency_error: f64,
}

/// Lowest frequencies of one nodal diameter at one speed, full and reduced.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FrequencyComparison {
    /// Nodal diameter i.
    pub harmonic: usize,
    /// Ω, rad/s.
    pub speed_rad_s: f64,
    /// Of the full sector, rad/s, ascending; empty where its K(Ω) is not positive definite.
    pub full: Vec<f64>,
    /// Of the reduced one, as many where it has them.
    pub reduced: Vec<f64>,
}

impl FrequencyComparison {
    /// Largest relative difference and its mode, counted from 0.
    pub fn largest_difference(&self) -> Option<(f64, usize)> {
        let pairs = self.full.iter().zip(&self.reduced).enumerate();
        pairs
            .map(|(mode, (full, reduced))| ((reduced / full - 1.0).abs(), mode))
            .max_by(|a, b| a.0.total_cmp(&b.0))
    }
}
