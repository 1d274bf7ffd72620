//! Drawings and figures of run-ups.

use roxmltree::Document;
use serde_json::{Value, json};

use super::drawings::key;
use super::figures::{numbers, trace};
use super::passed::{many_rates, passed, stayed, through_points};
use super::pens::figure;
use super::pens::svg::{run_ups, spectrogram};
use super::{corners, is_near, level, number, of_class, rad_s, tick};
use crate::SpectrogramUnit;
use rubmap_analysis::result::RunUps;

const UNITS: [SpectrogramUnit; 2] = [SpectrogramUnit::Order, SpectrogramUnit::Hz];

/// Positions of the rings of the largest amplitudes, the highest first.
fn peaks(read: &Document) -> Vec<(f64, f64)> {
    let mut places: Vec<_> =
        of_class(read, "peak").map(|ring| (number(ring, "cx"), number(ring, "cy"))).collect();
    places.sort_by(|a, b| a.1.total_cmp(&b.1));
    places
}

#[test]
fn every_run_is_a_line_and_speeds_of_a_sweep_are_dots() {
    let of = passed(&[400.0, 5.0, 50.0], true);
    let drawing = run_ups(&of, 0, &stayed());
    let read = Document::parse(&drawing).unwrap();
    assert_eq!(of_class(&read, "run").count(), 3);
    assert_eq!(
        key(&drawing),
        [
            "5 rad/s²",
            "50 rad/s²",
            "400 rad/s²",
            "largest half peak-to-peak",
            "something touches",
            "speed of the sweep",
            "the same, not settled"
        ],
        "the slowest first"
    );
    // One speed has no result.
    assert_eq!(of_class(&read, "marched").count(), 21);
    assert!(drawing.contains("5 rad/s² (47.7 rpm/s)"));
    let alone = run_ups(&passed(&[400.0], true), 0, &[]);
    assert_eq!(key(&alone), ["400 rad/s²", "largest half peak-to-peak"]);
}

/// Corners of lines are speeds and amplitudes of frames.
#[test]
fn lines_go_through_their_frames() {
    let of = passed(&[400.0], true);
    let drawing = run_ups(&of, 0, &[]);
    let read = Document::parse(&drawing).unwrap();
    let line = of_class(&read, "run").next().unwrap();
    let (left, right) = (tick(&read, "5,000"), tick(&read, "7,000"));
    let (low, high) = (level(&read, "0.05"), level(&read, "0.20"));
    let frames = &of.runs[0].frames;
    assert_eq!(corners(line).len(), frames.len());
    for ((x, y), frame) in corners(line).into_iter().zip(frames) {
        let speed = 0.5 * (frame.speeds_rad_s[0] + frame.speeds_rad_s[1]);
        let along = (speed - rad_s(5_000.0)) / rad_s(2_000.0);
        assert!(is_near(x, left + along * (right - left)), "{x}");
        let up = (frame.half_peak_to_peak[0] - 0.05) / 0.15;
        assert!(is_near(y, low + up * (high - low)), "{y}");
    }
}

/// Faster runs reach less, and past the critical speed: above it on the way up, below it on the way down.
#[test]
fn the_rate_lowers_and_moves_the_peak() {
    for (upwards, side) in [(true, 1.0), (false, -1.0)] {
        let of = passed(&[5.0, 50.0, 200.0], upwards);
        let drawing = run_ups(&of, 0, &stayed());
        let read = Document::parse(&drawing).unwrap();
        let (critical, found) = (tick(&read, "6,000"), peaks(&read));
        assert!(found.windows(2).all(|pair| pair[0].1 < pair[1].1 - 20.0), "{found:?}");
        assert!(found.iter().all(|peak| side * (peak.0 - critical) > 0.0), "{critical} {found:?}");
        let rates: Vec<_> =
            of_class(&read, "rate").map(|dot| (number(dot, "cx"), number(dot, "cy"))).collect();
        assert!(rates.windows(2).all(|pair| pair[0].0 < pair[1].0 && pair[0].1 < pair[1].1), "{rates:?}");
        assert_eq!((rates.len(), of_class(&read, "steady").count()), (3, 1));
        assert!(drawing.contains(if upwards { "Run-ups" } else { "Run-downs" }));
    }
}

