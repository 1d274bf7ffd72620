//! Drawings read back: their content is there, where it belongs.

mod branched;
mod branching;
mod campaigns;
mod drawings;
mod figure_gallery;
mod figures;
mod fixtures;
mod gallery;
mod impeller;
mod interference;
mod levels;
mod passed;
mod pens;
mod report;
mod run_ups;
mod stresses;
mod studies;
mod surfaces;

use std::f64::consts::TAU;

use roxmltree::{Document, Node};
use serde_json::{Value, json};

use super::{LevelColour, VerticalAxis, Window};
use pens::svg::{campbell, interaction_map};
use rubmap_analysis::result::{Backbones, Campbell, CriticalSpeeds, InteractionMap, WaveTables};

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

/// Map of five speeds; the third diverged, the fourth is not settled.
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

/// Curves of three modes, one of which hardens, one softens, and one ends at half the amplitude.
fn backbones() -> Backbones {
    let point = |step: u32, change: f64| {
        let amplitude = 0.1 * f64::from(step);
        let change = change * amplitude * amplitude;
        json!({"amplitude": amplitude, "frequency_hz": 400.0 + 4.0 * change, "change_percent": change, "harmonics_percent": 1e-7})
    };
    let curve = |(i, family, change, last): (u32, u32, f64, u32)| {
        let end = if last == 12 { "the largest amplitude is reached" } else { "no larger motion was found" };
        json!({"nodal_diameter": i, "family": family, "contact_node": 0, "component": "tangential", "outside_coordinates": 0.05, "complete": last == 12, "end": end,
            "points": (0..=last).map(|step| point(step, change)).collect::<Vec<_>>()})
    };
    let curves = [(1, 1, 4.0, 12), (1, 2, -1.5, 12), (2, 1, 6.0, 6)].map(curve);
    serde_json::from_value(
        json!({"speed_rad_s": rad_s(14_000.0), "coordinates": 4, "curves": curves, "units": units(),
        "model": "0123456789abcdef", "version": "0"}),
    )
    .unwrap()
}

/// Modes of `modes` with their frequencies split by ∓3 Hz.
fn waves() -> Campbell {
    let modes = modes();
    let by = |split: f64| {
        let row = |line: &Vec<f64>| line.iter().map(|hz| hz + split).collect();
        modes.frequencies_hz.iter().map(|rows| rows.iter().map(row).collect()).collect()
    };
    let waves = WaveTables { forward_hz: by(-3.0), backward_hz: by(3.0) };
    Campbell { waves: Some(waves), ..modes }
}

/// Waves of a split mode are drawn in the place of one curve each, and distinguished in the legend.
#[test]
fn split_waves_are_drawn_apart() {
    let count = |drawing: &str, words: &str| drawing.matches(words).count();
    for (together, apart) in [
        (campbell(&modes()), campbell(&waves())),
        (
            interaction_map(
                &map(),
                Some(&critical()),
                Some(&modes()),
                VerticalAxis::EngineOrder,
                Window::default(),
                LevelColour::Plain,
            ),
            interaction_map(
                &map(),
                Some(&critical()),
                Some(&waves()),
                VerticalAxis::EngineOrder,
                Window::default(),
                LevelColour::Plain,
            ),
        ),
    ] {
        assert_eq!(count(&together, "wave</title>"), 0);
        for wave in ["forward", "backward"] {
            assert_eq!(count(&apart, &format!("family 1, {wave} wave</title>")), 3);
        }
    }
    assert_eq!(count(&campbell(&waves()), "forward waves"), 1);
}

/// Warnings about an unreliable K(Ω) stand above the drawing, and only then.
#[test]
fn unsound_stiffening_stands_above_the_drawing() {
    let drawings = |verdict: &str| {
        let (mut map, mut modes) = (map(), modes());
        let verdict = serde_json::from_value(json!(verdict)).unwrap();
        map.stiffening = Some(verdict);
        modes.reduction.stiffening.verdict = verdict;
        [
            interaction_map(
                &map,
                None,
                None,
                VerticalAxis::EngineOrder,
                Window::default(),
                LevelColour::Plain,
            ),
            campbell(&modes),
        ]
    };
    for (verdict, warned) in [("absent", false), ("sound", false), ("suspect", true), ("unsound", true)] {
        for drawing in drawings(verdict) {
            assert_eq!(drawing.contains(&format!("K(Ω) is {verdict}")), warned, "{verdict}");
        }
    }
}

