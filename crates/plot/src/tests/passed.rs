//! Fixtures of run-ups: a blade mode of 400 Hz that engine order 4 excites, passed at several rates.

use std::f64::consts::TAU;

use serde_json::{Value, json};

use super::{map, point, sensor, units};
use rubmap_analysis::result::{Point, RunUps};

/// Angular frequency of the mode, rad/s; `DAMPING`: its modal damping.
const OMEGA: f64 = TAU * 400.0;
const DAMPING: f64 = 0.002;

/// Engine order that excites the mode; `LARGEST`: its steady amplitude at resonance.
const ORDER: f64 = 4.0;
const LARGEST: f64 = 0.8;

const REVOLUTIONS: u64 = 8;

/// Number of lines of a spectrum: to engine order 12.
const LINES: usize = 97;

/// Steady amplitude at a speed.
fn steady(speed_rad_s: f64) -> f64 {
    let off = (ORDER * speed_rad_s - OMEGA) / (DAMPING * OMEGA);
    LARGEST / (1.0 + off * off).sqrt()
}

/// Spectrum under a Hann window, line by line: the forced response, another order, the ringing at the frequency of the mode, and the mean.
fn spectrum(speed_rad_s: f64, forced: f64, ringing: f64) -> Vec<f64> {
    let lines = [(0.0, 0.4), (ORDER, forced), (8.0, 0.004), (OMEGA / speed_rad_s, ringing)];
    let line = |j: usize| {
        let order = 0.125 * j as f64;
        let hann =
            |distance: f64| if distance < 2.0 { (0.25 * TAU * distance / 2.0).cos().powi(2) } else { 0.0 };
        lines.iter().map(|(at, height)| height * hann(8.0 * (order - at).abs())).fold(2e-6, f64::max)
    };
    (0..LINES).map(line).collect()
}

/// Frames of a run whose speed in rad/s is given over time, until `end_s`.
fn frames(speed: impl Fn(f64) -> f64, end_s: f64) -> Vec<Value> {
    let (mut time, mut revolution, mut found) = (0.0, 0, Vec::new());
    // The mode's slowly changing amplitude, in the phase of the excitation.
    let (mut re, mut im) = (0.0f64, 0.0f64);
    while time < end_s {
        let (begin, mut turned, mut largest) = (time, 0.0, 0.0f64);
        while turned < TAU * REVOLUTIONS as f64 && time < end_s {
            let step = 2e-4;
            let (decay, detuned) = (DAMPING * OMEGA, ORDER * speed(time + 0.5 * step) - OMEGA);
            let shrink = (-decay * step).exp();
            let (sin, cos) = (-detuned * step).sin_cos();
            (re, im) = (shrink * (cos * re - sin * im), shrink * (sin * re + cos * im));
            im -= LARGEST * decay * step;
            turned += speed(time) * step;
            time += step;
            largest = largest.max(re.hypot(im));
        }
        let whole = turned >= TAU * REVOLUTIONS as f64;
        let middle = speed(0.5 * (begin + time));
        let forced = steady(middle).min(largest);
        let mut frame = json!({
            "revolution": revolution, "times_s": [begin, time], "speeds_rad_s": [speed(begin), speed(time)],
            "largest": [1.2 * largest, 0.3 * largest], "half_peak_to_peak": [largest, 0.25 * largest],
            "contact_share": if largest > 0.45 { 0.3 } else { 0.0 },
        });
        if whole {
            let row = spectrum(middle, forced, (largest - forced).max(0.0));
            let quieter: Vec<f64> = row.iter().map(|amplitude| 0.25 * amplitude).collect();
            frame["spectra"] = json!([row, quieter]);
        }
        found.push(frame);
        revolution += REVOLUTIONS;
    }
    found
}

fn run_ups(speed: Value, runs: Vec<Value>) -> RunUps {
    serde_json::from_value(json!({
        "sensors": [sensor(), {"contact_node": 2, "sector": 0, "component": "axial"}], "units": units(), "complete": true,
        "runs": runs, "version": "0", "vectors": "V4",
        "settings": {"sweep": map().settings, "speed": speed, "angle_tolerance_rad": 1e-3, "frame_revolutions": REVOLUTIONS},
    }))
    .unwrap()
}

fn run(number: usize, rate: Option<f64>, frames: Vec<Value>) -> Value {
    let mut run = json!({"run": number, "order_step": 0.125, "frames": frames});
    let largest = json!({"displacement": 0.9, "time_s": 1.0, "speed_rad_s": super::rad_s(6_000.0)});
    run["end"] = json!({
        "status": "completed", "largest": [largest, largest], "revolutions": 80, "steps": 80_000, "segments": 400,
        "largest_angle_error_rad": 1e-4, "largest_energy": 1.0, "energy_residual": 1e-12, "stiffening_work": 0.1,
        "transfer_loss": 1e-9, "contact_share": 0.1, "euler_share": 1e-4, "wall_time_s": 2.0,
    });
    if let Some(rate) = rate {
        run["rate_rad_s2"] = json!(rate);
    }
    run
}

/// Run-ups from 4,500 to 7,500 rpm, or run-downs, at these rates in rad/s².
pub(super) fn passed(rates: &[f64], upwards: bool) -> RunUps {
    let (low, high) = (super::rad_s(4_500.0), super::rad_s(7_500.0));
    let (from, sign) = if upwards { (low, 1.0) } else { (high, -1.0) };
    let of = |(number, rate): (usize, &f64)| {
        run(number, Some(*rate), frames(|time| from + sign * rate * time, (high - low) / rate))
    };
    let (from, to) = if upwards { (low, high) } else { (high, low) };
    run_ups(
        json!({"unit": "rad_s", "from": from, "to": to, "rates": rates}),
        rates.iter().enumerate().map(of).collect(),
    )
}

/// Rates of more runs than a key lists.
pub(super) fn many_rates() -> Vec<f64> {
    (0..40).map(|k| 20.0 * 1.09f64.powi(k)).collect()
}

/// Run up to 6,500 rpm, held there, and down again.
pub(super) fn through_points() -> RunUps {
    let points = [(0.0, 4_500.0), (2.0, 6_500.0), (3.0, 6_500.0), (7.0, 4_500.0)];
    let points = points.map(|(time, rpm)| (time, super::rad_s(rpm)));
    let speed = move |time: f64| {
        let pair = points.windows(2).find(|pair| time <= pair[1].0).unwrap_or(&points[2..]);
        pair[0].1 + (pair[1].1 - pair[0].1) * ((time - pair[0].0) / (pair[1].0 - pair[0].0)).min(1.0)
    };
    let told: Vec<Value> =
        points.iter().map(|(time, speed)| json!({"time_s": time, "speed": speed})).collect();
    run_ups(
        json!({"unit": "rad_s", "points": told, "course": "straight"}),
        vec![run(0, None, frames(speed, 7.0))],
    )
}

/// Speeds of a sweep about the critical one; one has no result, one is not settled.
pub(super) fn stayed() -> Vec<Point> {
    let of = |k: u32| {
        let mut one = point(if k == 11 { 3 } else { 0 }, if k == 5 { "failed" } else { "completed" });
        let speed = super::rad_s(5_700.0 + 30.0 * f64::from(k));
        one["speed_rad_s"] = json!(speed);
        if k != 5 {
            one["responses"][0]["half_peak_to_peak"] = json!(steady(speed));
        }
        serde_json::from_value(one).unwrap()
    };
    (0..22).map(of).collect()
}