#[test]
fn many_runs_have_a_short_key() {
    let drawing = run_ups(&passed(&many_rates(), true), 0, &[]);
    assert_eq!(of_class(&Document::parse(&drawing).unwrap(), "run").count(), 40);
    let key = key(&drawing);
    assert_eq!(key.iter().filter(|words| words.ends_with("rad/s²")).count(), 12);
    assert!(
        key[0] == "20 rad/s²" && key[11] == "576 rad/s²" && key[12] == "and 28 more runs between",
        "{key:?}"
    );
    let figure = json!(figure::run_ups(&passed(&many_rates(), true), 0, &[]));
    let listed = figure["data"].as_array().unwrap().iter();
    let listed = listed.filter(|trace| {
        trace["mode"] == "lines"
            && trace["name"] != "something touches"
            && trace["showlegend"] != json!(false)
    });
    assert_eq!(listed.count(), 12);
}

#[test]
fn what_must_be_known_stands_below_the_title() {
    let mut of = json!(passed(&[50.0, 400.0], true));
    of["complete"] = json!(false);
    of["runs"][1]["end"]["message"] = json!("it ends at its <largest> displacement");
    of["passing"] =
        json!({"limit": 0.3, "message": "the limit is kept from a rate between 50 and 400 rad/s² on"});
    of["settings"]["limit"] = json!(0.3);
    let of: RunUps = serde_json::from_value(of).unwrap();
    let (drawing, figure) = (run_ups(&of, 0, &[]), json!(figure::run_ups(&of, 0, &[])).to_string());
    for words in [
        "still running, or stopped",
        "limit 0.300 mm",
        "between 50 and 400",
        "400 rad/s²: it ends at its &lt;largest&gt;",
    ] {
        assert!(drawing.contains(words), "{words}");
        let broken = figure.replace("<br>", " ");
        assert!(broken.contains(words), "{words}: {broken}");
    }
}

/// Lines of engine order 8 are at its order or its frequency at every speed, and the mode rings at 400 Hz.
#[test]
fn engine_orders_fan_out_over_hz() {
    let of = passed(&[50.0], true);
    let cells = |unit| json!(figure::spectrogram(&of, 0, 0, unit))["data"][0].clone();
    let loudest = |cells: &Value, column: usize, (low, high): (f64, f64)| {
        let y = numbers(&cells["y"]);
        let z = |row: usize| cells["z"][row][column].as_f64().unwrap_or(f64::NEG_INFINITY);
        let rows = (0..y.len()).filter(|row| (low..high).contains(&y[*row]));
        let most = rows.clone().map(z).fold(f64::NEG_INFINITY, f64::max);
        let all: Vec<f64> = rows.filter(|row| z(*row) == most).map(|row| y[row]).collect();
        all.iter().sum::<f64>() / all.len() as f64
    };
    let (order, hz) = (cells(SpectrogramUnit::Order), cells(SpectrogramUnit::Hz));
    let rpm = numbers(&order["x"]);
    assert!(rpm.len() > 50 && rpm == numbers(&hz["x"]));
    for column in [0, 20, rpm.len() - 1] {
        let turned = rpm[column] / 60.0;
        assert_eq!(loudest(&order, column, (7.0, 9.0)), 8.0);
        assert!((loudest(&hz, column, (7.0 * turned, 9.0 * turned)) - 8.0 * turned).abs() < 5.0);
    }
    let told = numbers(&hz["customdata"][53][rpm.len() / 2]);
    assert!((told[1] * told[2] / 60.0 - numbers(&hz["y"])[53]).abs() < 0.01, "{told:?}");
    let ends = |unit| {
        let drawing = spectrogram(&of, 0, 0, unit);
        let read = Document::parse(&drawing).unwrap();
        let lines: Vec<_> = of_class(&read, "engine-order").map(corners).collect();
        lines.into_iter().map(|line| (line[0].1, line[line.len() - 1].1)).collect::<Vec<_>>()
    };
    assert!(ends(SpectrogramUnit::Order).iter().all(|(from, to)| from == to));
    let (slow, fast) = (4_500.0, of.runs[0].frames.iter().rfind(|frame| !frame.spectra.is_empty()).unwrap());
    let ratio = fast.speeds_rad_s[1] / rad_s(slow);
    let mut rises = ends(SpectrogramUnit::Hz);
    rises.sort_by(|a, b| b.0.total_cmp(&a.0));
    assert_eq!(rises.len(), 12);
    let foot = rises[0].0 + (rises[0].0 - rises[1].0);
    assert!(rises.iter().all(|(from, to)| ((foot - to) / (foot - from) - ratio).abs() < 1e-3), "{rises:?}");
}

