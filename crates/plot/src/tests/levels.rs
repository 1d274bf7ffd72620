//! Drawings of the level of the wheel, read back.

use roxmltree::Document;
use serde_json::{Value, json};

use super::pens::{figure, svg};
use super::{of_class, rad_s, units};
use rubmap_analysis::result::{LimitKind, SweepLevel};

/// Level of five speeds from 10,000 to 14,000 rpm with a range and its separation, a limit of the tip motion, and one critical speed.
pub(super) fn level() -> SweepLevel {
    let mut settings = json!(super::map().settings);
    settings["limits"] = json!({"tip_motion": 0.5});
    let standings = ["kept", "reached", "open", "passed", "passed"];
    let speed = |index: usize| {
        let value = 0.2 * (1 + index) as f64;
        json!({
            "index": index, "speed_rad_s": rad_s(10_000.0 + 1000.0 * index as f64), "status": "completed",
            "values": [
                {"quantity": "tip_motion", "value": value, "error": 0.1 * value, "standing": standings[index]},
                {"quantity": "node_force", "value": 10.0 * value},
            ],
        })
    };
    let mut speeds: Vec<Value> = (0..5).map(speed).collect();
    speeds.push(json!({"index": 5, "speed_rad_s": rad_s(15_000.0), "status": "diverged", "values": []}));
    serde_json::from_value(json!({"speeds": speeds, "verdict": {
        "verdict": "act", "sentence": "Act: at 14,000 rpm.", "ranges_given": true,
        "ranges": [{"name": "cruise <1>", "verdict": "act", "from_rad_s": rad_s(12_000.0), "to_rad_s": rad_s(13_000.0), "separation_percent": 5.0,
            "speeds": 2, "missing": [], "failed": [], "diverged": [], "limits": [], "critical_inside": 1, "critical_within_separation": 0}],
        "critical_speeds": [{"index": 3, "speed_rad_s": rad_s(13_000.0), "critical": true, "resolved": true, "speed_error_rad_s": 1.0,
            "engine_order": 4.0, "nodal_diameter": 4, "ranges": [], "limits": []}],
        "worst": [], "would_decide": [], "units": units(), "settings": settings, "version": "0",
    }}))
    .unwrap()
}

#[test]
fn ranges_limits_errors_and_critical_speeds_are_where_they_belong() {
    let drawing = svg::wheel_level(&level(), None);
    let read = Document::parse(&drawing).unwrap();
    let number =
        |node: roxmltree::Node, name: &str| -> f64 { node.attribute(name).unwrap().parse().unwrap() };
    // The axis has 4000 rpm from one upright line of the separation to the other: the range's fill is 1000 rpm wide, its separation 5 % of each end.
    let ranges: Vec<roxmltree::Node> =
        of_class(&read, "range").filter(|node| node.has_tag_name("rect")).collect();
    let widths: Vec<f64> = ranges.iter().map(|node| number(*node, "width")).collect();
    assert_eq!(widths.len(), 3, "two of the separation, one of the range");
    assert!(
        (widths[0] / widths[2] - 0.6).abs() < 1e-2 && (widths[1] / widths[2] - 0.65).abs() < 1e-2,
        "{widths:?}"
    );
    assert_eq!(of_class(&read, "level").count(), 5);
    assert_eq!(of_class(&read, "error").count(), 5);
    assert_eq!(of_class(&read, "critical-speed").count(), 1);
    for words in [
        "13,000 rpm · EO 4 · ND 4",
        "cruise &lt;1&gt;",
        "limit 0.500 mm",
        "over speed: act",
        "motion diverged",
    ] {
        assert!(drawing.contains(words), "{words}");
    }
    // Another quantity has no limit, and no standing.
    let forces = svg::wheel_level(&level(), Some(LimitKind::NodeForce));
    assert!(forces.contains("contact force on a node, N") && forces.contains("no limit given"));
    assert!(!forces.contains("limit passed"));
    let nothing = svg::wheel_level(&level(), Some(LimitKind::Utilisation));
    assert!(nothing.contains("utilisation needs recorded stress and strengths"));
}

/// A value of 0.4 with a relative error of 3 is one of 0.1 to 1.6: its bar does not end below 0.
#[test]
fn a_large_error_is_a_bar_from_the_value_over_its_factor_to_the_value_times_it() {
    let mut level = level();
    level.speeds[1].values[0].error = Some(1.2);
    let figure = json!(figure::wheel_level(&level, None));
    let traces = figure["data"].as_array().unwrap();
    let trace = traces.iter().find(|trace| trace["customdata"] == json!([1])).unwrap();
    let bars = &trace["error_y"];
    assert_eq!(bars["symmetric"], false);
    let length = |name: &str| bars[name][0].as_f64().unwrap();
    assert!((length("arrayminus") - 0.3).abs() < 1e-12 && (length("array") - 1.2).abs() < 1e-12, "{bars}");
    assert!(trace["hovertext"][0].as_str().unwrap().contains("0.400 (0.100 to 1.60) mm"), "{trace}");

    let drawing = svg::wheel_level(&level, None);
    let read = Document::parse(&drawing).unwrap();
    let height = |bar: roxmltree::Node| {
        let end = |name: &str| -> f64 { bar.attribute(name).unwrap().parse().unwrap() };
        (end("y1") - end("y2")).abs()
    };
    let mut heights: Vec<f64> = of_class(&read, "error").map(height).collect();
    heights.sort_by(f64::total_cmp);
    // The longest is 1.6 - 0.1 high; the next belongs to a value of 1 and an error of 10 %: 1.1 - 1/1.1.
    assert!((heights[4] / heights[3] - 1.5 / (1.1 - 1.0 / 1.1)).abs() < 0.02, "{heights:?}");
}

#[test]
fn the_figure_has_the_labels_of_the_drawing() {
    let figure = json!(figure::wheel_level(&level(), None));
    let above: Vec<&Value> = figure["layout"]["annotations"]
        .as_array()
        .unwrap()
        .iter()
        .filter(|note| note["name"] == "above")
        .collect();
    assert_eq!(above.len(), 1);
    assert_eq!(above[0]["text"], "13,000 rpm · EO 4 · ND 4");
    assert_eq!(figure["layout"]["meta"]["quantity"], "tip_motion");
    let names: Vec<&str> =
        figure["data"].as_array().unwrap().iter().filter_map(|trace| trace["name"].as_str()).collect();
    for name in
        ["operating range", "separation asked", "limit", "limit passed", "limit kept, outside the ranges"]
    {
        assert!(names.contains(&name), "{name}: {names:?}");
    }
}
