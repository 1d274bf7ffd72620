//! Drawings read back: what must be seen is there, where it belongs.

use std::f64::consts::TAU;

use roxmltree::{Document, Node};
use serde_json::{Value, json};

use super::{VerticalAxis, campbell, histories, interaction_map, report, work_precision};
use rubmap_analysis::result::{Campbell, CriticalSpeeds, InteractionMap, Quantity, WaveTables};
use rubmap_analysis::run::{Histories, WorkPrecision};

fn rad_s(rpm: f64) -> f64 {
    rpm * TAU / 60.0
}

const SPEEDS_RPM: [f64; 5] = [10_000.0, 11_000.0, 12_000.0, 13_000.0, 14_000.0];

fn sensor() -> Value {
    json!({"contact_node": 0, "sector": 0, "component": "radial"})
}

fn units() -> Value {
    json!({"length": "mm", "force": "N", "time": "s", "mass": "t"})
}

fn point(index: usize, status: &str) -> Value {
    let mut point = json!({
        "index": index, "speed_rad_s": rad_s(SPEEDS_RPM[index]), "status": status, "steps_per_revolution": 1000,
        "smallest_stable_steps_per_revolution": 900, "steps": 10000, "contact_share": 0.5, "contact_impulse": 1.0,
        "largest_penetration": 0.0, "energy_residual": 1e-12, "largest_energy": 1.0, "responses": [],
        "wall_time_s": 1.0, "version": "0",
    });
    if status == "completed" {
        let verdict = if index == 3 { "not_settled" } else { "periodic" };
        point["settling"] = json!({"verdict": verdict, "largest_change": 0.0});
        point["responses"] = json!([{
            "sensor": sensor(), "mean": 0.0, "rms": 0.1 * (1 + index) as f64, "half_peak_to_peak": 0.2,
            "dominant_engine_order": 2.0, "dominant_nodal_diameter": 2,
        }]);
    } else {
        point["message"] = json!("grew beyond <bounds>");
    }
    point
}

/// Five speeds; the third diverged, the fourth is not settled.
fn map() -> InteractionMap {
    let row = json!([9.0, 0.0, 0.01, 0.0, 0.5, 0.0, 0.002]);
    serde_json::from_value(json!({
        "speeds_rad_s": SPEEDS_RPM.map(rad_s),
        "engine_orders": [0.0, 0.5, 1.0, 1.5, 2.0, 2.5, 3.0],
        "amplitude": [row, row, null, row, row],
        "sensor": sensor(), "units": units(),
        "points": (0..5).map(|i| point(i, if i == 2 { "diverged" } else { "completed" })).collect::<Vec<_>>(),
        "settings": {
            "model": "0123456789abcdef", "speeds": {"values": SPEEDS_RPM, "unit": "rpm"},
            "scene": {"casing": {"clearance": {"leading": 0.3, "trailing": 0.2},
                "lobes": {"count": 2, "amplitude": 0.4, "width_rad": 0.3}}, "contact": {}},
        },
        "version": "0",
    }))
    .unwrap()
}

fn reduction() -> serde_json::Value {
    json!({"modes_per_speed": 1, "unknowns": [1], "wheel_unknowns": 1, "largest_mode_residual": 0.0, "modes": 1, "counted_modes": 1, "full_model": [],
        "basis_tolerance": 1e-5, "stiffening": {"verdict": "sound", "linear_ratio": 0.0, "quadratic_ratio": 0.0,
            "frequency_error": 0.0, "message": ""}, "wall_time_s": 0.0, "version": "0"})
}

fn critical() -> CriticalSpeeds {
    let speed = |index: usize, settling: &str| {
        json!({"speed_rad_s": rad_s(SPEEDS_RPM[index]), "index": index, "rms": 0.2, "half_peak_to_peak": 0.3,
            "at_edge": false, "speed_error_rad_s": rad_s(1000.0), "resolved": settling == "periodic", "prominence": 0.1, "dominant_engine_order": 2.0, "dominant_nodal_diameter": 2, "settling": settling})
    };
    serde_json::from_value(json!({
        "sensor": sensor(), "critical_speeds": [speed(1, "periodic"), speed(3, "not_settled")],
        "linear_crossings": [{"nodal_diameter": 1, "family": 1, "superharmonic": 2, "speed_rad_s": rad_s(11_500.0),
            "frequency_hz": 11_500.0 / 30.0}],
        "driven_crossings": [{"nodal_diameter": 2, "family": 1, "engine_order": 2, "speed_rad_s": rad_s(12_500.0),
            "frequency_hz": 12_500.0 / 30.0}],
        "missing": [2], "units": units(), "settings": map().settings, "reduction": reduction(), "version": "0",
    }))
    .unwrap()
}

