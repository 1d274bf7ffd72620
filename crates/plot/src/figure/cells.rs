//! Heat map cells, no more than a screen shows, and their colour bar.

use serde_json::{Value, json};

use super::attributes::{Cells, ColorAxis, ColorBar, Stops, Title};
use super::marks::template;
use super::text::escaped;
use crate::axis::logarithmic_ticks;
use crate::colour::hex;
use crate::sketch::Ramp;

/// Grid of cells in the colours of the axis `coloraxis`; rows from the lowest up, a gap where a value is not a number.
pub(super) fn cells(
    (x, y): (Vec<f64>, Vec<f64>),
    (values, told): (Vec<Vec<f32>>, Vec<Vec<Vec<f32>>>),
    words: &str,
) -> Cells {
    let cells = Cells::default().kind("heatmap").x(x).y(y).z(values).customdata(told).hoverongaps(false);
    cells.hovertemplate(template(words)).coloraxis("coloraxis")
}

/// Left edge of a colour bar, and its lower and upper end, as shares of the width and height of the figure.
type Place = (f64, [f64; 2]);

/// Number of parts of a scale of colours.
const PARTS: u32 = 24;

/// Colours of a scale, as the drawing has them.
pub(super) fn stops(ramp: &Ramp) -> Stops {
    (0..=PARTS)
        .map(|part| f64::from(part) / f64::from(PARTS))
        .map(|share| (share, hex((ramp.colour)(share))))
        .collect()
}

/// Colour axis of a panel; one of logarithms is labelled with the values.
pub(super) fn axis(ramp: &Ramp, place: Place) -> Value {
    let (range, title) = (ramp.range, ramp.title.as_str());
    if !ramp.is_logarithmic {
        return coloured(range, stops(ramp), bar(title, place));
    }
    let (low, high) = range;
    let (values, texts): (Vec<f64>, Vec<String>) =
        logarithmic_ticks((low, high)).into_iter().map(|(value, text)| (value.log10(), text)).unzip();
    let bar = bar(title, place).tickmode("array").tickvals(values).ticktext(texts);
    coloured((low.log10(), high.log10()), stops(ramp), bar)
}

fn coloured((low, high): (f64, f64), stops: Stops, bar: ColorBar) -> Value {
    json!(ColorAxis::default().colorscale(stops).cmin(low).cmax(high).colorbar(bar))
}

fn bar(title: &str, (left, [bottom, top]): Place) -> ColorBar {
    let title = Title::default().text(escaped(title)).side("right");
    let bar = ColorBar::default().title(title).thickness(12.0).lenmode("fraction").len(top - bottom);
    bar.y(0.5 * (bottom + top)).x(left).outlinewidth(0.0)
}
