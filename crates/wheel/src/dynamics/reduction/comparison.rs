//! The reduced model's frequencies beside the full sector's.

use serde::{Deserialize, Serialize};

use super::ReducedHarmonic;
use super::speed::FullFrequencies;
use crate::dynamics::modal_wheel::natural_frequencies;

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

/// Compares every nodal diameter at `speed_rad_s`.
pub(super) fn compare(
    harmonics: &[ReducedHarmonic],
    speed_rad_s: f64,
    full: &FullFrequencies,
) -> Vec<FrequencyComparison> {
    let compare = |(reduced, full): (&ReducedHarmonic, &Option<Vec<f64>>)| {
        let full = full.clone().unwrap_or_default();
        // What the reduced wheel lacks at a speed is told when the speed is asked for.
        let mut found = natural_frequencies(reduced, speed_rad_s, true).unwrap_or_default();
        found.truncate(full.len());
        FrequencyComparison { harmonic: reduced.harmonic, speed_rad_s, full, reduced: found }
    };
    harmonics.iter().zip(full).map(compare).collect()
}
