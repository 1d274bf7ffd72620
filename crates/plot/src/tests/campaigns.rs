//! Drawings of campaigns.

use roxmltree::Document;
use serde_json::{Value, json};

use super::pens::figure;
use super::pens::svg::campaign;
use super::{of_class, units};
use rubmap_analysis::result::Campaign;

/// Campaign of twelve designs over clearance and damping, at four speeds; one has no result at the last.
pub(super) fn designs() -> Campaign {
    let parameter =
        |name: &str, at: &str| json!({"name": name, "at": [at], "from": 0.0, "to": 1.0, "levels": 4});
    let values: Vec<[f64; 2]> = (0..12)
        .map(|index| [0.2 + 0.05 * f64::from(index / 3), 0.002 + 0.002 * f64::from(index % 3)])
        .collect();
    let design = |(index, values): (usize, &[f64; 2])| {
        let severity =
            |speed: usize| 0.3 - 0.8 * (values[0] - 0.2) - 20.0 * (values[1] - 0.002) - 0.02 * speed as f64;
        let by_speed: Vec<Value> = (0..4)
            .map(|speed| if (index, speed) == (11, 3) { Value::Null } else { json!(severity(speed)) })
            .collect();
        json!({"index": index, "values": values, "finished": if index == 11 { 3 } else { 4 }, "diverged": 0, "failed": 0, "by_speed": by_speed,
            "severity": severity(0), "worst_speed_rad_s": 2000.0, "meets_limit": severity(0) <= 0.2})
    };
    let sensitivity = |name: &str, first: f64, total: f64| json!({"parameter": name, "first_order": first, "first_order_error": 0.05, "total": total, "total_error": 0.04});
    let mut settings = json!({
        "sweep": super::map().settings, "parameters": [parameter("clearance", "/scene/casing/clearance/leading"),
            parameter("damping", "/scene/damping/modal_ratio")],
        "design": {"kind": "grid"}, "severity": "amplitude", "limit": 0.2, "threshold": {"parameter": "clearance"},
    });
    settings["designs"] = json!(values);
    serde_json::from_value(json!({
        "speeds_rad_s": [2000.0, 2100.0, 2200.0, 2300.0],
        "designs": values.iter().enumerate().map(design).collect::<Vec<_>>(),
        "sensitivities": {"mean": 0.2, "variance": 0.01, "blocks": 64,
            "parameters": [sensitivity("damping", 0.2, 0.3), sensitivity("clearance", 0.65, 0.78)]},
        "threshold": {"parameter": "clearance", "probability": 0.95, "value": 0.31, "from": 0.29, "to": 0.34, "decided": 12, "shares": [],
            "message": "the limit is met with a probability of 95 %"},
        "spent": {"computing_time_s": 1.0, "steps": 10}, "units": units(), "settings": settings, "version": "0",
    }))
    .unwrap()
}

#[test]
fn the_limit_stands_in_the_map_of_its_parameter_and_bars_begin_with_the_most() {
    let drawing = campaign(&designs(), 0);
    let read = Document::parse(&drawing).unwrap();
    assert_eq!(of_class(&read, "threshold").count(), 1);
    assert_eq!(of_class(&read, "bar").count(), 4);
    let widths: Vec<f64> =
        of_class(&read, "bar").map(|bar| bar.attribute("width").unwrap().parse().unwrap()).collect();
    // Sensitivities of clearance and damping alone, then with others.
    assert!(widths[2] > widths[0] && widths[0] > widths[3] && widths[3] > widths[1], "{widths:?}");
    assert!((widths[0] / widths[2] - 0.65 / 0.78).abs() < 1e-3, "{widths:?}");
    for words in ["12 designs, 47 of 48 simulations", "amplitude, mm", "95 %"] {
        assert!(drawing.contains(words), "{words}");
    }
    let other = campaign(&designs(), 1);
    assert_eq!(of_class(&Document::parse(&other).unwrap(), "threshold").count(), 0);
}

/// Cells show the most severe of the designs with the same value; nothing where nothing is known.
#[test]
fn the_map_has_the_most_severe_of_each_value() {
    let of = designs();
    let map = of.map(0);
    assert_eq!(map.len(), 4);
    for (value, by_speed) in &map {
        let expected = 0.3 - 0.8 * (value - 0.2);
        assert!((by_speed[0].unwrap() - expected).abs() < 1e-12);
    }
    // The design without a result has the heaviest damping, and others have its clearance.
    assert!(map[3].1[3].is_some() && of.map(1).len() == 3);
    let figure = serde_json::to_value(figure::campaign(&of, 0)).unwrap();
    assert_eq!(figure["data"][0]["z"].as_array().unwrap().len(), 4);
    assert_eq!(figure["data"][0]["z"][0].as_array().unwrap().len(), 4);
    assert_eq!(figure["layout"]["yaxis2"]["ticktext"], json!(["clearance", "damping"]));
}

#[test]
fn a_campaign_without_results_is_drawn_as_well() {
    let mut of = designs();
    of.designs.iter_mut().for_each(|design| design.outcome.by_speed.fill(None));
    (of.sensitivities, of.threshold) = (None, None);
    assert!(campaign(&of, 1).contains("no result"));
    figure::campaign(&of, 1);
}

/// Campaign of [`designs`] with a compared model that is more severe at the first speed, less at the second, unclear at the third and not
/// known at the last.
pub(super) fn compared() -> Campaign {
    let mut of = designs();
    for design in &mut of.designs {
        design.compared = Some(design.outcome.clone());
    }
    let difference = |mean: f64, verdict: &str| json!({"pairs": 12, "mean": mean, "standard_error": 0.01, "from": mean - 0.02, "to": mean + 0.02, "resolution": 1e-4, "verdict": verdict});
    let by_speed = [
        difference(0.05, "greater"),
        difference(-0.04, "smaller"),
        difference(0.01, "undecided"),
        Value::Null,
    ];
    let comparison = json!({"model": "n", "severity": difference(0.05, "greater"), "by_speed": by_speed, "message": "the model that is compared is more severe"});
    of.comparison = serde_json::from_value(comparison).unwrap();
    of
}

#[test]
fn differences_stand_below_the_map_at_their_speeds() {
    let drawing = campaign(&compared(), 0);
    let read = Document::parse(&drawing).unwrap();
    let marks: Vec<_> = of_class(&read, "difference").collect();
    assert_eq!(marks.len(), 3);
    let dot = |mark: &roxmltree::Node<'_, '_>| {
        let dot = mark.descendants().find(|node| node.has_tag_name("circle")).unwrap();
        let number = |name: &str| dot.attribute(name).unwrap().parse::<f64>().unwrap();
        (number("cx"), number("cy"))
    };
    let places: Vec<_> = marks.iter().map(dot).collect();
    // Speeds are evenly spaced; upwards is more.
    assert!((places[1].0 - places[0].0 - (places[2].0 - places[1].0)).abs() < 0.1, "{places:?}");
    assert!(places[0].1 < places[2].1 && places[2].1 < places[1].1, "{places:?}");
    for words in ["94 of 96 simulations", "more severe", "no larger than its errors"] {
        assert!(drawing.contains(words), "{words}");
    }
    assert_eq!(of_class(&Document::parse(&campaign(&designs(), 0)).unwrap(), "difference").count(), 0);
    let figure = serde_json::to_value(figure::campaign(&compared(), 0)).unwrap();
    let on_third = figure["data"].as_array().unwrap().iter().filter(|trace| trace["yaxis"] == "y3");
    assert_eq!(on_third.count(), 3);
}