fn modes() -> Campbell {
    let frequencies: Vec<Vec<Vec<f64>>> = (0..5)
        .map(|s| (0..3).map(|i| vec![f64::from(400 + 5 * s + i), f64::from(900 + s)]).collect())
        .collect();
    let CriticalSpeeds { linear_crossings, driven_crossings, .. } = critical();
    serde_json::from_value(json!({
        "speeds_rad_s": SPEEDS_RPM.map(rad_s), "frequencies_hz": frequencies, "absolute_frequencies_hz": [],
        "crossings": linear_crossings, "driven_crossings": driven_crossings,
        "reduction": reduction(),
        "settings": {"model": "0123456789abcdef", "speeds": {"values": SPEEDS_RPM, "unit": "rpm"}},
        "wall_time_s": 0.0, "version": "0",
    }))
    .unwrap()
}

/// `modes` with its frequencies split by ∓3 Hz.
fn waves() -> Campbell {
    let modes = modes();
    let by = |split: f64| {
        let row = |line: &Vec<f64>| line.iter().map(|hz| hz + split).collect();
        modes.frequencies_hz.iter().map(|rows| rows.iter().map(row).collect()).collect()
    };
    let waves = WaveTables { forward_hz: by(-3.0), backward_hz: by(3.0) };
    Campbell { waves: Some(waves), ..modes }
}

/// Both waves of every mode are drawn in the place of one curve, and told apart in the legend.
#[test]
fn split_waves_are_drawn_apart() {
    let count = |drawing: &str, words: &str| drawing.matches(words).count();
    for (together, apart) in [
        (campbell(&modes()), campbell(&waves())),
        (
            interaction_map(&map(), Some(&critical()), Some(&modes()), VerticalAxis::EngineOrder),
            interaction_map(&map(), Some(&critical()), Some(&waves()), VerticalAxis::EngineOrder),
        ),
    ] {
        assert_eq!(count(&together, "wave</title>"), 0);
        for wave in ["forward", "backward"] {
            assert_eq!(count(&apart, &format!("family 1, {wave} wave</title>")), 3);
        }
    }
    assert_eq!(count(&campbell(&waves()), "forward waves"), 1);
}

/// A K(Ω) that cannot be trusted is said above the drawing, and only then.
#[test]
fn unsound_stiffening_stands_above_the_drawing() {
    let drawings = |verdict: &str| {
        let (mut map, mut modes) = (map(), modes());
        let verdict = serde_json::from_value(json!(verdict)).unwrap();
        map.stiffening = Some(verdict);
        modes.reduction.stiffening.verdict = verdict;
        [interaction_map(&map, None, None, VerticalAxis::EngineOrder), campbell(&modes)]
    };
    for (verdict, warned) in [("absent", false), ("sound", false), ("suspect", true), ("unsound", true)] {
        for drawing in drawings(verdict) {
            assert_eq!(drawing.contains(&format!("K(Ω) is {verdict}")), warned, "{verdict}");
        }
    }
}

/// A critical speed without a dominant line has no engine order.
#[test]
fn a_critical_speed_without_a_line_is_labelled_without_one() {
    let mut critical = critical();
    critical.critical_speeds[0].dominant_engine_order = None;
    let drawing = interaction_map(&map(), Some(&critical), None, VerticalAxis::EngineOrder);
    assert!(drawing.contains("11,000 rpm · EO –"), "{drawing}");
}

fn of_class<'a>(drawing: &'a Document, class: &'a str) -> impl Iterator<Item = Node<'a, 'a>> {
    drawing.descendants().filter(move |node| node.attribute("class") == Some(class))
}

fn number(node: Node, name: &str) -> f64 {
    node.attribute(name).unwrap().parse().unwrap()
}

/// Where a tick label stands: the axis as the reader sees it.
fn tick(drawing: &Document, label: &str) -> f64 {
    number(drawing.descendants().find(|node| node.text() == Some(label)).unwrap(), "x")
}

