//! Rounding of numbers for sentences.

/// Rounds a number to four significant digits.
pub(crate) fn short(value: f64) -> f64 {
    format!("{value:.3e}").parse().unwrap_or(value)
}

/// Number with three significant digits.
pub(crate) fn digits(value: f64) -> String {
    let rounded: f64 = format!("{value:.2e}").parse().unwrap_or(value);
    if rounded != 0.0 && !(1e-4..1e6).contains(&rounded.abs()) {
        return format!("{rounded:e}");
    }
    rounded.to_string()
}

/// Whole number in groups of three digits.
pub(crate) fn grouped(value: f64) -> String {
    let whole = format!("{value:.0}");
    let mut text = String::new();
    for (place, digit) in whole.chars().enumerate() {
        if place > 0 && (whole.len() - place).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

/// Share in per cent, with a decimal where it is small.
pub(crate) fn percent(value: f64) -> String {
    if value.abs() < 10.0 { format!("{value:.1} %") } else { format!("{} %", grouped(value)) }
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
