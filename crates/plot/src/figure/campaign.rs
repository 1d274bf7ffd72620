//! Campaign: severity over speed and a parameter, and the sensitivities of its variance to the parameters.

use serde_json::json;

use super::cells::{MOST, cells as coloured, linear, together};
use super::document::{Figure, axis, speeds};
use super::marks::{bars, marks, silent};
use super::palette::{CURVE, WARNING};
use super::text::escaped;
use crate::campaign::{self as drawing, Row};
use crate::campaign_difference as difference;
use crate::cells::{Cell, cells, extent};
use rubmap_analysis::result::Campaign;

/// Severity of designs over speed and a parameter (by its index), with the value at which the limit is met if that is the parameter asked
/// about, and below it, if there are any, the differences of the compared model, and the sensitivities. Missing results are gaps.
pub(crate) fn campaign(campaign: &Campaign, parameter: usize) -> Figure {
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
    let known = campaign.comparison.as_ref();
    let known = known.map_or_else(Vec::new, |of| difference::known(of, &campaign.speeds_rad_s));
    let Places { high, map, differences, sensitivities } = Places::of(!known.is_empty(), !shown.is_empty());
    let across = |value: f64| [Some((range.0, value)), Some((range.1, value))];
    let met = drawing::met(campaign, parameter);
    let value = met.map(|(value, _)| {
        silent("limit met with the probability asked for", across(value), (WARNING, "solid", 1.6))
    });
    let interval = met.into_iter().flat_map(|(_, ends)| ends).flatten();
    let interval =
        interval.map(|end| silent("its interval", across(end), (WARNING, "dash", 1.2)).showlegend(false));
    let mut figure = Figure::new("campaign", &drawing::title(campaign, parameter), &paragraphs)
        .high(high)
        .with(coloured((x, y), (values, Vec::new()), &told, ("x", "y", "coloraxis")))
        .with_all(value)
        .with_all(interval)
        .axis("xaxis", speeds().range(<[f64; 2]>::from(range)).anchor("y"))
        .axis("yaxis", axis(name).domain([map, 1.0]))
        .attribute(
            "coloraxis",
            linear((0.0, drawing::loudest(campaign)), &drawing::short(campaign), (map, 1.0)),
        )
        .meta("units", json!({"x": "rpm"}))
        .meta("parameter", parameter);
    let bars =
        |errors: Vec<f64>, colour: &'static str| bars().array(errors).color(colour).thickness(1.3).width(4);
    if !known.is_empty() {
        for (verdict, words, colour) in difference::VERDICTS {
            let of_it = || known.iter().filter(move |(_, of)| of.verdict == verdict);
            let places = of_it().map(|(speed, of)| ((*speed, of.mean), difference::told(*speed, of)));
            let reach = of_it().map(|(_, of)| difference::ends(of).1 - of.mean).collect();
            let trace = marks(words, places, ("circle", 7, colour));
            let trace = trace.map(|trace| trace.error_y(bars(reach, colour)).xaxis("x3").yaxis("y3"));
            figure = figure.with_all(trace);
        }
        let words = format!("difference of {}", drawing::short(campaign));
        figure = figure
            .axis("xaxis3", speeds().range(<[f64; 2]>::from(range)).anchor("y3"))
            .axis("yaxis3", axis(&words).domain(differences).anchor("x3"));
    }
    if shown.is_empty() {
        return figure;
    }
    let place = |place: usize| (shown.len() - place) as f64;
    let first =
        shown.iter().enumerate().map(|(at, of)| ((of.first_order, place(at) + 0.12), drawing::told(of)));
    let total = shown.iter().enumerate().map(|(at, of)| ((of.total, place(at) - 0.12), drawing::told(of)));
    let first = marks("alone (first order)", first, ("circle", 9, CURVE))
        .map(|trace| trace.error_x(bars(shown.iter().map(|of| of.first_order_error).collect(), CURVE)));
    let total = marks("with others (total)", total, ("circle-open", 9, CURVE))
        .map(|trace| trace.error_x(bars(shown.iter().map(|of| of.total_error).collect(), CURVE)));
    figure = figure.with_all([first, total].into_iter().flatten().map(|trace| trace.xaxis("x2").yaxis("y2")));
    let names: Vec<String> = shown.iter().map(|of| escaped(&of.parameter)).collect();
    let places: Vec<f64> = (0..shown.len()).map(place).collect();
    figure.axis("xaxis2", axis("share of the variance").anchor("y2")).axis(
        "yaxis2",
        axis("")
            .domain(sensitivities)
            .anchor("x2")
            .range([0.4, shown.len() as f64 + 0.6])
            .tickvals(places)
            .ticktext(names),
    )
}

/// Vertical extents of the parts of the figure, one below the other, as shares of its height from the bottom up.
struct Places {
    /// Height of the figure in pixels.
    high: usize,
    /// Lower end of the map, which reaches to the top.
    map: f64,
    differences: [f64; 2],
    sensitivities: [f64; 2],
}

impl Places {
    /// Height in pixels of the figure with the map alone; `PART`: of a part below it; `WITH_WORDS`: of a part with the words of its axis.
    const MAP: usize = 560;
    const PART: usize = 170;
    const WITH_WORDS: usize = 260;

    fn of(has_differences: bool, has_sensitivities: bool) -> Self {
        let sensitivities = if has_sensitivities { Self::WITH_WORDS } else { 0 };
        let below = sensitivities + if has_differences { Self::WITH_WORDS } else { 0 };
        let high = Self::MAP + below;
        let share = |pixels: usize| pixels as f64 / high as f64;
        Self {
            high,
            map: share(below),
            differences: [share(sensitivities), share(sensitivities + Self::PART)],
            sensitivities: [0.0, share(Self::PART)],
        }
    }
}
