//! Frequencies of the reduced model beside those of the full sector.

use super::findings::FrequencyComparison;
use super::reduced::ReducedHarmonic;
use super::speed::FullFrequencies;
use crate::dynamics::modal_wheel::natural_frequencies;

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
