//! Requests that make no sense, and what is said about them.

use rubmap_fit::{FitError, FitRequest, Problem};
use serde_json::{Value, json};

fn good() -> Value {
    json!({
        "wheel": {"preset": "small"},
        "vary": {"rim_thickness": [5, 9], "material.youngs_modulus": [1e5, 1.3e5]},
        "unit": "hz_and_rpm",
        "targets": [
            {"nodal_diameter": 0, "family": 1, "speed": 0, "frequency": 3000},
            {"nodal_diameter": 5, "family": 2, "speed": 24000, "frequency": 4000},
        ],
    })
}

fn refused(change: impl FnOnce(&mut Value)) -> String {
    let mut request = good();
    change(&mut request);
    let checked: Result<Problem, FitError> =
        FitRequest::from_json(&request.to_string()).and_then(Problem::new);
    checked.unwrap_err().to_string()
}

#[test]
fn a_good_request_is_taken() {
    let problem = FitRequest::from_json(&good().to_string()).and_then(Problem::new).unwrap();
    assert_eq!(problem.unknowns(), ["material.youngs_modulus", "rim_thickness"]);
    assert_eq!(problem.goals[1].tolerance, 0.02);
}

#[test]
fn errors_name_the_field() {
    type Case = (fn(&mut Value), &'static [&'static str]);
    let cases: &[Case] = &[
        (|r| r["vary"]["colour"] = json!([1, 2]), &["`vary.colour`", "no such number"]),
        (|r| r["vary"]["material"] = json!([1, 2]), &["`vary.material`", "no such number"]),
        (|r| r["vary"]["sectors"] = json!([8, 12]), &["`vary.sectors`", "whole things"]),
        (|r| r["vary"]["mesh.disk"] = json!([2, 4]), &["`vary.mesh.disk`", "whole things"]),
        (
            |r| r["vary"]["splitter.leading_edge"] = json!([0.2, 0.5]),
            &["`vary.splitter.leading_edge`", "whole elements"],
        ),
        (|r| r["vary"]["top_speed_rad_s"] = json!([1, 2]), &["`vary.top_speed_rad_s`", "no property"]),
        (
            |r| r["vary"]["rim_thickness"] = json!([9, 5]),
            &["`vary.rim_thickness` = [9, 5]", "below the upper"],
        ),
        (|r| r["vary"]["rim_thickness"] = json!([5, 5]), &["`vary.rim_thickness` = [5, 5]"]),
        (|r| r["vary"]["rim_thickness"] = json!([5]), &["vary.rim_thickness"]),
        (|r| r["vary"] = json!({}), &["`vary` = 0 parameters"]),
        (|r| r["targets"][1]["family"] = json!(0), &["`targets[1].family` = 0"]),
        (|r| r["targets"][1]["nodal_diameter"] = json!(6), &["`targets[1].nodal_diameter` = 6", "half"]),
        (|r| r["targets"][1]["nodal_diameter"] = json!(-1), &["targets[1].nodal_diameter"]),
        (|r| r["targets"][1]["speed"] = json!(40000), &["`targets[1].speed` = 40000 rpm", "38197.2 rpm"]),
        (|r| r["targets"][1]["speed"] = json!(-1), &["`targets[1].speed` = -1"]),
        (|r| r["targets"][0]["frequency"] = json!(0), &["`targets[0].frequency` = 0"]),
        (|r| r["targets"][0]["error"] = json!(0), &["`targets[0].error` = 0"]),
        (|r| r["targets"][0]["frequenzy"] = json!(0), &["targets[0].frequenzy", "unknown field"]),
        (
            |r| r["targets"] = json!([r["targets"][0]]),
            &["1 targets for 2 unknowns", "material.youngs_modulus, rim_thickness"],
        ),
        (|r| r["unit"] = json!("furlongs"), &["`unit`", "hz_and_rpm"]),
        (|r| r["unit"] = json!("free"), &["2 targets for 3 unknowns", "unit"]),
        (|r| r["starts"] = json!(0), &["`starts` = 0"]),
        (|r| r["candidates"] = json!(3), &["`candidates` = 3", "at least `starts`"]),
        (|r| r["iterations"] = json!(1001), &["`iterations` = 1001"]),
        (|r| r["tolerance"] = json!(-0.1), &["`tolerance` = -0.1"]),
        (|r| r["wheel"]["rim_thickness"] = json!(-1), &["`wheel`", "`rim_thickness` = -1"]),
        (|r| r["wheel"]["rimm"] = json!(1), &["`wheel`", "rimm"]),
    ];
    for (change, expected) in cases {
        let message = refused(change);
        assert!(expected.iter().all(|part| message.contains(part)), "{message} lacks one of {expected:?}");
    }
}

/// JSON has no NaN, programs have.
#[test]
fn numbers_that_are_none_are_refused() {
    let request = || FitRequest::from_json(&good().to_string()).unwrap();
    let refused = |request: FitRequest| Problem::new(request).unwrap_err().to_string();
    let mut speed = request();
    speed.targets[0].speed = f64::NAN;
    assert!(refused(speed).contains("`targets[0].speed` = NaN"));
    let mut frequency = request();
    frequency.targets[1].frequency = f64::INFINITY;
    assert!(refused(frequency).contains("`targets[1].frequency` = inf"));
    let mut bounds = request();
    bounds.vary.insert("rim_thickness".to_owned(), [f64::NAN, 9.0]);
    assert!(refused(bounds).contains("`vary.rim_thickness` = [NaN, 9]"));
}

#[test]
fn the_example_of_the_documentation_is_taken() {
    let text = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/fit.md")).unwrap();
    let example = text.split("```json\n").nth(1).unwrap().split("```").next().unwrap();
    let problem = FitRequest::from_json(example).and_then(Problem::new).unwrap();
    assert_eq!((problem.variables.len(), problem.goals.len()), (3, 4));
}
