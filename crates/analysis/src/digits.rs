//! Rounding of numbers for sentences.

/// Rounds a number to four significant digits.
pub(crate) fn short(value: f64) -> f64 {
    format!("{value:.3e}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn four_digits_whatever_the_size() {
        assert_eq!([0.123_456, -98_765.4, 1e-9 / 3.0, 0.0].map(short), [0.1235, -98_770.0, 3.333e-10, 0.0]);
        assert!(short(f64::NAN).is_nan());
    }
}
