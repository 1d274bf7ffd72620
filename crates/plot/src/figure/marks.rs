//! Traces of lines and marks with their words.

use super::attributes::{ErrorBars, Line, Marker, Scatter};
use super::text::escaped;

type Places = (Vec<f64>, Vec<f64>);

/// Splits points into columns of x and y; a gap where a point is missing.
pub(super) fn columns(places: impl IntoIterator<Item = Option<(f64, f64)>>) -> Places {
    places.into_iter().map(|place| place.unwrap_or((f64::NAN, f64::NAN))).unzip()
}

/// Trace of this name and mode through points.
pub(super) fn scatter(name: &str, mode: &'static str, (x, y): Places) -> Scatter {
    Scatter::default().kind("scatter").x(x).y(y).name(escaped(name)).mode(mode)
}

/// Line of this name through points, with gaps where points are missing.
pub(super) fn line(
    name: &str,
    places: impl IntoIterator<Item = Option<(f64, f64)>>,
    (colour, dash, width): (&str, &'static str, f64),
) -> Scatter {
    let pen = Line::default().color(colour).dash(dash).width(width);
    scatter(name, "lines", columns(places)).line(pen)
}

/// Line without words under the pointer.
pub(super) fn silent(
    name: &str,
    places: impl IntoIterator<Item = Option<(f64, f64)>>,
    pen: (&str, &'static str, f64),
) -> Scatter {
    line(name, places, pen).hoverinfo("skip")
}

/// Sets the words that the pointer shows at each point.
pub(super) fn words(trace: Scatter, words: Vec<String>) -> Scatter {
    let words: Vec<String> = words.iter().map(|words| escaped(words)).collect();
    trace.hovertext(words).hoverinfo("text")
}

/// Marks of this name with their words; nothing where there are no marks.
pub(super) fn marks(
    name: &str,
    places: impl IntoIterator<Item = ((f64, f64), String)>,
    (symbol, size, colour): (&'static str, u32, &str),
) -> Option<Scatter> {
    let (places, told): (Vec<(f64, f64)>, Vec<String>) = places.into_iter().unzip();
    let places: Places = places.into_iter().unzip();
    let marker = Marker::default().symbol(symbol).size(f64::from(size)).color(colour);
    let trace = scatter(name, "markers", places).marker(marker);
    (!told.is_empty()).then(|| words(trace, told))
}

/// Error bars without lengths.
pub(super) fn bars() -> ErrorBars {
    ErrorBars::default().kind("data")
}

/// Template of the words under the pointer, without the name of the trace beside them.
pub(super) fn template(words: &str) -> String {
    format!("{words}<extra></extra>")
}

/// Joins several lines into one trace, with gaps between them.
pub(super) fn strokes<const N: usize>(
    lines: impl IntoIterator<Item = [(f64, f64); N]>,
) -> impl Iterator<Item = Option<(f64, f64)>> {
    lines.into_iter().flat_map(|line| line.map(Some).into_iter().chain([None]))
}
