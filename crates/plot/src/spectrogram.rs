//! Spectrogram of a run: spectra over the speed that it passes, or over time.

use std::f64::consts::TAU;

use super::axis::{Scale, label, significant};
use super::cells::rpm;
use super::diagram::Diagram;
use super::drawing::Drawing;
use super::key::MARK_WIDTH;
use super::layer::{self, Band, Course, Curve, Stroke};
use super::map_view::QUIETEST;
use super::pixels::Pixels;
use super::run_up_words as told;
use super::sketch::{Axis, Panel, Sketch};
use super::spectrogram_cells::{Cells, Loudest};
use super::spectrogram_strips::strips;
use super::spectrogram_view::{Over, SpectrogramUnit, View, mean};
use super::style::{Colour, Dash, Pen};
use super::svg::{Element, INK, group, rectangle, text, upright};
use super::{hatching, heading};
use rubmap_analysis::result::{RunUpFrame, RunUps};
use serde_json::json;

const WIDTH: f64 = 946.0;
const STRIP_HEIGHT: f64 = 96.0;
const GAP: f64 = 12.0;

/// Height in pixels of the figure with one curve above the map; `STRIP`: of each further curve.
const HEIGHT: usize = 700;
const STRIP: usize = 140;

/// Largest number of columns and rows of the image; `SHOWN`: of the figure.
const MOST: (usize, usize) = (900, 400);
const SHOWN: (usize, usize) = (500, 200);

/// Spectra of a sensor in the frames of the run of this number, below its amplitude: over the rotational speed if that only rises or only
/// falls, otherwise over time with the speed above. Frames without spectra are left out.
///
/// Colour is the amplitude on a logarithmic scale of three decades below the loudest; the mean is left out. Where frames or lines share a
/// cell, the loudest is seen. In the figure, `customdata` holds for every cell the amplitude itself, its frequency in Hz (with frequencies on
/// the vertical axis: its engine order), and the speed in rpm and the time in s of the frame it comes from. `layout.meta.amplitude` says how
/// to show it linearly.
pub fn spectrogram(run_ups: &RunUps, run: usize, sensor: usize, unit: SpectrogramUnit) -> Drawing<'static> {
    let title = title(run_ups, run, sensor);
    let view = match View::of(run_ups, run, sensor, unit) {
        Ok(view) => view,
        Err(words) => return Sketch::new("spectrogram", title, Vec::new()).nothing(words).into(),
    };
    let length = view.sensor.unit(&run_ups.units);
    let strips = strips(run_ups, &view, sensor);
    let high = HEIGHT + STRIP * strips.len().saturating_sub(1);
    let share = STRIP as f64 / high as f64;
    let mut sketch = Sketch::new("spectrogram", title, vec![words(run_ups, &view)]).high(high);
    let loudest = view.loudest.unwrap_or(1.0);
    let range = (QUIETEST * loudest, loudest);
    let top = sketch.top() + 24.0;
    let corner = (92.0, top + (STRIP_HEIGHT + GAP) * strips.len() as f64);
    let map = Panel::new(corner, (WIDTH, 520.0), across(&view), Axis::linear(view.upwards(), view.y, 12.0));
    let map = map.domain(0.0, 1.0 - share * strips.len() as f64 - 0.02).key_below();
    let mut map = map.amplitudes(format!("amplitude, {length}"), range, Some(58.0));
    sketch.more.extend(fill(&view, &mut map, length));
    sketch = sketch.with(map);
    for (place, strip) in strips.into_iter().enumerate() {
        let corner = (92.0, top + (STRIP_HEIGHT + GAP) * place as f64);
        let foot = 1.0 - share * (place + 1) as f64;
        let panel = strip.panel(across(&view), corner, (WIDTH, STRIP_HEIGHT));
        sketch = sketch.with(panel.domain(foot + 0.02, foot + share));
    }
    let y_unit = if unit == SpectrogramUnit::Order { "engine_order" } else { "Hz" };
    sketch
        .meta("sensor", view.sensor)
        .meta("run", view.run.run)
        .meta("units", json!({"x": view.over.unit(), "y": y_unit, "amplitude": length}))
        .meta("amplitude", json!({"z": "log10", "linear": "customdata[row][column][0]", "range": range}))
        .into()
}

