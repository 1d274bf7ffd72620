//! Periodic responses: solved for, taken or not, and recorded.

use serde_json::{Value, json};

use super::app::{Api, TestApp, sweep_of};
use super::model;

fn steady_sweep(model: &str, how: &str) -> Value {
    let mut sweep = sweep_of(model);
    sweep["integration"]["steady"] = json!(how);
    sweep["scene"]["damping"] = json!({"modal_ratio": 0.02});
    sweep
}

async fn points(api: &Api, sweep: &Value) -> Vec<Value> {
    let id = api.sweep(sweep).await;
    let job = api.finish(&id).await;
    assert_eq!(job["status"], "successful", "{job}");
    let map = api.get(&format!("/v1/jobs/{id}/interaction-map")).await;
    map.body["points"].as_array().unwrap().clone()
}

fn amplitude(point: &Value) -> f64 {
    point["responses"][0]["half_peak_to_peak"].as_f64().unwrap()
}

#[tokio::test]
async fn periodic_responses_are_those_that_marches_come_to() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let mut long = steady_sweep(&model, "march");
    long["integration"]["revolutions"] = json!(400);
    let marched = points(api, &long).await;
    let solved = points(api, &steady_sweep(&model, "auto")).await;
    assert!(marched.iter().all(|point| point["steady"].is_null()));
    let mut taken = 0;
    for (solved, marched) in solved.iter().zip(&marched) {
        let steady = &solved["steady"];
        assert!(steady["revolutions"].as_f64().unwrap() > 0.0, "{steady}");
        if steady["taken"] == false {
            assert!(steady["reason"].is_string(), "{steady}");
            continue;
        }
        taken += 1;
        assert_eq!(steady["stability"], "stable");
        assert!(steady["multipliers"][0]["modulus"].as_f64().unwrap() < 1.0, "{steady}");
        assert_eq!(solved["settling"]["verdict"], "periodic");
        let (found, expected) = (amplitude(solved), amplitude(marched));
        assert!((found - expected).abs() <= 1e-6 * expected, "{found} {expected}: {steady}");
        assert_eq!(steady["half_peak_to_peak"][0].as_f64(), Some(found));
    }
    assert!(taken > 0, "{solved:?}");
}

#[tokio::test]
async fn effects_that_have_no_map_are_marched_and_say_so() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let mut sweep = steady_sweep(&model, "periodic");
    sweep["scene"]["friction"] = json!({"coefficient": 0.1});
    let plan = api.post("/v1/sweeps/plan", &sweep).await;
    assert_eq!(plan.status, 200, "{}", plan.body);
    for point in points(api, &sweep).await {
        assert_eq!(point["steady"]["taken"], false);
        let reason = point["steady"]["reason"].as_str().unwrap();
        assert!(reason.contains("effects beyond damping and a rigid casing"), "{reason}");
        assert!(amplitude(&point) > 0.0);
    }
}

/// Speed by speed, with histories of the periodic response beside.
#[tokio::test]
async fn histories_of_a_periodic_response_are_recorded_from_it() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let mut sweep = steady_sweep(&model, "periodic");
    let revolutions = sweep["integration"]["revolutions"].as_u64().unwrap_or(50);
    sweep["record"] = json!({"histories": {
        "speeds": [0], "quantities": ["displacement", "velocity", "state"],
        "revolutions": [revolutions - 2, revolutions],
    }});
    let id = api.sweep(&sweep).await;
    assert_eq!(api.finish(&id).await["status"], "successful");
    let map = api.get(&format!("/v1/jobs/{id}/interaction-map")).await.body;
    let steady = &map["points"][0]["steady"];
    assert_eq!(steady["taken"], true, "{steady}");
    let histories = api.get(&format!("/v1/jobs/{id}/histories?speed=0")).await;
    assert_eq!(histories.status, 200, "{}", histories.body);
    assert_eq!(&histories.body["point"]["steady"], steady);
    let line: Vec<f64> = histories.body["sensors"][0]["displacement"]
        .as_array()
        .unwrap()
        .iter()
        .map(|value| value.as_f64().unwrap())
        .collect();
    let (first, second) = line.split_at(line.len() / 2);
    assert_eq!(first, second);
    let (low, high) = line.iter().fold((f64::MAX, f64::MIN), |(l, h), &x| (l.min(x), h.max(x)));
    assert!((0.5 * (high - low) - amplitude(&map["points"][0])).abs() < 1e-12 * high.abs());
    let fields = api.request("GET", &format!("/v1/jobs/{id}/fields?speed=0")).send().await.unwrap();
    assert_eq!(fields.status(), 200);
}
