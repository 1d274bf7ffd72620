//! Traces of lines and marks with their words.

use plotly::Scatter;
use plotly::common::{DashType, HoverInfo, Line, Marker, MarkerSymbol, Mode};

use super::text::escaped;

/// Trace of points, boxed as the crate makes it.
pub(super) type PointTrace = Box<Scatter<f64, f64>>;

type Places = (Vec<f64>, Vec<f64>);

/// Splits points into columns of x and y; a gap where a point is missing.
pub(super) fn columns(places: impl IntoIterator<Item = Option<(f64, f64)>>) -> Places {
    places.into_iter().map(|place| place.unwrap_or((f64::NAN, f64::NAN))).unzip()
}

/// Line of this name through points, with gaps where points are missing.
pub(super) fn line(
    name: &str,
    places: impl IntoIterator<Item = Option<(f64, f64)>>,
    (colour, dash, width): (&str, DashType, f64),
) -> PointTrace {
    let (x, y) = columns(places);
    let pen = Line::new().color(colour.to_owned()).dash(dash).width(width);
    Scatter::new(x, y).name(escaped(name)).mode(Mode::Lines).line(pen)
}

/// Line without words under the pointer.
pub(super) fn silent(
    name: &str,
    places: impl IntoIterator<Item = Option<(f64, f64)>>,
    pen: (&str, DashType, f64),
) -> PointTrace {
    line(name, places, pen).hover_info(HoverInfo::Skip)
}

/// Sets the words that the pointer shows at each point.
pub(super) fn words(trace: PointTrace, words: Vec<String>) -> PointTrace {
    let words = words.iter().map(|words| escaped(words)).collect();
    trace.hover_text_array(words).hover_info(HoverInfo::Text)
}

/// Marks of this name with their words; nothing where there are no marks.
pub(super) fn marks(
    name: &str,
    places: impl IntoIterator<Item = ((f64, f64), String)>,
    (symbol, size, colour): (MarkerSymbol, usize, &str),
) -> Option<PointTrace> {
    let (places, told): (Vec<(f64, f64)>, Vec<String>) = places.into_iter().unzip();
    let (x, y): Places = places.into_iter().unzip();
    let marker = Marker::new().symbol(symbol).size(size).color(colour.to_owned());
    let trace = Scatter::new(x, y).name(escaped(name)).mode(Mode::Markers).marker(marker);
    (!told.is_empty()).then(|| words(trace, told))
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
