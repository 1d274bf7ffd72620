//! Interference diagrams against points by hand.

use std::f64::consts::TAU;

use roxmltree::Document;
use serde_json::{Value, json};

use super::pens::{figure, svg};
use super::{modes, waves};
use rubmap_analysis::result::{AskedInterference, Campbell, Course, FollowedFamilies, Interference, Veering};

/// Diagram of `campbell`, which has three nodal diameters and 10,000 to 14,000 rpm, on so many sectors at 12,000 rpm with two lobes.
pub(super) fn of(campbell: &Campbell, sectors: u32) -> Interference {
    let speed = |hz: f64| TAU * hz;
    let asked = AskedInterference {
        speed_rad_s: speed(200.0),
        lobes: 2,
        max_engine_order: 9,
        range_rad_s: Some([speed(180.0), speed(220.0)]),
    };
    Interference::of(campbell, sectors, asked).unwrap()
}

fn traces(figure: &Value, name: &str) -> Vec<[Vec<Value>; 2]> {
    let list = |trace: &Value, axis: &str| trace[axis].as_array().unwrap().clone();
    let named = figure["data"].as_array().unwrap().iter().filter(|trace| trace["name"] == name);
    named.map(|trace| [list(trace, "x"), list(trace, "y")]).collect()
}

/// The zig-zag turns at nodal diameter 0 and at N/2, which on an odd number lies between two.
#[test]
fn the_zigzag_turns_at_half_the_sectors() {
    for sectors in [1_u32, 2, 4, 5] {
        let figure = json!(figure::interference(&of(&modes(), sectors)));
        let half = 0.5 * f64::from(sectors);
        for (name, first) in [("engine orders k = aN + i", 0), ("engine orders k = aN − i", 1)] {
            let found = traces(&figure, name);
            let [[x, y]] = &found[..] else { panic!("{name} of {sectors} sectors") };
            let expected = if first == 0 { [0.0, half] } else { [half, 0.0] };
            let orders = [f64::from(first) * half, f64::from(first + 1) * half];
            for end in 0..2 {
                assert!((x[end].as_f64().unwrap() - expected[end]).abs() < 1e-12, "{name}, {sectors}: {x:?}");
                assert!((y[end].as_f64().unwrap() - 200.0 * orders[end]).abs() < 1e-9, "{name}: {y:?}");
            }
        }
    }
}

/// At 12,000 rpm an engine order is 200 Hz: of four sectors 2 drives nodal diameter 2 and 4 drives 0; the modes are at 410 + i and 902 Hz.
#[test]
fn points_are_those_by_hand() {
    let found = of(&modes(), 4);
    let figure = json!(figure::interference(&found));
    assert_eq!(figure["layout"]["meta"]["speed_rpm"].as_f64().unwrap().round(), 12_000.0);
    let family = traces(&figure, "family 1").pop().unwrap();
    let expected = [json!([0.0, 1.0, 2.0]), json!([410.0, 411.0, 412.0])];
    assert_eq!(family.map(|values| json!(values)), expected);
    let [[x, y]] = &traces(&figure, "engine orders of the lobes")[..] else { panic!() };
    assert_eq!(json!(x), json!([2.0, 0.0]));
    assert!((y[0].as_f64().unwrap() - 400.0).abs() < 1e-9 && (y[1].as_f64().unwrap() - 800.0).abs() < 1e-9);
    let drawing = svg::interference(&found);
    Document::parse(&drawing).unwrap();
    // (412 − 400)/412 of engine order 2.
    for words in
        ["+2.9 %", "EO 2", "EO 4", "nodal diameter 1, family 1: 411 Hz, not driven", "10,800 to 13,200 rpm"]
    {
        assert!(drawing.contains(words), "{words}");
    }
    assert!(drawing.contains("met in the range by 2"));
}

#[test]
fn split_waves_have_marks_of_their_own() {
    let drawing = svg::interference(&of(&waves(), 5));
    Document::parse(&drawing).unwrap();
    assert!(drawing.contains("nodal diameter 1, family 1, forward wave"));
    assert!(drawing.contains("family 1, forward waves"));
    assert!(!svg::interference(&of(&modes(), 5)).contains("forward"));
}

/// Veerings are marked at their speed and frequency, and every nodal diameter of a family has a curve.
#[test]
fn campbell_diagrams_mark_veerings() {
    let veering = Veering {
        nodal_diameter: 1,
        families: [1, 2],
        speed_rad_s: TAU * 200.0,
        frequency_hz: 650.0,
        distance_hz: 3.25,
        course: Course::Exchanges,
    };
    let followed = FollowedFamilies { veerings: vec![veering], ..FollowedFamilies::default() };
    let modes = Campbell { followed: Some(followed), ..modes() };
    let drawing = svg::campbell(&modes);
    assert!(
        drawing.contains("nodal diameter 1: families 1 and 2 veer, 3.25 Hz apart, and exchange their shapes")
    );
    assert!(drawing.contains("families by shape"));
    let figure = json!(figure::campbell(&modes));
    let [[x, y]] = &traces(&figure, "families veer or cross")[..] else { panic!() };
    assert!((x[0].as_f64().unwrap() - 12_000.0).abs() < 1e-6 && y[0] == 650.0);
    assert_eq!(traces(&figure, "family 2").len(), 3);
}
