//! Periodic responses: solved for, taken or not, and recorded.

use serde_json::{Value, json};

use super::app::{Api, TestApp, sweep_of};
use super::model;
use super::studies::study_of;

fn steady_sweep(model: &str, how: &str) -> Value {
    let mut sweep = sweep_of(model);
    sweep["integration"]["steady"] = json!(how);
    sweep["scene"]["damping"] = json!({"modal_ratio": 0.02});
    sweep
}

/// Points of a sweep that marches for so long that its responses settle.
async fn settled(api: &Api, model: &str) -> Vec<Value> {
    let mut long = steady_sweep(model, "march");
    long["integration"]["revolutions"] = json!(400);
    points(api, &long).await
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
    let marched = settled(api, &model).await;
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
async fn errors_of_what_is_solved_for_have_no_settling_in_them() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let found = async |how: &str, revolutions: u64| {
        let mut sweep = steady_sweep(&model, how);
        sweep["scene"]["damping"]["modal_ratio"] = json!(0.02);
        sweep["integration"]["revolutions"] = json!(revolutions);
        sweep["control_speeds"] = json!(6);
        let id = api.sweep(&sweep).await;
        assert_eq!(api.finish(&id).await["status"], "successful");
        let map = api.get(&format!("/v1/jobs/{id}/interaction-map")).await.body;
        let of = |list: &Value| list.as_array().unwrap().clone();
        of(&map["points"]).into_iter().zip(of(&map["errors"]["controls"])).collect::<Vec<_>>()
    };
    let [solved, settled, short] =
        [found("auto", 40).await, found("march", 600).await, found("march", 12).await];
    let (mut compared, mut settling) = (0, 0.0_f64);
    for (((point, solved), (marched, settled)), (_, short)) in solved.iter().zip(&settled).zip(&short) {
        // A response that is not taken is marched to, for no longer than the others.
        if [point, solved].iter().any(|run| run["steady"]["taken"] == false) {
            continue;
        }
        assert!((amplitude(point) / amplitude(marched) - 1.0).abs() <= 1e-6, "{point} {marched}");
        compared += 1;
        for quantity in ["amplitude", "engine_orders"] {
            let of = |control: &Value| control["differences"][quantity].as_f64().unwrap_or(f64::INFINITY);
            assert!((of(solved) - of(settled)).abs() <= 1e-6, "{quantity}: {solved} {settled}");
            settling = settling.max((of(short) - of(settled)).abs());
        }
    }
    assert!(compared >= 3 && settling > 1e-3, "{compared} {settling}");
    app.stop().await;
}

#[tokio::test]
async fn studies_and_targets_compare_what_is_solved_for() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let study = async |how: &str, revolutions: u64| {
        let mut study = study_of(&model);
        study["scene"]["damping"]["modal_ratio"] = json!(0.02);
        study["grid"] = json!({"modes_per_speed": [1, 2], "steps_per_revolution": [600, 1200],
            "schemes": ["exact_modal"]});
        study["integration"] = json!({"revolutions": revolutions, "window_revolutions": 2, "steady": how});
        let id = api.post("/v1/studies", &study).await.text("/id");
        let job = api.finish(&id).await;
        assert_eq!(job["status"], "successful", "{job}");
        let found = api.get(&format!("/v1/jobs/{id}/work-precision")).await.body;
        assert_eq!(found["settings"]["integration"]["steady"], how);
        found["speeds"].as_array().unwrap().clone()
    };
    let (solved, marched) = (study("auto", 40).await, study("march", 600).await);
    let mut compared = 0;
    for (solved, marched) in solved.iter().zip(&marched) {
        if solved["reference"]["steady"]["taken"] == false {
            assert!(solved["sensitivity"].is_object());
            continue;
        }
        assert!(solved["sensitivity"].is_null() && marched["sensitivity"].is_object());
        assert!(solved["message"].as_str().unwrap().contains("solved for"), "{}", solved["message"]);
        let runs = |speed: &Value| speed["runs"].as_array().unwrap().clone();
        for (solved, marched) in runs(solved).iter().zip(&runs(marched)) {
            if solved["steady"]["taken"] == true {
                let of = |run: &Value| run["errors"]["amplitude"].as_f64().unwrap();
                assert!((of(solved) - of(marched)).abs() <= 1e-6, "{solved} {marched}");
                compared += 1;
            }
        }
    }
    assert!(compared >= 4, "{compared}");

    let mut sweep = steady_sweep(&model, "auto");
    sweep.as_object_mut().unwrap().remove("modes_per_speed");
    sweep["accuracy"] = json!({"target": 0.05});
    let id = api.sweep(&sweep).await;
    let job = api.finish(&id).await;
    assert_eq!(job["status"], "successful", "{job}");
    let pilots = job["choice"]["pilots"].as_array().unwrap();
    assert!(pilots.iter().filter(|pilot| pilot["verdict"] == "periodic").count() > 0, "{pilots:?}");
    let map = api.get(&format!("/v1/jobs/{id}/interaction-map")).await.body;
    let controls = map["errors"]["controls"].as_array().unwrap();
    assert!(controls.iter().any(|control| control["steady"]["taken"] == true), "{controls:?}");
    app.stop().await;
}