#[test]
fn critical_speeds_stand_at_their_speeds() {
    for axis in [VerticalAxis::EngineOrder, VerticalAxis::Frequency] {
        let drawing = interaction_map(&map(), Some(&critical()), Some(&modes()), axis);
        let drawing = Document::parse(&drawing).unwrap();
        let lines: Vec<f64> = of_class(&drawing, "critical-speed").map(|line| number(line, "x1")).collect();
        let expected = [tick(&drawing, "11,000"), tick(&drawing, "13,000")];
        assert_eq!(lines.len(), 2);
        assert!(
            lines.iter().zip(expected).all(|(x, tick)| (x - tick).abs() < 0.02),
            "{lines:?} {expected:?}"
        );
        let texts: Vec<_> = drawing.descendants().filter_map(|node| node.text()).collect();
        assert!(texts.contains(&"11,000 rpm · EO 2"));
        assert!(texts.contains(&"13,000 rpm · EO 2 *"), "not settled is marked");
        let dashes: Vec<_> =
            of_class(&drawing, "critical-speed").map(|line| line.attribute("stroke-dasharray")).collect();
        assert_ne!(dashes[0], dashes[1], "not resolved is dotted");
        assert!(texts.contains(&"peak not resolved"));
    }
}

#[test]
fn a_speed_without_result_is_hatched_and_transparent() {
    let drawing = interaction_map(&map(), None, None, VerticalAxis::EngineOrder);
    let drawing = Document::parse(&drawing).unwrap();
    let missing: Vec<_> = of_class(&drawing, "missing").collect();
    assert_eq!(missing.len(), 1);
    assert_eq!(missing[0].first_element_child().unwrap().text(), Some("12000 rpm: grew beyond <bounds>"));
    let image = drawing.descendants().find(|node| node.has_tag_name("image")).unwrap();
    let (width, pixels) = decode(image.attribute("href").unwrap());
    let at = |label: &str| {
        let (left, scale) = (number(image, "x"), width as f64 / number(image, "width"));
        ((tick(&drawing, label) - left) * scale) as usize
    };
    let opaque = |column: usize| pixels.chunks(width).all(|row| row[column] != 255);
    let transparent = |column: usize| pixels.chunks(width).all(|row| row[column] == 255);
    assert!(transparent(at("12,000")) && opaque(at("11,000")) && opaque(at("13,000")));
    let loudest = pixels.chunks(width).map(|row| row[at("11,000")]).max();
    assert_eq!(loudest, Some(254), "the mean does not set the scale");
}

fn decode(uri: &str) -> (usize, Vec<u8>) {
    use base64::Engine;
    let bytes = uri.strip_prefix("data:image/png;base64,").unwrap();
    let bytes = base64::engine::general_purpose::STANDARD.decode(bytes).unwrap();
    let mut reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    let frame = reader.next_frame(&mut pixels).unwrap();
    (frame.width as usize, pixels)
}

#[test]
fn unsettled_speeds_are_in_the_strip() {
    let drawing = interaction_map(&map(), None, None, VerticalAxis::EngineOrder);
    let drawing = Document::parse(&drawing).unwrap();
    let titles: Vec<_> = drawing
        .descendants()
        .filter(|node| node.has_tag_name("title"))
        .filter_map(|node| node.text())
        .collect();
    let strip: Vec<_> = titles
        .iter()
        .copied()
        .filter(|title| ["periodic", "not settled", "no result"].contains(title))
        .collect();
    assert_eq!(strip, ["periodic", "no result", "not settled", "periodic"]);
}

#[test]
fn an_empty_map_is_still_a_drawing() {
    let mut map = map();
    map.amplitude = vec![None; 5];
    map.points.clear();
    assert!(Document::parse(&interaction_map(&map, None, None, VerticalAxis::EngineOrder)).is_ok());
    map.speeds_rad_s.clear();
    map.amplitude.clear();
    map.engine_orders.clear();
    assert!(Document::parse(&interaction_map(&map, None, None, VerticalAxis::Frequency)).is_ok());
}

#[test]
fn a_long_sweep_stays_small() {
    let mut map = map();
    let row: Vec<f64> = (0..=480).map(|bin| 0.5 / f64::from(1 + bin * 7919 % 997)).collect();
    map.engine_orders = (0..=480).map(|bin| f64::from(bin) / 20.0).collect();
    map.speeds_rad_s = (0..3000).map(|i| rad_s(10_000.0 + f64::from(i))).collect();
    map.amplitude = vec![Some(row); 3000];
    assert!(interaction_map(&map, None, None, VerticalAxis::Frequency).len() < 2_000_000);
}

#[test]
fn crossings_of_the_campbell_diagram_lie_on_their_engine_order() {
    let drawing = campbell(&modes());
    let drawing = Document::parse(&drawing).unwrap();
    let title = |node: &Node, start: &str| {
        node.first_element_child().and_then(|child| child.text()).is_some_and(|text| text.starts_with(start))
    };
    let ring =
        drawing.descendants().find(|node| node.has_tag_name("circle") && title(node, "linear")).unwrap();
    let half = 0.5 * (tick(&drawing, "11,000") + tick(&drawing, "12,000"));
    assert!((number(ring, "cx") - half).abs() < 0.02, "11,500 rpm is halfway");
    assert!(
        drawing.descendants().any(|node| node.has_tag_name("path") && title(&node, "driven: engine order 2"))
    );
}

