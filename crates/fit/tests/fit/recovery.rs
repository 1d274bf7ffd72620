//! Wheels that are found again from their own frequencies.

use crate::common::{Kept, request, targets, wheel};
use rubmap_fit::{FitError, FitResult, Problem, Unit, fit};
use serde_json::json;

const SPEEDS_RPM: [f64; 2] = [0.0, 24_000.0];

/// Values sought: some 10 % away from those at which the search begins.
const SOUGHT: [(&str, f64); 3] = [("axial_length", 66.0), ("rim_thickness", 7.8), ("root_thickness", 1.9)];

/// Axial length of a wheel whose mesh differs from that of the start.
const LONG: f64 = 68.0;

fn bounds() -> serde_json::Value {
    json!({"axial_length": [50.0, 75.0], "rim_thickness": [5.0, 9.0], "root_thickness": [1.2, 2.4]})
}

fn sought() -> rubmap_model::impeller::ImpellerRequest {
    wheel(&json!({"axial_length": 66.0, "rim_thickness": 7.8, "root_thickness": 1.9}))
}

fn assert_recovered(result: &FitResult, tolerance: f64) {
    for ((name, value), found) in SOUGHT.iter().zip(&result.unknowns) {
        assert_eq!(found.name, *name);
        assert!((found.value / value - 1.0).abs() < tolerance, "{name}: {} is not {value}", found.value);
        assert_eq!(found.at, None);
    }
}

/// Modes of few unknowns at any speed against the reduction, which has other shapes and hundreds of unknowns.
#[test]
fn frequencies_are_those_of_the_reduction() {
    let mut request = request(sought(), bounds(), targets(&sought(), &[0.0, 13_000.0, 31_000.0]));
    // The wheel is right already.
    request.iterations = 1;
    let result = fit(&Problem::new(request).unwrap(), Vec::new(), &Kept::default()).unwrap();
    assert!(result.largest_percent < 1e-4, "{result:#?}");
}

#[test]
fn parameters_are_recovered() {
    let request = request(wheel(&json!({})), bounds(), targets(&sought(), &SPEEDS_RPM));
    let result = fit(&Problem::new(request).unwrap(), Vec::new(), &Kept::default()).unwrap();
    assert!(result.met && result.largest_percent < 1e-3, "{result:#?}");
    assert_recovered(&result, 1e-4);
    // The wheel that is written is the one whose frequencies were found.
    assert!((result.parameters.rim_thickness - result.unknowns[1].value).abs() < 1e-12);
}

#[test]
fn a_free_unit_is_found() {
    // A unit of 431 Hz: frequencies and revolutions in the same time.
    let hz = 431.0;
    let mut targets = targets(&sought(), &SPEEDS_RPM);
    for target in &mut targets {
        target.frequency /= hz;
        target.speed /= 60.0 * hz;
    }
    let mut request = request(wheel(&json!({})), bounds(), targets);
    request.unit = Unit::Free;
    let result = fit(&Problem::new(request.clone()).unwrap(), Vec::new(), &Kept::default()).unwrap();
    assert_recovered(&result, 1e-3);
    // Wheels of one shape and any size have the same frequencies but for the unit: here lengths are given, and the unit follows.
    assert!((result.unit_hz.unwrap() / hz - 1.0).abs() < 1e-4, "{result:#?}");

    // A wheel that is right already, in another unit: nothing but the unit is sought.
    request.wheel = sought();
    let result = fit(&Problem::new(request).unwrap(), Vec::new(), &Kept::default()).unwrap();
    assert!((result.unit_hz.unwrap() / hz - 1.0).abs() < 1e-6, "{result:#?}");
}

/// On the mesh of the longer wheel the clamp has one more station, which changes frequencies by more than what is asked of them.
#[test]
fn wheels_with_another_clamp_on_the_mesh_are_recovered() {
    let long = wheel(&json!({"contact_nodes": 8, "axial_length": LONG}));
    let bounds = json!({"axial_length": [50.0, 90.0], "rim_thickness": [5.0, 9.0]});
    let request = request(wheel(&json!({"contact_nodes": 8})), bounds, targets(&long, &[0.0]));
    let result = fit(&Problem::new(request).unwrap(), Vec::new(), &Kept::default()).unwrap();
    assert!(result.starts[0].legs > 1, "{result:#?}");
    assert!(result.largest_percent < 1e-3, "{result:#?}");
    assert!((result.unknowns[0].value / LONG - 1.0).abs() < 1e-4);
}

/// A unit of its own and Young's modulus scale all frequencies at rest alike.
#[test]
fn unknowns_that_targets_leave_open_have_no_deviation() {
    let mut request = request(
        wheel(&json!({})),
        json!({"material.youngs_modulus": [1e5, 1.3e5], "rim_thickness": [5.0, 9.0]}),
        targets(&wheel(&json!({"rim_thickness": 7.8})), &[0.0]),
    );
    request.unit = Unit::Free;
    let result = fit(&Problem::new(request).unwrap(), Vec::new(), &Kept::default()).unwrap();
    let known: Vec<(&str, bool)> = result
        .unknowns
        .iter()
        .map(|found| (found.name.as_str(), found.standard_deviation.is_some()))
        .collect();
    assert_eq!(known, [("material.youngs_modulus", false), ("rim_thickness", true), ("unit", false)]);
}

#[test]
fn targets_that_no_wheel_has_are_missed_by_what_the_rows_say() {
    let mut targets = targets(&wheel(&json!({})), &[0.0]);
    // Rotation stiffens a blade by a few percent, not by a fifth, and two nearly equal speeds cannot differ so.
    let mut other = targets[1];
    other.speed = 1.0;
    other.frequency *= 1.2;
    targets.push(other);
    let asked = targets[1].frequency;
    let request = request(wheel(&json!({})), json!({"root_thickness": [1.2, 2.4]}), targets);
    let result = fit(&Problem::new(request).unwrap(), Vec::new(), &Kept::default()).unwrap();
    assert!(!result.met);
    let [low, high] = [1, 5].map(|index| &result.targets[index]);
    assert!(!low.met || !high.met);
    assert!((low.found / high.found - 1.0).abs() < 1e-5, "one mode has one frequency");
    assert!((low.difference_percent - 100.0 * (low.found / asked - 1.0)).abs() < 1e-9);
    assert!((high.difference_percent - 100.0 * (high.found / (1.2 * asked) - 1.0)).abs() < 1e-9);
    assert!(low.difference_percent - high.difference_percent > 15.0);
}

#[test]
fn two_frequencies_of_one_mode_are_refused() {
    let mut targets = targets(&wheel(&json!({})), &[0.0]);
    let mut other = targets[2];
    other.frequency *= 1.05;
    targets.push(other);
    let request = request(wheel(&json!({})), json!({"root_thickness": [1.2, 2.4]}), targets);
    let error = Problem::new(request).unwrap_err();
    assert!(matches!(error, FitError::SameMode { first: 2, second: 5, .. }));
    assert!(error.to_string().contains("5.000 % apart"), "{error}");
}
