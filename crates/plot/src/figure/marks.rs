//! Traces of lines and marks, and templates of their words.

use super::attributes::{ErrorBars, Scatter};
use super::text::escaped;

/// Trace of this name and mode through points.
pub(super) fn scatter(name: &str, mode: &'static str, (x, y): (Vec<f64>, Vec<f64>)) -> Scatter {
    Scatter::default().kind("scatter").x(x).y(y).name(escaped(name)).mode(mode)
}

/// Error bars without lengths.
pub(super) fn bars() -> ErrorBars {
    ErrorBars::default().kind("data")
}

/// Template of the words under the pointer, without the name of the trace beside them.
pub(super) fn template(words: &str) -> String {
    format!("{words}<extra></extra>")
}