#[tokio::test]
async fn effects_that_have_no_map_are_marched_and_say_so() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let mut sweep = steady_sweep(&model, "periodic");
    sweep["scene"]["abradable"] = json!({"modulus": 2e4, "yield_stress": 20.0, "hardening": 500.0, "thickness": 2.0, "rods_around": 90});
    let plan = api.post("/v1/sweeps/plan", &sweep).await;
    assert_eq!(plan.status, 200, "{}", plan.body);
    for point in points(api, &sweep).await {
        assert_eq!(point["steady"]["taken"], false);
        let reason = point["steady"]["reason"].as_str().unwrap();
        assert!(reason.contains("a coating that wears"), "{reason}");
        assert!(amplitude(&point) > 0.0);
    }
}

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

#[tokio::test]
async fn marches_end_once_they_repeat() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let expected = settled(api, &model).await;
    let mut sweep = steady_sweep(&model, "march");
    sweep["integration"]["revolutions"] = json!("auto");
    sweep["record"] =
        json!({"histories": {"speeds": [0], "quantities": ["displacement", "velocity", "state"]}});
    let plan = api.post("/v1/sweeps/plan", &sweep).await.body;
    let time = &plan["estimate"]["computing_time_s"];
    assert!(time["free"].as_f64() < time["contact"].as_f64(), "{plan}");
    let id = api.sweep(&sweep).await;
    assert_eq!(api.finish(&id).await["status"], "successful");
    let map = api.get(&format!("/v1/jobs/{id}/interaction-map")).await.body;
    let mut repeating = 0;
    for (point, expected) in map["points"].as_array().unwrap().iter().zip(&expected) {
        let march = &point["march"];
        let (taken, steps) = (march["revolutions"].as_u64().unwrap(), point["steps"].as_u64().unwrap());
        assert_eq!(steps, taken * point["steps_per_revolution"].as_u64().unwrap());
        let Some(remaining) = march["remaining_change"].as_f64() else {
            assert_eq!(
                (taken, &march["reason"]),
                (100, &json!("the motion was not found to repeat by the time its longest window began"))
            );
            continue;
        };
        repeating += 1;
        assert!(remaining <= 1e-3 && taken < 80, "{march}");
        let (found, expected) = (amplitude(point), amplitude(expected));
        assert!((found - expected).abs() <= 1e-3 * expected, "{found} {expected}: {march}");
    }
    assert!(repeating > 0, "{map}");

    // A wheel that never touches is at rest, whatever shows that symmetries last.
    let mut apart = sweep.clone();
    apart["scene"]["casing"]["clearance"] = json!({"leading": 2.0, "trailing": 2.0});
    for point in points(api, &apart).await {
        assert_eq!((amplitude(&point), &point["settling"]["verdict"]), (0.0, &json!("periodic")), "{point}");
        assert!(point["march"]["revolutions"].as_u64() < Some(20), "{point}");
    }

    // Histories are of the last period.
    let march = &map["points"][0]["march"];
    let (taken, period) =
        (march["revolutions"].as_u64().unwrap(), march["period_revolutions"].as_u64().unwrap());
    let histories = api.get(&format!("/v1/jobs/{id}/histories?speed=0")).await.body;
    assert_eq!(histories["revolutions"], json!([taken - 1, taken]), "a state is one revolution: {period}");
    assert_eq!(histories["point"]["march"], *march);
    let samples = histories["samples_per_revolution"].as_u64().unwrap() as usize;
    for quantity in ["displacement", "velocity"] {
        assert_eq!(histories["sensors"][0][quantity].as_array().unwrap().len(), samples);
    }

    // A march goes on as long as histories are asked of it.
    sweep["record"]["histories"]["revolutions"] = json!([60, 61]);
    let point = &points(api, &sweep).await[0];
    assert!(point["march"]["revolutions"].as_u64() >= Some(61), "{point}");
}

#[tokio::test]
async fn marches_that_never_repeat_say_why_and_what_cannot_end_is_refused() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let mut sweep = steady_sweep(&model, "march");
    sweep["integration"] = json!({"revolutions": "auto", "most_revolutions": 12, "window_revolutions": 2});
    sweep["scene"]["symmetry"] = json!("probe");
    for point in points(api, &sweep).await {
        let march = json!({"revolutions": 12, "reason": "a probe of the symmetry takes all revolutions"});
        assert_eq!(point["march"], march);
    }
    for (field, value) in
        [("most_revolutions", json!(0)), ("settled_to", json!(0.0)), ("settled_to", json!(0.5))]
    {
        let mut sweep = steady_sweep(&model, "march");
        sweep["integration"]["revolutions"] = json!("auto");
        sweep["integration"][field] = value;
        let refused = api.post("/v1/sweeps", &sweep).await;
        assert_eq!(refused.status, 422, "{}", refused.body);
        assert!(refused.body.to_string().contains(&format!("/integration/{field}")), "{}", refused.body);
    }
}
