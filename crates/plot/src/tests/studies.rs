//! Drawings of studies read back.

use roxmltree::{Document, Node};
use serde_json::{Value, json};

use super::pens::svg::{histories, work_precision};
use super::{corners, is_near, level, number, of_class, rad_s, sensor, tick, units};
use rubmap_analysis::result::Quantity;
use rubmap_analysis::run::{Histories, WorkPrecision};

/// (modes, scheme, steps, time, error of the amplitude, on its front); None did not complete.
pub(super) type Run = (u32, &'static str, u32, f64, Option<f64>, bool);

pub(super) const RUNS: [Run; 7] = [
    (1, "exact_modal", 1800, 1.0, Some(0.1), true),
    (1, "exact_modal", 3600, 2.0, Some(0.2), false),
    (8, "exact_modal", 1800, 10.0, Some(0.01), true),
    (1, "central_differences", 1800, 5.0, None, false),
    (1, "central_differences", 3600, 3.0, Some(0.05), true),
    (8, "central_differences", 1800, 20.0, Some(0.02), false),
    (8, "central_differences", 3600, 30.0, Some(0.0), true),
];

fn setting((modes, scheme, steps): (u32, &str, u32)) -> Value {
    json!({"modes_per_speed": modes, "scheme": scheme, "kept_modes": "auto", "steps_per_revolution": steps})
}

fn run((modes, scheme, steps, time, amplitude, front): Run) -> Value {
    let mut run = setting((modes, scheme, steps));
    run["unknowns"] = json!(300 + modes);
    run["cost"] =
        json!({"set_up_s": 0.25, "per_revolution_s": time / 50.0, "repetitions": 3, "spread": 0.01});
    run["time_s"] = json!(time);
    run["status"] = json!(if amplitude.is_some() { "completed" } else { "diverged" });
    match amplitude {
        Some(error) => run["errors"] = json!({"amplitude": error, "amplitude_spread": 0.015}),
        None => run["message"] = json!("grew beyond <bounds>"),
    }
    run["pareto"] = json!(if front { vec!["amplitude"] } else { Vec::new() });
    run
}

pub(super) fn study(runs: &[Run], chaotic: bool) -> WorkPrecision {
    serde_json::from_value(json!({
        "speeds": [{
            "speed_rad_s": rad_s(24_000.0), "reference": run((20, "exact_modal", 7200, 99.0, Some(0.0), false)),
            "sensitivity": {"growth": if chaotic { "chaotic" } else { "stable" }, "last_distance": 0.1},
            "message": "what is < to be said",
            "runs": runs.iter().map(|&of| run(of)).collect::<Vec<_>>(), "orders": [],
        }],
        "reductions": [{"modes_per_speed": 1, "wheel_unknowns": 330, "wall_time_s": 0.1},
            {"modes_per_speed": 8, "wheel_unknowns": 1620, "wall_time_s": 0.1}],
        "settings": {"model": "0123456789abcdef", "speeds": {"values": [24_000.0], "unit": "rpm"}, "scene": {},
            "grid": {"modes_per_speed": [1, 8], "steps_per_revolution": [1800, 3600],
                "schemes": ["exact_modal", "central_differences"]}},
        "version": "0",
    }))
    .unwrap()
}

#[test]
fn the_front_is_ringed_at_its_times_and_errors() {
    let drawing = work_precision(&study(&RUNS, false), 0, Quantity::Amplitude);
    assert!(!drawing.contains("NaN") && !drawing.contains("inf"));
    let drawing = Document::parse(&drawing).unwrap();
    let rings: Vec<_> =
        of_class(&drawing, "front").filter(|ring| ring.first_element_child().is_some()).collect();
    let expected = [("1", "0.1"), ("10", "0.01")].map(|(x, y)| (tick(&drawing, x), level(&drawing, y)));
    assert_eq!(rings.len(), 3, "the error of 0 has no place");
    for (ring, (x, y)) in [rings[0], rings[2]].into_iter().zip(expected) {
        assert!(is_near(number(ring, "cx"), x) && is_near(number(ring, "cy"), y), "{ring:?} {x} {y}");
    }
    assert_eq!(of_class(&drawing, "run").count(), 5);
    let line = corners(of_class(&drawing, "front-line").next().unwrap());
    let places: Vec<_> = rings.iter().map(|ring| (number(*ring, "cx"), number(*ring, "cy"))).collect();
    assert_eq!(line.len(), 2 * places.len() + 1);
    for (corner, place) in line.iter().skip(1).step_by(2).zip(&places) {
        assert_eq!(corner, place, "the steps go down at the front");
    }
    assert!(line.windows(2).all(|pair| pair[0].0 == pair[1].0 || pair[0].1 == pair[1].1));
}

#[test]
fn a_scheme_is_joined_through_its_own_best_runs() {
    let drawing = work_precision(&study(&RUNS, false), 0, Quantity::Amplitude);
    let drawing = Document::parse(&drawing).unwrap();
    let lines: Vec<_> = of_class(&drawing, "scheme").map(corners).collect();
    // (1.0, 0.1) and (10.0, 0.01) of the one, (3.0, 0.05) and (20.0, 0.02) of the other.
    assert_eq!(lines.iter().map(Vec::len).collect::<Vec<_>>(), [2, 2]);
    assert!(is_near(lines[0][1].0, tick(&drawing, "10")) && is_near(lines[0][1].1, level(&drawing, "0.01")));
    assert!(is_near(lines[1][1].0, tick(&drawing, "20")) && is_near(lines[1][1].1, level(&drawing, "0.02")));
}

#[test]
fn runs_without_a_place_are_counted() {
    let note = |quantity| {
        let drawing = work_precision(&study(&RUNS, false), 0, quantity);
        let drawing = Document::parse(&drawing).unwrap();
        of_class(&drawing, "left-out").next().and_then(|note| note.text().map(str::to_owned))
    };
    let amplitude = "Left out of 7 runs: 1 not completed, 1 with an error of exactly 0";
    assert_eq!(note(Quantity::Amplitude).as_deref(), Some(amplitude));
    let impulse = "Left out of 7 runs: 1 not completed, 6 without this error";
    assert_eq!(note(Quantity::Impulse).as_deref(), Some(impulse));
}

#[test]
fn chaotic_amplitudes_have_bars() {
    let bars = |chaotic| {
        let drawing = work_precision(&study(&RUNS, chaotic), 0, Quantity::Amplitude);
        let drawing = Document::parse(&drawing).unwrap();
        let words = drawing.descendants().filter_map(|node| node.text()).any(|text| text.contains("chaotic"));
        let bars = of_class(&drawing, "spread").map(|bar| (number(bar, "y1"), number(bar, "y2")));
        (bars.collect::<Vec<_>>(), words)
    };
    assert_eq!(bars(false), (Vec::new(), false));
    let (bars, words) = bars(true);
    assert!(words && bars.len() == 5 && bars.iter().all(|(low, high)| low > high));
}

#[test]
fn a_study_without_completed_runs_says_why() {
    let drawing = work_precision(&study(&RUNS[3..4], false), 0, Quantity::History);
    let drawing = Document::parse(&drawing).unwrap();
    let words = of_class(&drawing, "empty").next().unwrap().text().unwrap();
    assert!(words.contains("no run was completed (grew beyond <bounds>)"), "{words}");
    let never = work_precision(&study(&RUNS, false), 0, Quantity::EngineOrders);
    assert!(never.contains("does not repeat"));
    let absent = work_precision(&study(&RUNS, false), 7, Quantity::History);
    assert!(Document::parse(&absent).is_ok() && absent.contains("no speed of index 7"));
}

/// Histories with a line per size, each a spike of its size at sample `spike` of `samples`; the reference last.
pub(super) fn first_revolutions(sizes: &[u32], samples: usize, spike: usize) -> Histories {
    let line = |(i, &modes): (usize, &u32)| {
        let mut displacement = vec![0.0; samples];
        displacement[spike] = f64::from(modes);
        let mut line = setting((modes, "exact_modal", 3600));
        line["reference"] = json!(i + 1 == sizes.len());
        line["unknowns"] = json!(modes);
        line["displacement"] = json!([displacement]);
        line
    };
    serde_json::from_value(json!({
        "speed_rad_s": rad_s(24_000.0), "sensors": [sensor()], "samples_per_revolution": samples / 2,
        "lines": sizes.iter().enumerate().map(line).collect::<Vec<_>>(), "units": units(), "version": "0",
    }))
    .unwrap()
}

#[test]
fn histories_begin_a_sample_after_the_start() {
    let drawing = histories(&first_revolutions(&[1, 2, 4], 20, 9), 0);
    assert!(!drawing.contains("NaN"));
    let drawing = Document::parse(&drawing).unwrap();
    let lines: Vec<_> = of_class(&drawing, "history").collect();
    assert_eq!(lines.len(), 3);
    let title = |line: &Node| line.first_element_child().and_then(|child| child.text()).unwrap().to_owned();
    assert_eq!(lines[2].attribute("stroke"), Some("black"));
    assert!(title(&lines[2]).starts_with("reference: 4 modes"), "{}", title(&lines[2]));
    for (line, height) in lines.into_iter().zip(["1", "2", "4"]) {
        let points = corners(line);
        assert_eq!(points.len(), 20);
        // The tenth of ten samples a revolution.
        assert!(is_near(points[9].0, tick(&drawing, "1.0")), "{points:?}");
        let texts = drawing.descendants().filter(|node| node.text() == Some(height));
        assert!(texts.into_iter().any(|node| is_near(number(node, "y") - 4.5, points[9].1)), "{height}");
    }
    assert!(drawing.descendants().any(|node| node.text() == Some("displacement, mm")));
}

#[test]
fn long_histories_are_thinned_and_keep_their_peaks() {
    let drawing = histories(&first_revolutions(&[3], 200_000, 123_457), 0);
    let drawing = Document::parse(&drawing).unwrap();
    let points = corners(of_class(&drawing, "history").next().unwrap());
    assert!(points.len() < 4000, "{}", points.len());
    let peak = points.iter().copied().min_by(|a, b| a.1.total_cmp(&b.1)).unwrap();
    assert!(is_near(peak.1, level(&drawing, "3.0")), "{peak:?}");
    let share = (peak.0 - tick(&drawing, "0.0")) / (tick(&drawing, "2.0") - tick(&drawing, "0.0"));
    assert!((share - 123_458.0 / 200_000.0).abs() < 1e-3, "{share}");
}

#[test]
fn histories_of_nothing_say_so() {
    for drawing in [histories(&first_revolutions(&[], 4, 0), 0), histories(&first_revolutions(&[1], 4, 0), 5)]
    {
        let drawing = Document::parse(&drawing).unwrap();
        assert_eq!(of_class(&drawing, "empty").count(), 1);
    }
}
