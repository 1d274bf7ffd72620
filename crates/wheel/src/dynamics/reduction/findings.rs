//! Findings about the quality of a reduction.

use serde::{Deserialize, Serialize};

/// Verdict on K(Ω).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum InterpolationVerdict {
    /// Stiffness at one speed only: nothing to interpolate.
    Absent,
    /// Stiffness linear in Ω², as on the undeformed geometry.
    Sound,
    /// Stiffness whose K2 does not vanish: a sign of deformed-geometry stiffness; usable with the stated error.
    Suspect,
    /// Stiffness K(Ω) that is indefinite, or whose lowest frequencies are not smooth, between the given speeds.
    Unsound,
}

/// Check of K(Ω) between the given speeds.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct InterpolationCheck {
    /// Verdict on K(Ω).
    pub verdict: InterpolationVerdict,
    /// Ratio ‖Ω1²K1‖/‖K0‖ (largest entries of the sector's own block).
    pub linear_ratio: f64,
    /// Ratio ‖Ω1⁴K2‖/‖K0‖ (largest entries).
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
    /// Speed Ω, rad/s.
    pub speed_rad_s: f64,
    /// Frequencies of the full sector, rad/s, ascending; empty where its K(Ω) is not positive definite.
    pub full: Vec<f64>,
    /// Frequencies of the reduced sector, rad/s, as many as of the full one where it has them.
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
