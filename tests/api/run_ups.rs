//! Run-ups: taken leg by leg, reported as they come, found again after a kill; they cost what was planned.

use rubmap::impeller::ImpellerParameters;
use serde_json::{Value, json};

use super::app::{Api, TestApp, sweep_of};
use super::formats::get;
use super::model;
use super::program::Program;
use super::stress::{impeller, package};

/// Request for the scene of [`sweep_of`], run up at two rates.
pub(super) fn run_ups_of(model: &str) -> Value {
    let sweep = sweep_of(model);
    json!({
        "model": model, "modes_per_speed": sweep["modes_per_speed"], "scene": sweep["scene"],
        "max_engine_order": sweep["max_engine_order"],
        "speed": {"unit": "rad_s", "from": 300.0, "to": 500.0, "rates": [400.0, 1600.0], "hold_s": 0.05},
        "limit": 0.05,
    })
}

async fn run_up(api: &Api, request: &Value) -> Value {
    let answer = api.post("/v1/run-ups", request).await;
    assert_eq!(answer.status, 202, "{}", answer.body);
    let id = answer.text("/id");
    let job = api.finish(&id).await;
    assert_eq!(job["status"], "successful", "{job}");
    let found = api.get(&format!("/v1/jobs/{id}/run-ups")).await;
    assert_eq!(found.status, 200, "{}", found.body);
    found.body
}

/// Results without times, which no second computation would repeat.
fn timeless(mut found: Value) -> Value {
    for run in found["runs"].as_array_mut().unwrap() {
        run["end"].as_object_mut().unwrap().remove("wall_time_s");
    }
    found
}

#[tokio::test]
async fn run_ups_take_what_was_planned_and_are_told_in_all_forms() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let request = run_ups_of(&model);
    let before = api.post("/v1/run-ups/plan", &request).await;
    assert_eq!(before.status, 200, "{}", before.body);
    assert_eq!(
        (&before.body["reduction"], &before.body["estimate"]),
        (&json!("to be computed"), &Value::Null)
    );
    assert_eq!(api.get("/v1/jobs").await.body["jobs"], json!([]), "a plan starts nothing");

    let answer = api.post("/v1/run-ups", &request).await;
    let id = answer.text("/id");
    let job = api.finish(&id).await;
    assert_eq!((&job["status"], &job["kind"]), (&json!("successful"), &json!("run_up")), "{job}");
    let path = format!("/v1/jobs/{id}/run-ups");
    assert!(job["links"].as_array().unwrap().iter().any(|link| link["href"] == path.as_str()), "{job}");
    let found = api.get(&path).await.body;
    assert_eq!(found["complete"], true);
    let plan = api.post("/v1/run-ups/plan", &request).await.body;
    assert_eq!((&plan["reduction"], &plan["settings"]), (&json!("stored"), &found["settings"]));
    let runs = found["runs"].as_array().unwrap();
    assert_eq!(runs.len(), 2);
    let mut steps = 0;
    for (run, planned) in runs.iter().zip(plan["runs"].as_array().unwrap()) {
        let end = &run["end"];
        assert_eq!(end["status"], "completed", "{end}");
        for field in ["segments", "steps"] {
            assert_eq!(end[field], planned[field], "{field}");
        }
        assert_eq!(end["scheme"]["name"], planned["scheme"]["name"]);
        steps += end["steps"].as_u64().unwrap();
        // The speed is 300 rad/s for 0.05 s, then rises to 500.
        let (rate, duration) =
            (run["rate_rad_s2"].as_f64().unwrap(), planned["duration_s"].as_f64().unwrap());
        assert!((duration - 0.05 - 200.0 / rate).abs() < 1e-12);
        let angle = 300.0 * 0.05 + (500.0f64.powi(2) - 300.0f64.powi(2)) / (2.0 * rate);
        let turned = angle / std::f64::consts::TAU;
        assert!((planned["revolutions"].as_f64().unwrap() - turned).abs() < 1e-9);
        let revolutions = end["revolutions"].as_f64().unwrap();
        assert!(revolutions <= turned && revolutions > turned - 1.0 / 512.0, "{revolutions} {turned}");
        assert!(end["energy_residual"].as_f64().unwrap() < 1e-9, "{end}");
        let frames = run["frames"].as_array().unwrap();
        assert_eq!(frames.len() as u64, (revolutions / 8.0).ceil() as u64);
        assert!(frames.iter().all(|frame| frame["spectra"].is_null()));
        let largest = |frame: &Value| frame["largest"][0].as_f64().unwrap();
        let most = frames.iter().map(largest).fold(0.0, f64::max);
        assert_eq!(end["largest"][0]["displacement"].as_f64().unwrap(), most);
        assert!(frames.iter().any(|frame| frame["contact_share"].as_f64().unwrap() > 0.0));
    }
    assert_eq!(plan["estimate"]["steps"], steps);
    assert!(found["passing"]["message"].is_string(), "{}", found["passing"]);

    let csv = get(api, &format!("{path}?format=csv&units=rpm"), &[]).await.good();
    let frames: usize = runs.iter().map(|run| run["frames"].as_array().unwrap().len()).sum();
    assert_eq!(csv.text().lines().count(), 1 + frames);
    assert!(csv.text().starts_with("run,rate_rpm_s,revolution,start_s,end_s,speed_start_rpm,speed_end_rpm,"));
    let spectrogram = format!("/v1/jobs/{id}/spectrogram");
    for form in ["svg", "plotly", "npz", "png"] {
        get(api, &format!("{path}?format={form}"), &[]).await.good();
        get(api, &format!("{spectrogram}?format={form}&run=1&sensor=1&over=hz"), &[]).await.good();
    }
    let told = api.get(&format!("{spectrogram}?run=1")).await.body;
    let orders = told["engine_orders"].as_array().unwrap();
    assert_eq!((orders.len(), orders[9].as_f64()), (8 * 8 + 1, Some(1.125)));
    let amplitudes = told["amplitudes"].as_array().unwrap();
    assert_eq!(amplitudes.len(), told["times_s"].as_array().unwrap().len());
    // Two lobes are met twice a revolution.
    let last = amplitudes.last().unwrap();
    let of = |order: usize| last[8 * order].as_f64().unwrap();
    assert!(of(2) > 3.0 * of(1) && of(2) > 3.0 * of(3), "{last}");
    for (query, status) in [
        (format!("{path}?sensor=99"), 400),
        (format!("{spectrogram}?sensor=99"), 400),
        (format!("{spectrogram}?run=2"), 400),
        (format!("{spectrogram}?over=time"), 400),
        (format!("{path}?sweep={id}"), 409),
        (format!("/v1/jobs/{id}/interaction-map"), 409),
    ] {
        assert_eq!(api.get(&query).await.status, status, "{query}");
    }
    let other = api.sweep(&sweep_of(&model)).await;
    assert_eq!(api.finish(&other).await["status"], "successful");
    get(api, &format!("{path}?format=svg&sweep={other}"), &[]).await.good();
    assert_eq!(api.get(&format!("/v1/jobs/{other}/run-ups")).await.status, 409);
    assert_eq!(api.get(&format!("/v1/jobs/{other}/spectrogram")).await.status, 409);
    app.stop().await;
}

