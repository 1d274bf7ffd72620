//! Heat map cells, no more than a screen shows, and their colour bar.

use plotly::HeatMap;
use plotly::common::{ColorScale, ColorScalePalette, Title};
use serde_json::{Value, json};

use super::document::Cells;
use super::marks::template;
use super::text::escaped;
use crate::axis::logarithmic_ticks;

/// Columns and rows of a figure: about what a screen shows.
pub(super) const MOST: (usize, usize) = (500, 200);

/// Number of neighbouring columns or rows merged into one, so that of `parts` at most `most` are left.
pub(super) fn together(parts: usize, most: usize) -> usize {
    parts.div_ceil(most).max(1)
}

/// Grid of cells in the colours of the axis `coloraxis`; rows from the lowest up, a gap where a value is not a number.
pub(super) fn cells(
    (x, y): (Vec<f64>, Vec<f64>),
    (values, told): (Vec<Vec<f32>>, Vec<Vec<Vec<f32>>>),
    words: &str,
    (x_axis, y_axis, coloraxis): (&str, &str, &'static str),
) -> Box<Cells> {
    let map = HeatMap::new(x, y, values).hover_on_gaps(false).hover_template(template(words));
    let map = *map.x_axis(x_axis).y_axis(y_axis);
    Box::new(Cells { map, coloraxis, customdata: told })
}

/// Lower and upper end of a colour bar, as shares of the height of the figure.
type Place = (f64, f64);

/// Colour axis for logarithms of amplitudes, labelled with the amplitudes.
pub(super) fn logarithmic((low, high): (f64, f64), title: &str, place: Place) -> Value {
    let ticks = logarithmic_ticks((low, high));
    let (values, texts): (Vec<f64>, Vec<&str>) =
        ticks.iter().map(|(value, text)| (value.log10(), text.as_str())).unzip();
    let mut axis = linear((low.log10(), high.log10()), title, place);
    axis["colorbar"]["tickmode"] = json!("array");
    axis["colorbar"]["tickvals"] = json!(values);
    axis["colorbar"]["ticktext"] = json!(texts);
    axis
}

/// Linear colour axis.
pub(super) fn linear((low, high): (f64, f64), title: &str, (bottom, top): Place) -> Value {
    json!({
        "colorscale": ColorScale::Palette(ColorScalePalette::Viridis), "cmin": low, "cmax": high,
        "colorbar": {
            "title": Title::with_text(escaped(title)).side(plotly::common::Side::Right), "thickness": 12, "lenmode": "fraction",
            "len": top - bottom, "y": 0.5 * (bottom + top), "x": 1.01, "outlinewidth": 0,
        },
    })
}
