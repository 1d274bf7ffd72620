//! Durations in words.

/// Duration in the unit that people would use.
pub(crate) fn in_words(seconds: f64) -> String {
    let (value, unit) = match seconds {
        seconds if seconds < 99.5 => return format!("{seconds:.0} s"),
        seconds if seconds < 99.5 * 60.0 => (seconds / 60.0, "min"),
        seconds => (seconds / 3600.0, "h"),
    };
    let digits = usize::from(value < 9.95);
    format!("{value:.digits$} {unit}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_duration_has_two_digits_and_its_unit() {
        for (seconds, words) in [
            (0.3, "0 s"),
            (99.4, "99 s"),
            (100.0, "1.7 min"),
            (620.0, "10 min"),
            (6120.0, "1.7 h"),
            (90_000.0, "25 h"),
        ] {
            assert_eq!(in_words(seconds), words, "{seconds}");
        }
    }
}
