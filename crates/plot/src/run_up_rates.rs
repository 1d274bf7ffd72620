//! Largest amplitude of run-ups over their rate: faster runs reach less.

use super::axis::{logarithmic_ticks, significant, ticks};
use super::diagram::Diagram;
use super::marched;
use super::run_up_line::Line;
use super::run_ups_view::View;
use super::svg::{Element, group, line, polyline, text};

const SIZE: (f64, f64) = (180.0, 150.0);

/// Least distance between the labels of rates.
const APART: f64 = 34.0;

/// Draws the largest amplitude of every run over its rate, dots in the colours of the runs; dashed, the largest of the settled speeds of a
/// sweep. None without two different rates.
pub(super) fn panel(
    view: &View<'_>,
    corner: (f64, f64),
    colour: impl Fn(&Line) -> String,
) -> Option<Element> {
    let found: Vec<(&Line, f64, f64)> = view
        .lines
        .iter()
        .filter_map(|line| Some((line, line.rate_rad_s2?, line.largest?.half_peak_to_peak)))
        .filter(|(_, rate, _)| rate.is_finite() && *rate > 0.0)
        .collect();
    let (slowest, fastest) = (found.first()?.1, found.last()?.1);
    if slowest >= fastest {
        return None;
    }
    // Some room beside the first and the last.
    let room = (fastest / slowest).powf(0.08);
    let x = (slowest / room, fastest * room);
    let diagram = Diagram::rightwards_logarithmic(corner, SIZE, x, view.y);
    let places: Vec<(f64, f64)> =
        found.iter().map(|(_, rate, height)| diagram.point(*rate, *height)).collect();
    let dots = found.iter().zip(&places).map(|((line, _, height), (x, y))| {
        let dot = Element::new("circle").number("cx", *x).number("cy", *y).number("r", 3.4);
        let words = format!("{}: {} {}", line.title, significant(*height), view.unit);
        dot.set("class", "rate").set("fill", colour(line)).title(&words)
    });
    let steady = marched::highest(&view.dots).map(|height| {
        let y = diagram.y.place(height);
        let dashes = line((diagram.left, y), (diagram.right(), y)).set("stroke", "#777777");
        group().set("class", "steady").child(dashes.set("stroke-dasharray", "5 4")).child(
            text(diagram.right() - 4.0, y + 13.0, "end", "steady")
                .set("font-size", "11")
                .set("fill", "#777777"),
        )
    });
    let (along, y) = (shown(&diagram), ticks(diagram.y.values, 4.0));
    let drawn = group()
        .child(diagram.background("white"))
        .child(diagram.grid(&along, &y))
        .children(steady)
        .child(polyline(places.iter().copied().map(Some)).set("stroke", "#bbbbbb"))
        .children(dots)
        .child(diagram.frame())
        .child(diagram.x_axis(&along, "rate, rad/s²"))
        .child(diagram.y_axis(&y, "", 0.0))
        .child(
            text(diagram.left, diagram.top - 8.0, "start", "largest of them over the rate")
                .set("fill", "#555555"),
        );
    Some(drawn)
}

/// Ticks of the rates that do not overlap, powers of ten first; where the range holds no tick, its middle.
fn shown(diagram: &Diagram) -> Vec<(f64, String)> {
    let mut ticks = logarithmic_ticks(diagram.x.values);
    let is_power = |rate: f64| (rate.log10() - rate.log10().round()).abs() < 1e-6;
    ticks.sort_by_key(|(rate, _)| !is_power(*rate));
    let (low, high) = diagram.x.values;
    let middle = (low * high).sqrt();
    ticks.push((middle, significant(middle)));
    let mut shown: Vec<(f64, String)> = Vec::new();
    for (rate, words) in ticks {
        let is_apart =
            |(other, _): &(f64, String)| (diagram.x.place(*other) - diagram.x.place(rate)).abs() >= APART;
        let is_needed = rate != middle || shown.is_empty();
        if is_needed && diagram.x.contains(rate) && shown.iter().all(is_apart) {
            shown.push((rate, words));
        }
    }
    shown
}
