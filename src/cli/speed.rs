//! Speeds as arguments.

use std::f64::consts::PI;

/// A speed in rad/s, or in revolutions per minute where that is said.
///
/// # Errors
/// What is no number from 0 on, in words.
pub(super) fn speed(text: &str) -> Result<f64, String> {
    let text = text.trim();
    let (number, factor) = match text.strip_suffix("rpm") {
        Some(number) => (number, PI / 30.0),
        None => (text.strip_suffix("rad/s").unwrap_or(text), 1.0),
    };
    match number.trim().parse::<f64>() {
        Ok(number) if number.is_finite() && number >= 0.0 => Ok(number * factor),
        _ => Err(format!("\"{text}\" is no speed in rad/s or rpm")),
    }
}
