//! Drawings of stress and validity read back.

use roxmltree::Document;
use rubmap_analysis::result::{
    CriticalSpeeds, InteractionMap, PointStress, Strengths, SweepStress, Validity,
};
use serde_json::{Value, json};

use super::pens::svg::{critical_speeds, haigh, interaction_map, map_sheet};
use super::{critical, level, map, number, of_class, tick, units};
use crate::{HaighColour, LevelColour, VerticalAxis, Window};

/// Strengths of the blade: fatigue 120 and ultimate 400.
pub(super) fn strengths() -> Vec<Strengths> {
    serde_json::from_value(json!([
        {"set": "BLADE", "fatigue": 120.0, "ultimate": 400.0, "yield": 350.0, "source": "2e8 cycles, a <handbook>"},
        {"set": "DISK", "yield": 300.0},
    ]))
    .unwrap()
}

/// Stress with cycles about `mean` and `alternating`, of a blade and a disk.
pub(super) fn stress(mean: f64, alternating: f64) -> PointStress {
    let cycle = |node: u64, share: f64| {
        let (mean, alternating) = (share * mean, share * alternating);
        json!({"node": node, "position": [1.0, 2.0, 3.0], "sector": 4, "set": "BLADE", "mean": mean, "alternating": alternating,
            "principal_mean": 1.1 * mean, "principal_alternating": alternating, "over_yield": (mean + alternating) / 350.0,
            "utilisation": alternating / 120.0 + mean.max(0.0) / 400.0})
    };
    let cycles: Vec<Value> = (0..12).map(|i| cycle(200 + i, 1.0 - 0.06 * i as f64)).collect();
    serde_json::from_value(json!({
        "largest": {"von_mises": mean.abs() + alternating, "node": 200, "position": [1.0, 2.0, 3.0], "sector": 4, "revolution": 19.25},
        "largest_static": 210.0, "cycles": cycles, "excluded_radius": 2.5, "excluded_nodes": 17, "followed_nodes": 40,
    }))
    .unwrap()
}

pub(super) fn validity(verdict: &str, over_thickness: f64) -> Validity {
    let check = |what: &str, value: f64, doubtful: f64, beyond: f64| json!({"what": what, "value": value, "doubtful_above": doubtful, "beyond_above": beyond});
    serde_json::from_value(json!({"verdict": verdict, "checks": [
        check("displacement_over_thickness", over_thickness, 0.5, 2.0), check("rotation", 0.01, 0.1, 0.3),
    ]}))
    .unwrap()
}

/// Map of five speeds; linear theory is doubtful at the fourth and left at the fifth.
pub(super) fn stressed_map() -> InteractionMap {
    let mut map = map();
    let verdicts = [("linear", 0.1), ("linear", 0.2), ("linear", 0.3), ("doubtful", 1.2), ("beyond", 12.9)];
    for (point, (verdict, value)) in map.points.iter_mut().zip(verdicts) {
        if point.index != 2 {
            point.stress = Some(stress(100.0, 20.0 * f64::from(1 + point.index)));
            point.validity = Some(validity(verdict, value));
        }
    }
    map
}

pub(super) fn of_sweep(map: &InteractionMap) -> SweepStress {
    serde_json::from_value(json!({
        "speeds": map.points.iter().filter_map(|point| Some(json!({
            "index": point.index, "speed_rad_s": point.speed_rad_s, "stress": point.stress.as_ref()?, "validity": point.validity,
        }))).collect::<Vec<_>>(),
        "strengths": strengths(), "units": units(), "settings": map.settings, "version": "0",
    }))
    .unwrap()
}

/// Cycles stand at their mean and alternating stress, and Goodman's line of 1 ends at both strengths.
#[test]
fn cycles_and_limits_stand_where_the_axes_say() {
    let mut found = of_sweep(&stressed_map());
    found.speeds.truncate(1);
    found.speeds[0].stress = stress(100.0, 40.0);
    found.speeds[0].stress.cycles.truncate(1);
    for by in [HaighColour::Speed, HaighColour::Utilisation] {
        let drawing = haigh(&found, by);
        let read = Document::parse(&drawing).unwrap();
        let (x, y) = (|value: &str| tick(&read, value), |value: &str| level(&read, value));
        let dot = of_class(&read, "cycle").next().unwrap();
        assert!((number(dot, "cx") - x("100")).abs() < 0.1 && (number(dot, "cy") - y("40")).abs() < 0.1);
        let whole = of_class(&read, "goodman").last().unwrap();
        let corners = super::corners(whole);
        assert!((corners[1].0 - x("0")).abs() < 0.1 && (corners[1].1 - y("120")).abs() < 0.1, "{corners:?}");
        assert!((corners[2].0 - x("400")).abs() < 0.1 && corners[2].1 > y("20"), "{corners:?}");
        assert_eq!(of_class(&read, "goodman").count(), 4, "the disk has no fatigue strength");
        assert_eq!(of_class(&read, "yield").count(), 2);
        let words: String = read.descendants().filter_map(|node| node.text()).collect::<Vec<_>>().join("|");
        // 40/120 + 100/400.
        for expected in [
            "largest utilisation 0.583 at node 200, blade 4, 10,000 rpm",
            "17 nodes of a sector within 2.50 mm",
            "a <handbook>",
            "utilisation 0.25, 0.5, 0.75",
            "node 200, blade 4",
            "mean stress (signed von Mises), MPa",
        ] {
            assert!(words.contains(expected), "{expected}: {words}");
        }
    }
}