/// Mean values, 0.4 here, are neither shown nor set the scale.
#[test]
fn the_mean_is_left_out() {
    let figure = json!(figure::spectrogram(&passed(&[400.0], true), 0, 0, SpectrogramUnit::Order));
    let loudest = figure["layout"]["meta"]["amplitude"]["range"][1].as_f64().unwrap();
    assert!((0.1..0.3).contains(&loudest), "{loudest}");
    assert_eq!(numbers(&figure["data"][0]["y"])[0], 0.25);
}

/// Spectrograms are over the speed as long as it does not turn back, even if it is held; otherwise over time, with the speed above.
#[test]
fn a_speed_that_turns_back_is_drawn_over_time() {
    let units = |of: &RunUps| {
        json!(figure::spectrogram(of, 0, 0, SpectrogramUnit::Order))["layout"]["meta"]["units"]["x"].clone()
    };
    assert_eq!(units(&through_points()), "s");
    assert_eq!(units(&passed(&[50.0], false)), "rpm");
    let mut held = passed(&[50.0], true);
    let first = held.runs[0].frames[0].clone();
    let mut still = first.clone();
    still.speeds_rad_s = [first.speeds_rad_s[0]; 2];
    held.runs[0].frames.splice(0..0, vec![still.clone(); 40]);
    assert_eq!(units(&held), "rpm");
    let x = numbers(&json!(figure::spectrogram(&held, 0, 0, SpectrogramUnit::Hz))["data"][0]["x"]);
    assert!(x.windows(2).all(|pair| pair[0] < pair[1]), "{x:?}");
    held.runs[0].frames = vec![still.clone(), still];
    assert_eq!(units(&held), "s");
    let drawing = spectrogram(&through_points(), 0, 0, SpectrogramUnit::Hz);
    let read = Document::parse(&drawing).unwrap();
    assert_eq!(of_class(&read, "curve").count(), 2);
    assert!(drawing.contains("Ω, rpm") && !drawing.contains("rotational speed"));
}

fn all(of: &RunUps) -> Vec<String> {
    let mut all = Vec::new();
    for sensor in [0, 1, 9] {
        all.extend([
            run_ups(of, sensor, &stayed()),
            json!(figure::run_ups(of, sensor, &stayed())).to_string(),
        ]);
        for (run, unit) in [0, 7].into_iter().flat_map(|run| UNITS.map(|unit| (run, unit))) {
            all.push(spectrogram(of, run, sensor, unit));
            all.push(json!(figure::spectrogram(of, run, sensor, unit)).to_string());
        }
    }
    all
}

#[test]
fn runs_of_next_to_nothing_are_drawings() {
    let whole = passed(&[400.0], true);
    let mut odd = vec![whole.clone(); 4];
    odd[0].runs.clear();
    odd[1].runs[0].frames.clear();
    odd[2].runs[0].frames.truncate(1);
    odd[3].runs[0].frames.iter_mut().for_each(|frame| frame.spectra.clear());
    for scale in [0.0, 1e-320, 1e-300, 1e150, 1e307] {
        let mut scaled = whole.clone();
        for frame in &mut scaled.runs[0].frames {
            let rows = frame.spectra.iter_mut().chain([&mut frame.half_peak_to_peak]);
            rows.for_each(|row| row.iter_mut().for_each(|amplitude| *amplitude *= scale));
        }
        odd.push(scaled);
    }
    let mut narrow = whole.clone();
    narrow.runs[0].order_step = 1.0;
    narrow.runs[0]
        .frames
        .iter_mut()
        .for_each(|frame| frame.spectra.iter_mut().for_each(|row| row.truncate(1)));
    odd.push(narrow);
    let mut still = whole;
    for frame in &mut still.runs[0].frames {
        (frame.speeds_rad_s, frame.times_s) = ([0.0; 2], [0.0; 2]);
    }
    odd.push(still);
    for (index, of) in odd.iter().enumerate() {
        for drawing in all(of) {
            let is_drawing = drawing.starts_with("<?xml");
            assert!(!is_drawing || Document::parse(&drawing).is_ok(), "{index}");
            let places =
                drawing.split("data:image").map(|part| part.split_once('"').map_or(part, |split| split.1));
            let written = drawing.split("data:image").next().into_iter().chain(places.skip(1));
            assert!(
                written.into_iter().all(|part| !part.contains("NaN") && !part.contains("\"inf")),
                "{index}"
            );
        }
    }
    let words = |of: &RunUps, run, sensor| spectrogram(of, run, sensor, SpectrogramUnit::Hz);
    assert!(
        words(&odd[2], 0, 9).contains("there is no such sensor")
            && words(&odd[2], 7, 0).contains("no such run")
    );
    assert!(words(&odd[3], 0, 0).contains("no frame of this run has a spectrum"));
    assert!(run_ups(&odd[1], 0, &[]).contains("no frame of a run can be drawn"));
}