/// (modes, scheme, steps, time, error of the amplitude, on its front); None did not complete.
type Run = (u32, &'static str, u32, f64, Option<f64>, bool);

const RUNS: [Run; 7] = [
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

fn study(runs: &[Run], chaotic: bool) -> WorkPrecision {
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

/// Places along a path of straight lines.
fn corners(path: Node) -> Vec<(f64, f64)> {
    let steps = path.attribute("d").unwrap().split(['M', 'L']).skip(1);
    let pair = |step: &str| step.split_once(' ').map(|(x, y)| (x.parse().unwrap(), y.parse().unwrap()));
    steps.map(|step| pair(step).unwrap()).collect()
}

/// Where a label of the vertical axis points to.
fn level(drawing: &Document, label: &str) -> f64 {
    number(drawing.descendants().find(|node| node.text() == Some(label)).unwrap(), "y") - 4.5
}

fn is_near(a: f64, b: f64) -> bool {
    (a - b).abs() < 0.03
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

/// A line per size, each a spike of its size at sample `spike` of so many; the reference last.
fn first_revolutions(sizes: &[u32], samples: usize, spike: usize) -> Histories {
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

/// The page as XML: HTML's elements without an end get one.
fn as_xml(page: &str) -> String {
    let page = page.strip_prefix("<!DOCTYPE html>").expect("a document type");
    page.replace("initial-scale=1\">", "initial-scale=1\"/>").replace("utf-8\">", "utf-8\"/>")
}

#[test]
fn a_report_of_a_sweep_says_all_and_needs_nothing() {
    let hostile = "</h1><script>alert(1)</script> & \"Ω\"";
    let head = report::Head {
        title: hostile.to_owned(),
        facts: vec![("job", hostile.to_owned())],
        notes: Some(hostile.to_owned()),
    };
    let (map, tables, campbell) = (map(), [critical()], modes());
    let page =
        report::sweep(&head, &report::Sweep { map: &map, critical: &tables, campbell: Some(&campbell) });
    let xml = as_xml(&page);
    let read = Document::parse(&xml).unwrap();
    assert!(!page.contains("<script"), "texts stay texts");
    let all = |name: &str| read.descendants().filter(|node| node.has_tag_name(name)).count();
    assert_eq!(read.descendants().find(|node| node.has_tag_name("h1")).unwrap().text(), Some(hostile));
    let drawings = read.descendants().filter(|node| node.tag_name().name() == "svg").count();
    assert_eq!(drawings, 2, "map and natural frequencies");
    for word in ["src=", "@import", "url(http", "<link", "<iframe"] {
        assert!(!page.contains(word), "{word}");
    }
    // One speed without a result, one that has not settled, one peak that is not resolved.
    let text: String = read.descendants().filter_map(|node| node.text()).collect::<Vec<_>>().join(" ");
    for words in [
        "No result at 12000 rpm: grew beyond <bounds>",
        "1 speeds had not settled",
        "1 critical speeds are not resolved",
        "4 of 5",
        "3 periodic, 1 not settled",
        "at 4 speeds, in 50.0 to 50.0 % of the steps",
        "\"peak_prominence\"",
        "clearance (leading 0.3, trailing 0.2), lobes (",
    ] {
        assert!(text.contains(words), "{words}: {text}");
    }
    assert!(all("table") >= 5, "facts, asked, credentials, critical speeds, crossings, responses");
    let rows = |rpm: &str| {
        read.descendants().filter(|node| node.has_tag_name("td") && node.text() == Some(rpm)).count()
    };
    assert_eq!((rows("11000"), rows("13000"), rows("12000")), (2, 2, 0), "peaks, and largest responses");
}

#[test]
fn a_report_of_a_modal_analysis_has_its_crossings() {
    let campbell = modes();
    let page = report::modal_analysis(&report::Head::default(), &campbell);
    let xml = as_xml(&page);
    let read = Document::parse(&xml).unwrap();
    let text: String = read.descendants().filter_map(|node| node.text()).collect::<Vec<_>>().join(" ");
    assert!(text.contains("Crossings that the lobes can drive") && text.contains("None."), "{text}");
    for crossing in &campbell.driven_crossings {
        assert!(text.contains(&format!("{:.1}", crossing.frequency_hz)));
    }
}