/// Run down through the same points as at a constant rate, in one run, it has the same numbers.
#[tokio::test]
async fn points_are_another_way_to_say_a_rate() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let mut by_rate = run_ups_of(&model);
    by_rate["speed"] = json!({"unit": "rpm", "from": 5000.0, "to": 3000.0, "rates": [4000.0]});
    let mut by_points = by_rate.clone();
    by_points["speed"] = json!({"unit": "rpm", "points": [{"time_s": 0.0, "speed": 5000.0}, {"time_s": 0.5, "speed": 3000.0}]});
    let (rate, points) = (run_up(api, &by_rate).await, run_up(api, &by_points).await);
    assert_eq!(rate["runs"][0]["frames"], points["runs"][0]["frames"]);
    assert_eq!((&points["runs"][0]["rate_rad_s2"], &points["passing"]), (&Value::Null, &Value::Null));
    by_points["speed"]["course"] = json!("smooth");
    assert_ne!(run_up(api, &by_points).await["runs"][0]["frames"], points["runs"][0]["frames"]);
    app.stop().await;
}

#[tokio::test]
async fn what_cannot_be_run_up_is_refused_at_its_field() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let refused = async |change: &dyn Fn(&mut Value), pointer: &str| {
        let mut request = run_ups_of(&model);
        change(&mut request);
        let answer = api.post("/v1/run-ups", &request).await;
        assert_eq!(answer.status, 422, "{pointer}: {}", answer.body);
        assert_eq!(api.post("/v1/run-ups/plan", &request).await.body["errors"], answer.body["errors"]);
        let errors = answer.body["errors"].as_array().unwrap();
        assert!(errors.iter().any(|error| error["pointer"] == pointer), "{pointer}: {errors:?}");
    };
    for (field, value, pointer) in [
        ("from", json!(0.0), "/speed/from"),
        ("from", json!(-5.0), "/speed/from"),
        ("to", Value::Null, "/speed/to"),
        ("to", json!(300.0), "/speed/to"),
        ("to", json!(1e9), "/speed/to"),
        ("rates", json!([]), "/speed/rates"),
        ("rates", json!([1.0, -1.0]), "/speed/rates/1"),
        ("rates", json!([100.0, 100.0]), "/speed/rates/1"),
        ("rates", json!([1e-3]), "/speed/rates/0"),
        ("rates", json!([1e9]), "/speed/rates/0"),
        ("hold_s", json!(-1.0), "/speed/hold_s"),
        ("course", json!("smooth"), "/speed/course"),
        ("points", json!([{"time_s": 0.0, "speed": 1.0}, {"time_s": 1.0, "speed": 2.0}]), "/speed"),
    ] {
        refused(&|request| request["speed"][field] = value.clone(), pointer).await;
    }
    for (points, pointer) in [
        (json!([]), "/speed/points"),
        (json!([{"time_s": 0.0, "speed": 300.0}]), "/speed/points"),
        (json!([{"time_s": 0.1, "speed": 300.0}, {"time_s": 1.0, "speed": 400.0}]), "/speed/points/0/time_s"),
        (json!([{"time_s": 0.0, "speed": 300.0}, {"time_s": 0.0, "speed": 400.0}]), "/speed/points/1/time_s"),
        (json!([{"time_s": 0.0, "speed": 300.0}, {"time_s": 1.0, "speed": 0.0}]), "/speed/points/1/speed"),
        (json!([{"time_s": 0.0, "speed": 300.0}, {"time_s": 1e-5, "speed": 301.0}]), "/speed/points"),
        (
            json!([{"time_s": 0.0, "speed": 300.0}, {"time_s": 1e-9, "speed": 301.0}]),
            "/speed/points/1/time_s",
        ),
    ] {
        refused(&|request| request["speed"] = json!({"unit": "rad_s", "points": points}), pointer).await;
    }
    for (field, value) in [
        ("angle_tolerance_rad", json!(0.0)),
        ("angle_tolerance_rad", json!(1.0)),
        ("frame_revolutions", json!(0)),
        ("frame_revolutions", json!(12)),
        ("frame_revolutions", json!(1_000_000)),
        ("limit", json!(0.0)),
    ] {
        refused(&|request| request[field] = value.clone(), &format!("/{field}")).await;
    }
    // These runs have hundreds of thousands of pieces.
    refused(
        &|request| {
            request["speed"] = json!({"unit": "rad_s", "from": 1000.0, "to": 60_000.0, "rates": [2000.0]});
            request["angle_tolerance_rad"] = json!(1e-8);
        },
        "/speed/rates/0",
    )
    .await;
    refused(
        &|request| {
            let rates: Vec<f64> = (0..100).map(|rate| 10.0 + f64::from(rate)).collect();
            request["speed"]["rates"] = json!(rates);
            request["max_engine_order"] = json!(1000);
        },
        "/max_engine_order",
    )
    .await;
    refused(
        &|request| {
            request["sensors"] = json!([{"gauge": {"nodes": [1, 2]}}]);
        },
        "/limit",
    )
    .await;
    let abradable = json!({"modulus": 1000.0, "yield_stress": 10.0, "hardening": 10.0, "thickness": 1.0});
    refused(&|request| request["scene"]["abradable"] = abradable.clone(), "/scene/abradable").await;
    refused(&|request| request["scene"]["symmetry"] = json!("exact"), "/scene/symmetry").await;
    refused(
        &|request| request["integration"] = json!({"ramp_revolutions": -1.0}),
        "/integration/ramp_revolutions",
    )
    .await;
    refused(&|request| request["model"] = json!("0".repeat(64)), "/model").await;
    // A wheel of springs does not say where its mass is.
    refused(&|request| request["euler_force"] = json!(true), "/euler_force").await;
    app.stop().await;
}

