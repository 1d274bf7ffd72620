//! Spectrogram of a run: spectra over the speed that it passes, or over time.

use super::axis::{Scale, label, logarithmic_ticks, significant, ticks};
use super::cells::rpm;
use super::diagram::Diagram;
use super::key::Flow;
use super::map_view::{QUIETEST, order_stroke};
use super::pixels::Pixels;
use super::run_up_words as told;
use super::spectrogram_cells::Cells;
use super::spectrogram_strips::strips;
use super::spectrogram_view::{OrderLine, SpectrogramUnit, View, mean};
use super::svg::{Element, INK, document, group, line, polyline, rectangle, text, upright};
use super::{colour_bar, hatching, heading};
use rubmap_analysis::result::{RunUpFrame, RunUps};

const WIDTH: f64 = 1180.0;
const LEFT: f64 = 92.0;
const PLOT_WIDTH: f64 = 946.0;
const MAP_HEIGHT: f64 = 520.0;
const STRIP_HEIGHT: f64 = 96.0;
const GAP: f64 = 12.0;

/// Largest number of columns and rows of the image: as many as a reader distinguishes.
const MOST: (usize, usize) = (900, 400);

/// Draws the spectra of a sensor in the frames of the run of this number, below its amplitude: over the rotational speed if that only rises
/// or only falls, otherwise over time with the speed above. Frames without spectra are left out.
///
/// Colour is the amplitude on a logarithmic scale of three decades below the loudest; the mean is left out. Where frames or lines share a
/// cell, the loudest is seen.
pub(super) fn spectrogram(run_ups: &RunUps, run: usize, sensor: usize, unit: SpectrogramUnit) -> String {
    let title = title(run_ups, run, sensor);
    let view = match View::of(run_ups, run, sensor, unit) {
        Ok(view) => view,
        Err(words) => return nothing(&title, words),
    };
    let (heading, bottom) = heading::heading(LEFT, &title, &[words(run_ups, &view)]);
    let strips = strips(run_ups, &view, sensor);
    let top = bottom + 24.0;
    let map_top = top + (STRIP_HEIGHT + GAP) * strips.len() as f64;
    let map = Diagram::new((LEFT, map_top), (PLOT_WIDTH, MAP_HEIGHT), view.x, view.y);
    let amplitudes = scale(&view, (map.bottom(), map.top));
    let mut content = vec![hatching::definition(), heading];
    for (place, strip) in strips.iter().enumerate() {
        let corner = (LEFT, top + (STRIP_HEIGHT + GAP) * place as f64);
        let diagram = Diagram::new(corner, (PLOT_WIDTH, STRIP_HEIGHT), view.x, strip.y);
        content.push(strip.draw(&diagram));
    }
    content.push(map.background(hatching::FILL));
    content.push(image(&view, &map, &amplitudes));
    content.push(orders(&view, &map));
    content.push(map.frame());
    content.push(map.x_axis(&ticks(map.x.values, 9.0), view.over.axis()));
    content.push(map.y_axis(&ticks(map.y.values, 12.0), view.upwards(), 64.0));
    if view.loudest.is_some() {
        let unit = view.sensor.unit(&run_ups.units);
        let ticks = logarithmic_ticks(amplitudes.values);
        content.push(colour_bar::draw(
            &amplitudes,
            map.right() + 58.0,
            &ticks,
            &format!("amplitude, {unit}"),
        ));
    }
    let key = key(&view, &map);
    let height = key.bottom() + 24.0;
    content.push(key.draw());
    document(&title, WIDTH, height, content)
}

/// Draws an empty diagram with a message.
fn nothing(title: &str, words: &str) -> String {
    let (heading, bottom) = heading::heading(LEFT, title, &[]);
    let empty = Diagram::new((LEFT, bottom + 24.0), (PLOT_WIDTH, MAP_HEIGHT), (0.0, 1.0), (0.0, 1.0));
    document(title, WIDTH, empty.bottom() + 24.0, vec![heading, empty.frame(), empty.words(words)])
}

/// Title: the run with its rate, and the sensor.
pub(super) fn title(run_ups: &RunUps, number: usize, sensor: usize) -> String {
    let course = told::course(&run_ups.settings.speed);
    let run = run_ups.runs.iter().find(|run| run.run as usize == number);
    let rate = run.filter(|run| run.rate_rad_s2.is_some()).map(|run| format!(" at {}", told::name(run)));
    let sensor = run_ups.sensors.get(sensor).map_or_else(|| "no such sensor".to_owned(), ToString::to_string);
    format!("Spectrogram of a {course}{}: {sensor}", rate.unwrap_or_default())
}

/// Paragraph below the title: frames, speeds, time.
pub(super) fn words(run_ups: &RunUps, view: &View<'_>) -> String {
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

/// Colour scale; a run without motion is as quiet as the colours go.
pub(super) fn scale(view: &View<'_>, places: (f64, f64)) -> Scale {
    let loudest = view.loudest.unwrap_or(1.0);
    Scale::logarithmic((QUIETEST * loudest, loudest), places)
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

/// Draws engine orders as dotted lines, solid for multiples of the lobe count, with numbers at their right ends where there is room.
fn orders(view: &View<'_>, map: &Diagram) -> Element {
    let mut lines = view.order_lines();
    let clip = "spectrogram";
    let course = |line: &OrderLine| {
        let places = line.places.iter().map(|(x, y)| Some(map.point(*x, *y)));
        order_stroke(polyline(places), line.excited).set("class", "engine-order")
    };
    let drawn = group().set("clip-path", format!("url(#{clip})")).children(lines.iter().map(course));
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
    let title = (view.unit == SpectrogramUnit::Hz && !numbers.is_empty())
        .then(|| upright(map.right() + 38.0, middle, "middle", "engine order k, f = kΩ/2π"));
    let numbers = numbers.into_iter().filter(|_| view.unit == SpectrogramUnit::Hz);
    group().child(map.region(clip)).child(drawn).children(numbers).children(title)
}

fn key(view: &View<'_>, map: &Diagram) -> Flow {
    let mut flow = Flow::new(LEFT, WIDTH - 20.0, map.bottom() + 66.0);
    let lines = view.order_lines();
    let stroke = |excited: bool| {
        let dark = rectangle(0.0, -8.0, 30.0, 16.0).set("fill", "#101010");
        group().child(dark).child(order_stroke(line((3.0, 0.0), (27.0, 0.0)), excited))
    };
    let some_excited = lines.iter().any(|line| line.excited);
    if some_excited {
        flow = flow.entry(stroke(true), 30.0, "multiples of the lobe count");
    }
    if lines.iter().any(|line| !line.excited) {
        let words = if some_excited { "other engine orders" } else { "engine orders" };
        flow = flow.entry(stroke(false), 30.0, words);
    }
    let beyond = |frame: &&RunUpFrame| {
        view.height(view.orders.last().copied().unwrap_or(0.0) + view.run.order_step, mean(frame)) < view.y.1
    };
    if view.frames.iter().any(beyond) {
        flow = flow.entry(hatching::mark(), 20.0, "beyond the spectra");
    }
    flow
}