#[test]
fn the_same_run_ups_are_the_same_drawings() {
    let of = passed(&[50.0, 400.0], true);
    assert_eq!(all(&of), all(&of.clone()));
}

/// Runs of many frames, or many lines, still show their single largest amplitude.
#[test]
fn long_runs_make_no_large_drawings() {
    for (frames, lines) in [(10_000, 201), (60, 8_001)] {
        let frame = |k: usize| {
            let at = |k: usize| rad_s(1_000.0) + 0.05 * k as f64;
            let mut row = vec![1e-3; lines];
            if k == frames / 3 {
                row[lines / 2] = 0.7;
            }
            json!({"revolution": 8 * k, "times_s": [k, k + 1], "speeds_rad_s": [at(k), at(k + 1)], "largest": [1.0],
                "half_peak_to_peak": [if k == frames / 3 { 0.9 } else { 0.1 }], "contact_share": 0.0, "spectra": [row]})
        };
        let mut long = passed(&[400.0], true);
        let all: Vec<Value> = (0..frames).map(frame).collect();
        long.runs[0].frames = serde_json::from_value(json!(all)).unwrap();
        for unit in UNITS {
            assert!(spectrogram(&long, 0, 0, unit).len() < 1 << 20);
            let figure = json!(figure::spectrogram(&long, 0, 0, unit));
            assert!(figure.to_string().len() < 12 << 20);
            let cells = &figure["data"][0];
            let (x, y) = (numbers(&cells["x"]), numbers(&cells["y"]));
            assert!(x.len() <= 501 && y.len() <= 201, "{} {}", x.len(), y.len());
            let told = cells["customdata"].as_array().unwrap().iter().flat_map(|row| row.as_array().unwrap());
            let found = told.filter(|cell| cell[0].as_f64().is_some_and(|value| (value - 0.7).abs() < 1e-6));
            assert!((1..=3).contains(&found.count()));
        }
        let figure = json!(figure::run_ups(&long, 0, &[]));
        let line = numbers(&trace(&figure, "400 rad/s²")["y"]);
        assert!(line.contains(&0.9) && line.len() <= 24_002);
        long.runs = vec![long.runs[0].clone(); 40];
        assert!(run_ups(&long, 0, &[]).len() < 2 << 20);
    }
}

#[test]
fn figures_of_run_ups_have_their_words() {
    let of = passed(&[5.0, 50.0], true);
    let figure = json!(figure::run_ups(&of, 0, &stayed()));
    let line = trace(&figure, "50 rad/s²");
    let frames = &of.runs[1].frames;
    assert_eq!(numbers(&line["x"]).len(), frames.len());
    assert!(numbers(&line["y"]).iter().zip(frames).all(|(y, frame)| *y == frame.half_peak_to_peak[0]));
    let words = line["hovertext"][0].as_str().unwrap();
    assert!(words.starts_with("50 rad/s² (477 rpm/s): 4,5") && words.ends_with(" mm"), "{words}");
    assert_eq!(numbers(&trace(&figure, "largest half peak-to-peak")["x"]).len(), 2);
    let touching = numbers(&trace(&figure, "something touches")["y"]);
    assert!(touching.iter().all(|y| y.is_nan() || *y > 0.45) && touching.len() > 2);
    assert_eq!(numbers(&trace(&figure, "speed of the sweep")["x"]).len(), 20);
    assert_eq!(numbers(&trace(&figure, "the same, not settled")["x"]).len(), 1);
    let meta = &figure["layout"]["meta"];
    assert_eq!((&meta["kind"], &meta["units"]["y"]), (&json!("run_ups"), &json!("mm")));
}