/// Horizontal axis of all panels.
fn across(view: &View<'_>) -> Axis {
    match view.over {
        Over::Speed => Axis::speeds(view.x, 9.0),
        Over::Time => Axis::linear(view.over.axis(), view.x, 9.0),
    }
}

/// Adds the amplitudes, the engine orders and the key; returns words about merged cells.
fn fill(view: &View<'_>, map: &mut Panel, length: &str) -> Option<String> {
    let found = Cells::of(view, SHOWN);
    map.push(hatching::definition());
    map.push(map.diagram.background(hatching::FILL));
    let range = map.ramp.as_ref().map_or((0.0, 1.0), |ramp| ramp.range);
    map.push(image(view, &map.diagram, &Scale::logarithmic(range, (0.0, 1.0))));
    map.push(cells(view, &found, length));
    let lines = orders(view);
    for curve in &lines {
        let dark = rectangle(0.0, -8.0, MARK_WIDTH, 16.0).set("fill", "#101010");
        let words = if curve.name == LOBES { "multiples of the lobe count" } else { &curve.name };
        map.sample(group().child(dark).child(curve.sample()), words);
    }
    // Engine orders that the lobes excite come first in the key.
    map.key.reverse();
    map.layers.extend(lines.into_iter().map(Into::into));
    map.push(numbers(view, &map.diagram));
    let beyond = |frame: &&RunUpFrame| {
        view.height(view.orders.last().copied().unwrap_or(0.0) + view.run.order_step, mean(frame)) < view.y.1
    };
    if view.frames.iter().any(beyond) {
        map.sample(hatching::mark(), "beyond the spectra");
    }
    found.thinned
}

/// Title: the run with its rate, and the sensor.
fn title(run_ups: &RunUps, number: usize, sensor: usize) -> String {
    let course = told::course(&run_ups.settings.speed);
    let run = run_ups.runs.iter().find(|run| run.run as usize == number);
    let rate = run.filter(|run| run.rate_rad_s2.is_some()).map(|run| format!(" at {}", told::name(run)));
    let sensor = run_ups.sensors.get(sensor).map_or_else(|| "no such sensor".to_owned(), ToString::to_string);
    format!("Spectrogram of a {course}{}: {sensor}", rate.unwrap_or_default())
}

/// Paragraph below the title: frames, speeds, time.
fn words(run_ups: &RunUps, view: &View<'_>) -> String {
    let frame = |frame: &&RunUpFrame| frame.speeds_rad_s.map(|speed| label(rpm(speed), 0));
    let mut words = vec![told::of_frames(view.frames.len(), &run_ups.settings)];
    if let Some((first, last)) = view.frames.first().zip(view.frames.last()) {
        let (from, to) = (&frame(first)[0], &frame(last)[1]);
        let time = significant(last.times_s[1] - first.times_s[0]);
        words.push(format!("from {from} to {to} rpm in {time} s"));
    }
    words.push(format!(
        "a line every {} engine orders",
        label(view.run.order_step, 3).trim_end_matches('0').trim_end_matches('.')
    ));
    if view.run.end.is_none() {
        words.push("still running, or stopped".to_owned());
    }
    words.push(heading::origin(&run_ups.settings.sweep.model, &run_ups.version));
    words.join(" · ")
}

