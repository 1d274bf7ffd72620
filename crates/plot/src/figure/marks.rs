//! Lines and marks with their words.

use plotly::Scatter;
use plotly::common::{DashType, HoverInfo, Line, Marker, MarkerSymbol, Mode};

use super::text::escaped;

type Places = (Vec<f64>, Vec<f64>);

/// Places as columns; a gap where there is none.
pub(super) fn columns(places: impl IntoIterator<Item = Option<(f64, f64)>>) -> Places {
    places.into_iter().map(|place| place.unwrap_or((f64::NAN, f64::NAN))).unzip()
}

/// A line of this name through places, with gaps where there are none.
pub(super) fn line(
    name: &str,
    places: impl IntoIterator<Item = Option<(f64, f64)>>,
    (colour, dash, width): (&str, DashType, f64),
) -> Box<Scatter<f64, f64>> {
    let (x, y) = columns(places);
    let pen = Line::new().color(colour.to_owned()).dash(dash).width(width);
    Scatter::new(x, y).name(escaped(name)).mode(Mode::Lines).line(pen)
}

/// A line without words under the pointer.
pub(super) fn silent(
    name: &str,
    places: impl IntoIterator<Item = Option<(f64, f64)>>,
    pen: (&str, DashType, f64),
) -> Box<Scatter<f64, f64>> {
    line(name, places, pen).hover_info(HoverInfo::Skip)
}

/// What the pointer shows at each point.
pub(super) fn words(trace: Box<Scatter<f64, f64>>, words: Vec<String>) -> Box<Scatter<f64, f64>> {
    let words = words.iter().map(|words| escaped(words)).collect();
    trace.hover_text_array(words).hover_info(HoverInfo::Text)
}

/// Marks of this name with their words; none where there are no places.
pub(super) fn marks(
    name: &str,
    places: impl IntoIterator<Item = ((f64, f64), String)>,
    (symbol, size, colour): (MarkerSymbol, usize, &str),
) -> Option<Box<Scatter<f64, f64>>> {
    let (places, told): (Vec<(f64, f64)>, Vec<String>) = places.into_iter().unzip();
    let (x, y): Places = places.into_iter().unzip();
    let marker = Marker::new().symbol(symbol).size(size).color(colour.to_owned());
    let trace = Scatter::new(x, y).name(escaped(name)).mode(Mode::Markers).marker(marker);
    (!told.is_empty()).then(|| words(trace, told))
}

/// A template of the words under the pointer, without the name beside it.
pub(super) fn template(words: &str) -> String {
    format!("{words}<extra></extra>")
}

/// Several lines as one, with gaps between them.
pub(super) fn strokes<const N: usize>(
    lines: impl IntoIterator<Item = [(f64, f64); N]>,
) -> impl Iterator<Item = Option<(f64, f64)>> {
    lines.into_iter().flat_map(|line| line.map(Some).into_iter().chain([None]))
}
