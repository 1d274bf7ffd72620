//! Peak-to-peak measure of a history.

/// Half the difference of the largest and the smallest value.
pub(super) fn half_peak_to_peak(line: &[f64]) -> f64 {
    let ends = (f64::INFINITY, f64::NEG_INFINITY);
    let (low, high) = line.iter().fold(ends, |(low, high), &x| (low.min(x), high.max(x)));
    0.5 * (high - low)
}