/// Cells of the figure with their numbers.
fn cells(view: &View<'_>, found: &Cells<'_>, unit: &str) -> layer::Cells {
    let band = |(from, to): &(f64, f64)| Band { from: *from, to: *to, value: 0.5 * (from + to) };
    let rows: Vec<Band> = found.rows.iter().map(band).collect();
    let tell = |y: f64, cell: &Option<Loudest<'_>>| {
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
    let both = || found.values.iter().zip(&rows);
    let (order, frequency) = match view.unit {
        SpectrogramUnit::Order => ("%{y:.4~g}", "%{customdata[1]:,.1f}"),
        SpectrogramUnit::Hz => ("%{customdata[1]:.3~g}", "%{y:,.1f}"),
    };
    layer::Cells {
        columns: found.columns.iter().map(band).collect(),
        values: both().map(|(row, _)| row.iter().map(|cell| Some(cell.as_ref()?.0)).collect()).collect(),
        data: both().map(|(row, y)| row.iter().map(|cell| tell(y.value, cell)).collect()).collect(),
        hover: vec![
            "%{customdata[2]:,.1f} rpm, at %{customdata[3]:.4~g} s".to_owned(),
            format!("engine order {order}, {frequency} Hz"),
            format!("%{{customdata[0]:.3~g}} {unit}"),
        ],
        rows,
        has_speeds: false,
        merged: "",
    }
}

fn image(view: &View<'_>, map: &Diagram, amplitudes: &Scale) -> Element {
    let cells = Cells::of(view, MOST);
    let mut pixels = Pixels::over(map);
    for (row, band) in cells.values.iter().zip(&cells.rows) {
        // The mean is left out, and the lowest line reaches over it.
        let foot = if *band == cells.rows[0] { 0.0 } else { band.0 };
        let y = (map.y.place(band.1), map.y.place(foot));
        for (found, column) in row.iter().zip(&cells.columns) {
            let Some((amplitude, _)) = found else { continue };
            let x = (map.x.place(column.0), map.x.place(column.1));
            pixels.paint_area(x, y, amplitudes.share(amplitude.max(f64::MIN_POSITIVE)));
        }
    }
    pixels.draw()
}

/// Name of the engine orders that the lobes excite.
const LOBES: &str = "engine orders of lobes";

/// Engine orders, those that the lobes excite apart.
fn orders(view: &View<'_>) -> Vec<Curve> {
    let lines = view.order_lines();
    let others = if lines.iter().any(|line| line.excited) { "other engine orders" } else { "engine orders" };
    let curve = |is_excited: bool| {
        let here = lines.iter().filter(|line| line.excited == is_excited);
        let strokes = here.map(|line| Stroke {
            places: line.places.iter().copied().map(Some).collect(),
            title: String::new(),
        });
        let (name, dash, opacity) =
            if is_excited { (LOBES, Dash::Solid, "0.45") } else { (others, Dash::Dotted, "0.6") };
        let [paper, screen] = ["255, 255, 255", "176, 176, 176"].map(|rgb| format!("rgba({rgb}, {opacity})"));
        let pen = Pen::new(Colour { paper, screen }, dash, 1.0);
        Curve::of(name, strokes, pen).course(Course::Cut).class("engine-order")
    };
    [false, true].map(curve).into_iter().filter(|curve| !curve.strokes.is_empty()).collect()
}

/// Numbers of the engine orders at their right ends, where there is room and frequencies are on the vertical axis.
fn numbers(view: &View<'_>, map: &Diagram) -> Element {
    if view.unit == SpectrogramUnit::Order {
        return group();
    }
    let mut lines = view.order_lines();
    // Engine orders that the lobes excite have the first choice of room.
    lines.sort_by_key(|line| !line.excited);
    let mut taken: Vec<f64> = Vec::new();
    let numbers = lines.iter().filter_map(|line| {
        let (x, y) = line.places.last().map(|(x, y)| map.point(*x, *y))?;
        let is_free =
            map.encloses((x.min(map.right()), y)) && taken.iter().all(|other| (other - y).abs() >= 13.0);
        taken.extend(is_free.then_some(y));
        let number = text(map.right() + 6.0, y + 4.0, "start", &line.order.to_string())
            .set("class", "right-axis")
            .set("font-size", "11")
            .set("font-weight", if line.excited { "bold" } else { "normal" })
            .set("fill", if line.excited { INK } else { "#777777" });
        is_free.then_some(number)
    });
    let numbers: Vec<Element> = numbers.collect();
    let middle = map.top + 0.5 * map.height;
    let title = upright(map.right() + 38.0, middle, "middle", "engine order k, f = kΩ/2π");
    let title = (!numbers.is_empty()).then_some(title);
    group().children(numbers).children(title)
}
