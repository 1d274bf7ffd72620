//! Heat map cells, no more than a screen shows, and their colour bar.

use serde_json::{Value, json};

use super::attributes::{Cells, ColorAxis, ColorBar, Title};
use super::marks::template;
use super::text::escaped;
use crate::axis::logarithmic_ticks;

/// Grid of cells in the colours of the axis `coloraxis`; rows from the lowest up, a gap where a value is not a number.
pub(super) fn cells(
    (x, y): (Vec<f64>, Vec<f64>),
    (values, told): (Vec<Vec<f32>>, Vec<Vec<Vec<f32>>>),
    words: &str,
) -> Cells {
    let cells = Cells::default().kind("heatmap").x(x).y(y).z(values).customdata(told).hoverongaps(false);
    cells.hovertemplate(template(words)).coloraxis("coloraxis")
}

/// Lower and upper end of a colour bar, as shares of the height of the figure.
type Place = (f64, f64);

/// Colour axis for logarithms of amplitudes, labelled with the amplitudes.
pub(super) fn logarithmic((low, high): (f64, f64), title: &str, place: Place) -> Value {
    let (values, texts): (Vec<f64>, Vec<String>) =
        logarithmic_ticks((low, high)).into_iter().map(|(value, text)| (value.log10(), text)).unzip();
    let bar = bar(title, place).tickmode("array").tickvals(values).ticktext(texts);
    coloured((low.log10(), high.log10()), bar)
}

/// Linear colour axis.
pub(super) fn linear(range: (f64, f64), title: &str, place: Place) -> Value {
    coloured(range, bar(title, place))
}

fn coloured((low, high): (f64, f64), bar: ColorBar) -> Value {
    json!(ColorAxis::default().colorscale("Viridis").cmin(low).cmax(high).colorbar(bar))
}

fn bar(title: &str, (bottom, top): Place) -> ColorBar {
    let title = Title::default().text(escaped(title)).side("right");
    let bar = ColorBar::default().title(title).thickness(12.0).lenmode("fraction").len(top - bottom);
    bar.y(0.5 * (bottom + top)).x(1.01).outlinewidth(0.0)
}
