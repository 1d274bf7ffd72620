//! Cutting of runs into segments of one speed.

use crate::resolved::ResolvedRunUps;
use rubmap_wheel::dynamics::run_up::segments::Cutting;

/// Ratio of the highest to the lowest speed of a band, for which scheme and step are chosen once.
pub(crate) const BAND_RATIO: f64 = std::f64::consts::SQRT_2;

/// Most segments of constant speed in a run.
const SEGMENTS: usize = 200_000;

/// Cutting of a run of this number of revolutions into segments.
pub(crate) fn cutting(asked: &ResolvedRunUps, revolutions: f64, samples_per_revolution: usize) -> Cutting {
    Cutting {
        samples_per_revolution,
        tolerance_rad: asked.angle_tolerance_rad,
        frame_revolutions: asked.frame_revolutions(revolutions),
        band_ratio: BAND_RATIO,
        most_segments: SEGMENTS,
    }
}
