//! Spectrogram of a run.

use std::f64::consts::TAU;

use serde_json::json;

use super::attributes::{Axis, Cells as Trace, Scatter};
use super::cells::{MOST, cells, logarithmic};
use super::document::{Figure, axis, speeds};
use super::marks::{line, marks, silent};
use super::palette::CURVE;
use super::text::escaped;
use crate::cells::rpm;
use crate::spectrogram::{scale, title, words};
use crate::spectrogram_cells::{Cells, Loudest};
use crate::spectrogram_strips::{Strip, strips};
use crate::spectrogram_view::{Over, SpectrogramUnit, View, mean};
use rubmap_analysis::result::RunUps;

/// Height in pixels of the map with one curve above it; `STRIP`: of each further curve.
const HEIGHT: usize = 700;
const STRIP: usize = 140;

/// Spectra of a sensor in the frames of the run of this number, below its amplitude: over the rotational speed if that only rises or only
/// falls, otherwise over time with the speed above.
///
/// The colours of the map are the logarithms of amplitudes to the base of 10; `customdata` holds for every cell the amplitude itself, its
/// frequency in Hz (with frequencies on the vertical axis: its engine order), and the speed in rpm and the time in s of the frame it comes
/// from. `layout.meta.amplitude` says how to show it linearly.
pub(crate) fn spectrogram(run_ups: &RunUps, run: usize, sensor: usize, unit: SpectrogramUnit) -> Figure {
    let title = title(run_ups, run, sensor);
    let view = match View::of(run_ups, run, sensor, unit) {
        Ok(view) => view,
        Err(words) => return Figure::new("spectrogram", &title, &[]).empty(words),
    };
    let length = view.sensor.unit(&run_ups.units);
    let range = scale(&view, (0.0, 1.0)).values;
    let found = Cells::of(&view, MOST);
    let paragraphs: Vec<String> = [words(run_ups, &view)].into_iter().chain(found.thinned.clone()).collect();
    let curves = strips(run_ups, &view, sensor);
    let high = HEIGHT + STRIP * curves.len().saturating_sub(1);
    let share = STRIP as f64 / high as f64;
    let top = 1.0 - share * curves.len() as f64 - 0.02;
    let mut figure = Figure::new("spectrogram", &title, &paragraphs)
        .high(high)
        .with(map(&view, &found, range.0, length))
        .with_all(engine_orders(&view))
        .axis("xaxis", across(view.over).range(<[f64; 2]>::from(view.x)).anchor("y"))
        .axis("yaxis", axis(view.upwards()).range(<[f64; 2]>::from(view.y)).domain([0.0, top]))
        .attribute("coloraxis", logarithmic(range, &format!("amplitude, {length}"), (0.0, top)))
        .meta("sensor", view.sensor)
        .meta("run", view.run.run)
        .meta("units", json!({"x": view.over.unit(), "y": y_unit(unit), "amplitude": length}))
        .meta("amplitude", json!({"z": "log10", "linear": "customdata[row][column][0]", "range": range}));
    for (place, curve) in curves.iter().enumerate() {
        let foot = 1.0 - share * (place + 1) as f64;
        let (short, long) = (format!("y{}", place + 2), format!("yaxis{}", place + 2));
        let upwards = axis(&curve.axis)
            .range(<[f64; 2]>::from(curve.y))
            .domain([foot + 0.02, foot + share])
            .anchor("x");
        figure =
            figure.with_all(strip(curve).into_iter().map(|trace| trace.yaxis(&short))).axis(&long, upwards);
    }
    figure
}

fn across(over: Over) -> Axis {
    match over {
        Over::Speed => speeds(),
        Over::Time => axis(over.axis()),
    }
}

fn y_unit(unit: SpectrogramUnit) -> &'static str {
    match unit {
        SpectrogramUnit::Order => "engine_order",
        SpectrogramUnit::Hz => "Hz",
    }
}

fn map(view: &View<'_>, found: &Cells<'_>, quietest: f64, unit: &str) -> Trace {
    let middle = |(from, to): &(f64, f64)| 0.5 * (from + to);
    let x: Vec<f64> = match found.columns[..] {
        // A single column has its edges: nothing else says how wide it is.
        [(from, to)] => vec![from, to],
        _ => found.columns.iter().map(middle).collect(),
    };
    let y: Vec<f64> = found.rows.iter().map(middle).collect();
    let logarithm = |amplitude: f64| amplitude.max(quietest).log10() as f32;
    let mut values: Vec<Vec<f32>> = Vec::new();
    let mut told: Vec<Vec<Vec<f32>>> = Vec::new();
    for (row, y) in found.values.iter().zip(&y) {
        values
            .push(row.iter().map(|cell| cell.map_or(f32::NAN, |(loudest, _)| logarithm(loudest))).collect());
        let tell = |cell: &Option<Loudest<'_>>| {
            cell.map_or_else(Vec::new, |(amplitude, frame)| {
                let per_order = mean(frame) / TAU;
                let other = match view.unit {
                    SpectrogramUnit::Order => y * per_order,
                    SpectrogramUnit::Hz => y / per_order,
                };
                let [begin, end] = frame.times_s;
                [amplitude, other, rpm(mean(frame)), 0.5 * (begin + end)].map(|value| value as f32).to_vec()
            })
        };
        told.push(row.iter().map(tell).collect());
    }
    let (order, frequency) = match view.unit {
        SpectrogramUnit::Order => ("%{y:.4~g}", "%{customdata[1]:,.1f}"),
        SpectrogramUnit::Hz => ("%{customdata[1]:.3~g}", "%{y:,.1f}"),
    };
    let words = format!(
        "%{{customdata[2]:,.1f}} rpm, at %{{customdata[3]:.4~g}} s<br>engine order {order}, {frequency} Hz<br>%{{customdata[0]:.3~g}} {}",
        escaped(unit)
    );
    cells((x, y), (values, told), &words, ("x", "y", "coloraxis"))
}

/// Traces of the engine orders, those that the lobes excite apart.
fn engine_orders(view: &View<'_>) -> Vec<Scatter> {
    let lines = view.order_lines();
    let some_excited = lines.iter().any(|line| line.excited);
    let of = |excited: bool| {
        let lines = lines.iter().filter(|line| line.excited == excited);
        let places: Vec<_> =
            lines.flat_map(|line| line.places.iter().copied().map(Some).chain([None])).collect();
        let (name, pen) = match excited {
            true => ("engine orders of lobes", ("rgba(176, 176, 176, 0.45)", "solid", 1.0)),
            false if some_excited => ("other engine orders", ("rgba(176, 176, 176, 0.6)", "dot", 1.0)),
            false => ("engine orders", ("rgba(176, 176, 176, 0.6)", "dot", 1.0)),
        };
        (!places.is_empty()).then(|| silent(name, places, pen))
    };
    [false, true].into_iter().filter_map(of).collect()
}

/// Traces of a curve above the map, with its marks.
fn strip(curve: &Strip) -> Vec<Scatter> {
    let places = curve.places.iter().copied().map(Some);
    let drawn = line(&curve.axis, places, (CURVE, "solid", 1.6)).showlegend(false);
    let peaks = marks("largest", curve.marks.iter().cloned(), ("circle", 8, CURVE));
    [drawn].into_iter().chain(peaks.map(|peaks| peaks.showlegend(false))).collect()
}