/// Run-ups have the Euler force of their elements, which alone moves an impeller that touches nothing. What lies beside the
/// reduction (the growth of tips, the Euler force) is not there when a plan is asked for, and yet the cost is the planned one.
#[tokio::test]
async fn run_ups_have_the_euler_force_of_their_elements() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(package(&ImpellerParameters { gyroscopic: true, ..impeller() })).await;
    let clearance = json!({"leading": 0.5, "trailing": 0.4, "given": "cold"});
    let of = |euler: bool, coriolis: bool| {
        json!({
            "model": model, "modes_per_speed": 2, "euler_force": euler, "max_engine_order": 12,
            "speed": {"unit": "rad_s", "from": 500.0, "to": 1500.0, "rates": [20_000.0]},
            "scene": {"centrifugal_stiffening": true, "coriolis": coriolis, "damping": {"modal_ratio": 0.05}, "contact": {},
                      "casing": {"clearance": clearance, "waves": [{"order": 2, "amplitude": 0.1}]}},
            "sensors": [{"contact_node": 0, "component": "tangential"}],
        })
    };
    api.finish(
        &api.sweep(&json!({
            "model": model, "modes_per_speed": 2, "speeds": {"values": [500.0], "unit": "rad_s"}, "scene": {},
        }))
        .await,
    )
    .await;
    for coriolis in [false, true] {
        let plan = api.post("/v1/run-ups/plan", &of(true, coriolis)).await.body;
        assert_eq!(plan["runs"][0]["message"], Value::Null, "{plan}");
        let effects = plan["effects"].as_array().unwrap();
        assert!(effects.iter().any(|effect| effect["name"] == "euler_force" && effect["on"] == true));
        let (without, with) =
            (run_up(api, &of(false, coriolis)).await, run_up(api, &of(true, coriolis)).await);
        assert_eq!(
            (&with["settings"]["euler_force"], &without["settings"]["euler_force"]),
            (&json!(true), &Value::Null)
        );
        let end = |found: &Value| found["runs"][0]["end"].clone();
        assert_eq!(
            (&end(&with)["status"], &end(&with)["steps"]),
            (&json!("completed"), &plan["runs"][0]["steps"])
        );
        assert!(end(&with)["energy_residual"].as_f64().unwrap() < 1e-9, "{with}");
        let largest = |found: &Value| end(found)["largest"][0]["displacement"].as_f64().unwrap();
        assert_eq!(end(&with)["euler_share"], end(&without)["euler_share"]);
        // Nothing touches.
        assert!(largest(&without) == 0.0 && largest(&with) > 1e-4, "{}", largest(&with));
    }
    app.stop().await;
}