#[test]
fn a_haigh_diagram_of_little_is_still_a_drawing() {
    let mut found = of_sweep(&stressed_map());
    found.strengths.clear();
    for speed in &mut found.speeds {
        speed.stress.lacking = Some("no fatigue strength <of> BLADE".to_owned());
        for cycle in &mut speed.stress.cycles {
            cycle.utilisation = None;
            cycle.mean = -cycle.mean;
        }
    }
    let mut empty = found.clone();
    empty.speeds.clear();
    let mut huge = found.clone();
    huge.speeds[0].stress.cycles[0].mean = f64::NAN;
    huge.speeds[0].stress.cycles[1].alternating = 1e300;
    for (found, words) in [
        (&found, "no fatigue strength &lt;of&gt; BLADE"),
        (&empty, "no stress was recorded"),
        (&huge, "most alternating"),
    ] {
        for by in [HaighColour::Speed, HaighColour::Utilisation] {
            let drawing = haigh(found, by);
            assert!(Document::parse(&drawing).is_ok() && drawing.contains(words), "{drawing}");
            assert!(!drawing.contains("NaN") && !drawing.contains("inf\""));
        }
    }
}

fn texts(drawing: &str) -> String {
    let read = Document::parse(drawing).unwrap();
    read.descendants().filter_map(|node| node.text()).collect::<Vec<_>>().join("|")
}

/// Critical speeds of the map: linear theory is doubtful at 13,000 rpm.
pub(super) fn stressed_critical() -> CriticalSpeeds {
    let mut critical = critical();
    let map = stressed_map();
    for speed in &mut critical.critical_speeds {
        let point = &map.points[speed.index as usize];
        (speed.utilisation, speed.validity) = (point.utilisation(), point.validity_verdict());
    }
    critical
}

/// Speeds at which linear theory is doubtful or left are marked with the deciding number; other speeds have no mark.
#[test]
fn the_map_marks_where_linear_theory_does_not_hold() {
    let drawn = |map: &InteractionMap, by| {
        interaction_map(
            map,
            Some(&stressed_critical()),
            None,
            VerticalAxis::EngineOrder,
            Window::default(),
            by,
        )
    };
    let drawing = drawn(&stressed_map(), LevelColour::Plain);
    let read = Document::parse(&drawing).unwrap();
    let marked: Vec<(f64, &str)> = of_class(&read, "validity")
        .map(|area| {
            let middle = number(area, "x") + 0.5 * number(area, "width");
            (middle, area.first_element_child().unwrap().text().unwrap())
        })
        .collect();
    assert_eq!(marked.len(), 2);
    for ((x, words), (speed, expected)) in marked.iter().zip([
        ("13,000", "13000 rpm: linear theory doubtful: largest displacement of a tip over the blade's thickness is 1.20, above 0.500"),
        ("14,000", "14000 rpm: beyond linear theory: largest displacement of a tip over the blade's thickness is 12.9, above 2.00"),
    ]) {
        assert!((x - tick(&read, speed)).abs() < 0.1, "{x} {speed}");
        assert_eq!(*words, expected);
    }
    let words = texts(&drawing);
    assert!(
        words.contains("|linear theory doubtful|") && words.contains("|beyond linear theory|"),
        "{words}"
    );
    assert!(!words.contains("utilisation"), "it was not asked for");
    let plain = drawn(&map(), LevelColour::Plain);
    assert!(!plain.contains("validity") && !plain.contains("linear theory"));
}

#[test]
fn the_level_is_coloured_by_utilisation_on_request() {
    let (map, critical) = (stressed_map(), stressed_critical());
    let by = LevelColour::Utilisation;
    let drawing =
        interaction_map(&map, Some(&critical), None, VerticalAxis::EngineOrder, Window::default(), by);
    let read = Document::parse(&drawing).unwrap();
    let found: Vec<&str> =
        of_class(&read, "utilisation").filter_map(|bar| bar.first_element_child()?.text()).collect();
    // 100/400 and 20, 40, 80, 100 over 120.
    let expected = [
        "10000 rpm: utilisation 0.417",
        "11000 rpm: utilisation 0.583",
        "13000 rpm: utilisation 0.917",
        "14000 rpm: utilisation 1.08",
    ];
    assert_eq!(found, expected);
    let words = texts(&drawing);
    for words_of_key in
        ["from 0.25", "from 0.5", "from 0.75", "1 and above", "U utilisation", "11,000 rpm · U 0.583"]
    {
        assert!(words.contains(words_of_key), "{words_of_key}: {words}");
    }
    assert!(!words.contains("below 0.25"));
}

#[test]
fn a_sheet_has_strips_of_utilisation_on_request() {
    let maps = vec![stressed_map(); 3];
    let drawing = map_sheet(&maps, Window::default(), LevelColour::Utilisation);
    let read = Document::parse(&drawing).unwrap();
    assert_eq!(of_class(&read, "utilisation").count(), 3 * 4, "of every map what is known");
    let words = texts(&drawing);
    assert!(words.contains("1 and above") && !words.contains("below 0.25"), "{words}");
    assert!(!map_sheet(&maps, Window::default(), LevelColour::Plain).contains("utilisation"));
}

#[test]
fn critical_speeds_say_their_margin_and_validity() {
    let drawing = critical_speeds(&stressed_critical());
    let read = Document::parse(&drawing).unwrap();
    assert_eq!(of_class(&read, "validity").count(), 2, "one peak, and the key");
    let words = texts(&drawing);
    for expected in [
        "11,000 rpm · EO 2 · U 0.583",
        "13,000 rpm · EO 2 · U 0.917 *",
        "linear theory doubtful",
        "|utilisation|",
    ] {
        assert!(words.contains(expected), "{expected}: {words}");
    }
    assert!(!words.contains("beyond linear theory"));
    let before = critical_speeds(&critical());
    assert!(!before.contains("validity") && !before.contains("utilisation"));
}
