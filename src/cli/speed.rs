//! Speeds as arguments.

use std::f64::consts::PI;

/// Reads a speed in rad/s, or in revolutions per minute where the text has that unit.
///
/// # Errors
/// A message for a text that is no number from 0 on.
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