/// Run-ups that are killed between two legs go on to the same bits.
#[tokio::test]
async fn killed_run_ups_go_on_where_they_were() {
    let data = tempfile::tempdir().unwrap();
    let program = Program::serve(data.path());
    let model = program.api.model(model::package(1.0)).await;
    let mut request = run_ups_of(&model);
    request["speed"]["rates"] = json!([80.0, 60.0]);
    let answer = program.api.post("/v1/run-ups", &request).await;
    let id = answer.text("/id");
    let path = format!("/v1/jobs/{id}/run-ups");
    program.api.follow(&id, |job| job["stored_bytes"].as_u64() > Some(0)).await;
    let before = program.api.get(&path).await;
    assert_eq!(before.status, 200, "{}", before.body);
    assert_eq!(before.body["complete"], false);
    program.kill();

    let program = Program::serve(data.path());
    let job = program.api.finish(&id).await;
    assert_eq!(job["status"], "successful", "{job}");
    let resumed = program.api.get(&path).await.body;
    program.kill();
    let app = TestApp::start().await;
    assert_eq!(app.api.model(model::package(1.0)).await, model);
    assert_eq!(timeless(run_up(&app.api, &request).await), timeless(resumed));
}

/// Every plan cuts all runs, so that there is a bound on the pieces of all of them together.
#[tokio::test]
async fn runs_of_too_many_pieces_together_are_refused() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let mut request = run_ups_of(&model);
    let rates: Vec<f64> = (0..100).map(|k| 4.0 + 0.01 * f64::from(k)).collect();
    request["speed"] = json!({"unit": "rad_s", "from": 300.0, "to": 500.0, "rates": rates});
    request["angle_tolerance_rad"] = json!(1e-7);
    for path in ["/v1/run-ups/plan", "/v1/run-ups"] {
        let refused = api.post(path, &request).await;
        assert_eq!(refused.status, 422, "{}", refused.body);
        let errors = refused.body["errors"].as_array().unwrap();
        assert_eq!(errors.len(), 1, "{}", refused.body);
        assert!(errors[0]["pointer"].as_str().unwrap().starts_with("/speed/rates/"), "{}", refused.body);
        assert!(errors[0]["detail"].as_str().unwrap().contains("all runs together"), "{}", refused.body);
    }
    app.stop().await;
}
