//! A campaign: severity over speed and a parameter, and what its variance comes from.

use plotly::common::{DashType, ErrorData, ErrorType, MarkerSymbol};
use serde_json::json;

use super::cells::{MOST, cells as coloured, linear, together};
use super::document::{Figure, axis, speeds};
use super::interaction_map::ends;
use super::marks::{marks, silent};
use super::palette::{CURVE, WARNING};
use super::text::escaped;
use crate::campaign::{self as drawing, Row};
use crate::cells::{Cell, cells, extent};
use rubmap_analysis::result::Campaign;

/// The severity of designs over speed and a parameter (by its index), with the value at which the limit is met if that is the parameter
/// asked about, and below it the sensitivities if there are any. What has no result is a gap.
pub fn campaign(campaign: &Campaign, parameter: usize) -> Figure {
    let (rows, cells) = (drawing::rows(campaign, parameter), cells(&campaign.speeds_rad_s));
    let (wide, high) = (together(cells.len(), MOST.0), together(rows.len(), MOST.1));
    let (columns, bands): (Vec<&[Cell]>, Vec<&[Row]>) =
        (cells.chunks(wide).collect(), rows.chunks(high).collect());
    let worst = |band: &[Row], column: &[Cell]| {
        let all = band.iter().flat_map(|row| column.iter().filter_map(|cell| row.by_speed[cell.index]));
        all.max_by(f64::total_cmp).map_or(f32::NAN, |severity| severity as f32)
    };
    let values: Vec<Vec<f32>> =
        bands.iter().map(|band| columns.iter().map(|column| worst(band, column)).collect()).collect();
    let x = columns.iter().map(|column| column[column.len() / 2].rpm).collect();
    let y = bands.iter().map(|band| band[band.len() / 2].value).collect();
    let name = drawing::name(campaign, parameter);
    let told = format!(
        "%{{x:,.1f}} rpm<br>{} %{{y:.4~g}}<br>{}: %{{z:.4~g}}",
        escaped(name),
        escaped(&drawing::short(campaign))
    );
    let mut paragraphs = drawing::words(campaign, parameter);
    paragraphs.extend((wide * high > 1).then(|| "neighbours are one cell with the most severe".to_owned()));
    let range = extent(&cells);
    let shown = drawing::shown(campaign);
    let floor = if shown.is_empty() { 0.0 } else { 0.45 };
    let across = |value: f64| [Some((range.0, value)), Some((range.1, value))];
    let met = drawing::met(campaign, parameter);
    let value = met.map(|(value, _)| {
        silent("limit met with the probability asked for", across(value), (WARNING, DashType::Solid, 1.6))
    });
    let interval = met.into_iter().flat_map(|(_, ends)| ends).flatten();
    let interval = interval
        .map(|end| silent("its interval", across(end), (WARNING, DashType::Dash, 1.2)).show_legend(false));
    let mut figure = Figure::new("campaign", &drawing::title(campaign, parameter), &paragraphs)
        .high(if shown.is_empty() { 560 } else { 820 })
        .with(coloured((x, y), (values, Vec::new()), &told, ("x", "y", "coloraxis")))
        .with_all(value)
        .with_all(interval)
        .axis("xaxis", speeds().range(ends(range)).anchor("y"))
        .axis("yaxis", axis(name).domain(&[floor, 1.0]))
        .attribute(
            "coloraxis",
            linear((0.0, drawing::loudest(campaign)), &drawing::short(campaign), (floor, 1.0)),
        )
        .meta("units", json!({"x": "rpm"}))
        .meta("parameter", parameter);
    if shown.is_empty() {
        return figure;
    }
    let bars =
        |errors: Vec<f64>| ErrorData::new(ErrorType::Data).array(errors).color(CURVE).thickness(1.3).width(4);
    let place = |place: usize| (shown.len() - place) as f64;
    let first =
        shown.iter().enumerate().map(|(at, of)| ((of.first_order, place(at) + 0.12), drawing::told(of)));
    let total = shown.iter().enumerate().map(|(at, of)| ((of.total, place(at) - 0.12), drawing::told(of)));
    let first = marks("alone (first order)", first, (MarkerSymbol::Circle, 9, CURVE))
        .map(|trace| trace.error_x(bars(shown.iter().map(|of| of.first_order_error).collect())));
    let total = marks("with others (total)", total, (MarkerSymbol::CircleOpen, 9, CURVE))
        .map(|trace| trace.error_x(bars(shown.iter().map(|of| of.total_error).collect())));
    figure =
        figure.with_all([first, total].into_iter().flatten().map(|trace| trace.x_axis("x2").y_axis("y2")));
    let names: Vec<String> = shown.iter().map(|of| escaped(&of.parameter)).collect();
    let places: Vec<f64> = (0..shown.len()).map(place).collect();
    figure.axis("xaxis2", axis("share of the variance").anchor("y2")).axis(
        "yaxis2",
        axis("")
            .domain(&[0.0, 0.3])
            .anchor("x2")
            .range(vec![0.4, shown.len() as f64 + 0.6])
            .tick_values(places)
            .tick_text(names),
    )
}