/// Critical speeds without a dominant line have no engine order.
#[test]
fn a_critical_speed_without_a_line_is_labelled_without_one() {
    let mut critical = critical();
    critical.critical_speeds[0].dominant_engine_order = None;
    let drawing = interaction_map(
        &map(),
        Some(&critical),
        None,
        VerticalAxis::EngineOrder,
        Window::default(),
        LevelColour::Plain,
    );
    assert!(drawing.contains("11,000 rpm · EO –"), "{drawing}");
}

fn of_class<'a>(drawing: &'a Document, class: &'a str) -> impl Iterator<Item = Node<'a, 'a>> {
    drawing.descendants().filter(move |node| node.attribute("class") == Some(class))
}

fn number(node: Node, name: &str) -> f64 {
    node.attribute(name).unwrap().parse().unwrap()
}

/// Position of a tick label: the axis as the reader sees it.
fn tick(drawing: &Document, label: &str) -> f64 {
    number(drawing.descendants().find(|node| node.text() == Some(label)).unwrap(), "x")
}

#[test]
fn critical_speeds_stand_at_their_speeds() {
    for axis in [VerticalAxis::EngineOrder, VerticalAxis::Frequency] {
        let drawing = interaction_map(
            &map(),
            Some(&critical()),
            Some(&modes()),
            axis,
            Window::default(),
            LevelColour::Plain,
        );
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
        assert!(texts.contains(&"critical speed, peak not resolved"));
    }
}

#[test]
fn a_speed_without_result_is_hatched_and_transparent() {
    let drawing =
        interaction_map(&map(), None, None, VerticalAxis::EngineOrder, Window::default(), LevelColour::Plain);
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
    let drawing =
        interaction_map(&map(), None, None, VerticalAxis::EngineOrder, Window::default(), LevelColour::Plain);
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
    assert!(
        Document::parse(&interaction_map(
            &map,
            None,
            None,
            VerticalAxis::EngineOrder,
            Window::default(),
            LevelColour::Plain
        ))
        .is_ok()
    );
    map.speeds_rad_s.clear();
    map.amplitude.clear();
    map.engine_orders.clear();
    assert!(
        Document::parse(&interaction_map(
            &map,
            None,
            None,
            VerticalAxis::Frequency,
            Window::default(),
            LevelColour::Plain
        ))
        .is_ok()
    );
}

#[test]
fn a_long_sweep_stays_small() {
    let mut map = map();
    let row: Vec<f64> = (0..=480).map(|bin| 0.5 / f64::from(1 + bin * 7919 % 997)).collect();
    map.engine_orders = (0..=480).map(|bin| f64::from(bin) / 20.0).collect();
    map.speeds_rad_s = (0..3000).map(|i| rad_s(10_000.0 + f64::from(i))).collect();
    map.amplitude = vec![Some(row); 3000];
    assert!(
        interaction_map(&map, None, None, VerticalAxis::Frequency, Window::default(), LevelColour::Plain)
            .len()
            < 2_000_000
    );
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

/// Width, height and the red, green, blue and opacity of every pixel of an image.
fn decoded(image: &[u8]) -> (u32, u32, Vec<u8>) {
    let mut reader = png::Decoder::new(std::io::Cursor::new(image)).read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    let frame = reader.next_frame(&mut pixels).unwrap();
    assert_eq!((frame.color_type, frame.bit_depth), (png::ColorType::Rgba, png::BitDepth::Eight));
    (frame.width, frame.height, pixels)
}

/// Corners of a path of straight lines.
fn corners(path: Node) -> Vec<(f64, f64)> {
    let steps = path.attribute("d").unwrap().split(['M', 'L']).skip(1);
    let pair = |step: &str| step.split_once(' ').map(|(x, y)| (x.parse().unwrap(), y.parse().unwrap()));
    steps.map(|step| pair(step).unwrap()).collect()
}

/// Height to which a label of the vertical axis points.
fn level(drawing: &Document, label: &str) -> f64 {
    number(drawing.descendants().find(|node| node.text() == Some(label)).unwrap(), "y") - 4.5
}

fn is_near(a: f64, b: f64) -> bool {
    (a - b).abs() < 0.03
}
