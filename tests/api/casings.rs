//! Measured casings: from a table to the results of a sweep.

use std::f64::consts::TAU;
use std::fmt::Write;

use serde_json::{Value, json};

use super::app::{Answer, Api, TestApp, sweep_of};
use super::model;
use super::stress::{impeller, package};

async fn read(api: &Api, table: impl Into<Vec<u8>>) -> Answer {
    let request =
        api.request("POST", "/v1/casing-tables").header("content-type", "text/csv").body(table.into());
    Answer::of(request.send().await.unwrap()).await
}

/// Table of two lobes at leading and trailing edge, half as high there, every two degrees.
fn table(outlier: f64) -> String {
    let mut text = "angle_deg;0;1\n".to_owned();
    for i in 0..180 {
        let height = 0.42 * (2.0 * TAU * f64::from(i) / 180.0).cos().max(0.0).powi(4);
        let wrong = if i == 20 { outlier } else { 0.0 };
        writeln!(text, "{};{};{}", 2 * i, height + wrong, 0.5 * height).unwrap();
    }
    text
}

#[tokio::test]
async fn a_table_becomes_a_casing_that_tips_touch() {
    let app = TestApp::start().await;
    let api = &app.api;
    let found = read(api, table(0.0)).await;
    assert_eq!(found.status, 200, "{}", found.body);
    assert_eq!(found.body["survey"]["outliers"], json!([]));
    let model = api.model(model::package(1.0)).await;
    let mut request = sweep_of(&model);
    request["scene"]["casing"]["lobes"] = Value::Null;
    request["scene"]["casing"]["measured"] = found.body["measured"].clone();

    let plan = api.post("/v1/sweeps/plan", &request).await.body;
    let shape = &plan["casing_shape"];
    assert_eq!((&shape["repeats"], &plan["symmetry"]["repeats"]), (&json!(2), &json!(2)), "{plan}");
    assert!((shape["highest"].as_f64().unwrap() - 0.42).abs() < 1e-6, "{shape}");
    assert!(shape["measured"]["interpolation"].as_str().unwrap().contains("cubic"), "{shape}");

    let id = api.sweep(&request).await;
    assert_eq!(api.finish(&id).await["status"], "successful");
    let map = api.get(&format!("/v1/jobs/{id}/interaction-map")).await.body;
    assert!(map["points"][0]["contact_share"].as_f64() > Some(0.0), "{}", map["points"][0]);
    // The heights that are drawn are those that were sent.
    let section = api.get(&format!("/v1/models/{model}/section?sweep={id}")).await.body;
    let contact = section["contact"].as_array().unwrap();
    for (place, share) in [(&contact[0], 1.0), (contact.last().unwrap(), 0.5)] {
        let heights = place["heights"].as_array().unwrap();
        assert_eq!(heights.len(), 720);
        for (angle, sent) in [(0, 0.42), (180, 0.0), (360, 0.42)] {
            let drawn = heights[angle].as_f64().unwrap();
            assert!((drawn - share * sent).abs() < 1e-6, "{angle}: {drawn}");
        }
    }
    app.stop().await;
}

#[tokio::test]
async fn what_stands_out_is_said_and_kept() {
    let app = TestApp::start().await;
    let found = read(&app.api, table(0.2)).await.body;
    let outliers = found["survey"]["outliers"].as_array().unwrap();
    assert_eq!(outliers.len(), 1, "{outliers:?}");
    assert!((outliers[0]["angle_rad"].as_f64().unwrap() - 40f64.to_radians()).abs() < 1e-9);
    assert_eq!(found["measured"]["heights"][0][20], outliers[0]["height"]);
    app.stop().await;
}

#[tokio::test]
async fn tables_that_are_none_are_refused_by_line() {
    let app = TestApp::start().await;
    let api = &app.api;
    let items = read(api, "angle_deg,0\n0,a\n1,2,3\n").await.problem(422, "invalid-table");
    assert_eq!(items.iter().map(|item| item["line"].as_u64()).collect::<Vec<_>>(), [Some(2), Some(3)]);
    for table in [&b""[..], b"\xff\xfe\x00", b"angle_deg,0\n", b"a,b\n1,2\n", b"\"angle_deg"] {
        read(api, table).await.problem(422, "invalid-table");
    }
    read(api, vec![b'1'; (2 << 20) + 1]).await.problem(413, "payload-too-large");
    let json = api.request("POST", "/v1/casing-tables").header("content-type", "application/json").body("{}");
    Answer::of(json.send().await.unwrap()).await.problem(415, "unsupported-media-type");
    app.stop().await;
}

/// Wrong shapes are refused at their places: each wrong part where it stands, and nothing else is said of it.
#[tokio::test]
async fn wrong_shapes_are_refused_at_their_places() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let angles: Vec<f64> = (0..12).map(|i| 0.5 * f64::from(i)).collect();
    let measured = |angles: &[f64], chord: Value, heights: Value| json!({"measured": {"angles_rad": angles, "chord": chord, "heights": heights}});
    let flat = json!([vec![0.1; 12]]);
    let cases = [
        (
            json!({"single_lobes": [{"angle_rad": 0, "amplitude": 0.1, "width_rad": 3.0}]}),
            "/single_lobes/0/width_rad",
        ),
        (
            json!({"single_lobes": [{"angle_rad": 0, "amplitude": 1e3, "width_rad": 0.3}]}),
            "/single_lobes/0/amplitude",
        ),
        (json!({"waves": [{"order": 2, "amplitude": 0.1, "along_chord": [1]}]}), "/waves/0/along_chord"),
        (json!({"waves": [{"order": 2, "amplitude": 0.1, "along_chord": [1, 2]}]}), "/waves/0/along_chord/1"),
        (json!({"tilt": {"angle_rad": 0.1}}), "/tilt/angle_rad"),
        (measured(&angles[..6], json!([0]), json!([[0.1, 0.1, 0.1, 0.1, 0.1, 0.1]])), "/measured/angles_rad"),
        // The table has the first angle again a turn later, but for the last digit.
        (
            measured(
                &(0..13).map(|i| 102f64.to_radians() + f64::from(i) * TAU / 12.0).collect::<Vec<_>>(),
                json!([0]),
                json!([vec![0.1; 13]]),
            ),
            "/measured/angles_rad",
        ),
        (measured(&angles, json!([0.5, 0.5]), json!([vec![0.1; 12], vec![0.1; 12]])), "/measured/chord"),
        (measured(&angles, json!([0, 1]), flat.clone()), "/measured/heights"),
        (measured(&angles, Value::Null, flat.clone()), "/measured/heights"),
        (measured(&angles, json!([0]), json!([vec![0.1; 11]])), "/measured/heights/0"),
        (measured(&angles, json!([0]), json!([vec![1e-40; 12]])), "/measured/heights/0/0"),
    ];
    for (shape, pointer) in cases {
        let mut request = sweep_of(&model);
        let casing = request["scene"]["casing"].as_object_mut().unwrap();
        casing.remove("lobes");
        casing.extend(shape.as_object().unwrap().clone());
        let answer = api.post("/v1/sweeps/plan", &request).await;
        let items = answer.problem(422, "invalid-request");
        let at = items[0]["pointer"].as_str().unwrap();
        assert_eq!(at, format!("/scene/casing{pointer}"), "{shape}: {items:?}");
    }
    // A tilt may reach into the blade only with a ramp.
    let mut tilted = sweep_of(&model);
    tilted["scene"]["casing"]["tilt"] = json!({"angle_rad": 5e-4, "towards_rad": 1.0});
    let plan = api.post("/v1/sweeps/plan", &tilted).await;
    assert_eq!(plan.status, 200, "{}", plan.body);
    assert_eq!(plan.body["casing_shape"]["repeats"], 1);
    assert!(plan.body["casing_shape"].get("highest").is_none());
    app.stop().await;
}

/// The tips of a wheel with elements grow into clearances that are given cold; a wheel of springs cannot say how.
#[tokio::test]
async fn cold_clearances_are_closed_by_growing_tips() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(package(&impeller())).await;
    let of = |given: &str, ramp: f64| {
        let clearance = json!({"leading": 0.5, "trailing": 0.4, "given": given});
        json!({
            "model": model, "modes_per_speed": 2, "speeds": {"values": [500.0, 2000.0], "unit": "rad_s"},
            "scene": {"centrifugal_stiffening": true, "damping": {"modal_ratio": 0.05}, "contact": {},
                      "casing": {"clearance": clearance, "waves": [{"order": 2, "amplitude": 0.1}]}},
            "integration": {"revolutions": 4, "window_revolutions": 2, "ramp_revolutions": ramp}
        })
    };
    let id = api.sweep(&of("cold", 1.0)).await;
    assert_eq!(api.finish(&id).await["status"], "successful");
    let map = api.get(&format!("/v1/jobs/{id}/interaction-map")).await.body;
    let running = |index: usize, node: usize| -> f64 {
        map["points"][index]["running_clearance"][node].as_f64().unwrap()
    };
    // Growth is in proportion to Ω² but for what stiffening takes; nodes 0 and the last are those at the ends.
    let last = map["points"][0]["running_clearance"].as_array().unwrap().len() - 1;
    for (node, cold) in [(0, 0.5), (last, 0.4)] {
        let ratio = (cold - running(1, node)) / (cold - running(0, node));
        assert!((13.0..=16.1).contains(&ratio), "{node}: {ratio}");
    }
    let again = api.sweep(&of("running", 1.0)).await;
    assert_eq!(api.finish(&again).await["status"], "successful");
    let map = api.get(&format!("/v1/jobs/{again}/interaction-map")).await.body;
    assert!(map["points"][0].get("running_clearance").is_none());
    let items = api.post("/v1/sweeps", &of("cold", 0.0)).await.problem(422, "invalid-request");
    assert_eq!(items[0]["pointer"], "/integration/ramp_revolutions");

    let springs = api.model(model::package(1.0)).await;
    let mut request = sweep_of(&springs);
    request["scene"]["casing"]["clearance"]["given"] = json!("cold");
    let items = api.post("/v1/sweeps", &request).await.problem(422, "invalid-request");
    assert_eq!(items[0]["pointer"], "/scene/casing/clearance/given");
    app.stop().await;
}

/// Curves through errors are refused: a turn closed by a rounded repetition of its first point, and a scan whose second pass lies beside its first.
#[tokio::test]
async fn curves_through_errors_are_refused() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let plan = async |angles: Vec<f64>, height: &dyn Fn(usize, f64) -> f64| {
        let heights: Vec<f64> = angles.iter().enumerate().map(|(i, angle)| height(i, *angle)).collect();
        let mut request = sweep_of(&model);
        let measured = json!({"angles_rad": angles, "chord": [0.0], "heights": [heights]});
        request["scene"]["casing"]["lobes"] = Value::Null;
        request["scene"]["casing"]["measured"] = measured;
        api.post("/v1/sweeps/plan", &request).await
    };
    let even = |n: usize| (0..n).map(move |i| TAU * i as f64 / n as f64);
    let oval = |angle: f64| 0.1 * (2.0 * angle).cos();
    let whole = plan(even(72).collect(), &|_, angle| oval(angle)).await;
    assert_eq!(
        (whole.status.as_u16(), &whole.body["casing_shape"]["repeats"]),
        (200, &json!(2)),
        "{}",
        whole.body
    );
    let closed = even(72).chain([TAU - 2e-7]).collect();
    let items = plan(closed, &|_, angle| oval(angle)).await.problem(422, "invalid-request");
    assert_eq!(items[0]["pointer"], "/scene/casing/measured/angles_rad");
    let twice = even(72).flat_map(|angle| [angle, angle + 3e-4]).collect();
    let noisy = |i: usize, angle: f64| oval(angle) + 0.01 * f64::from(u8::from(i % 2 == 1));
    let items = plan(twice, &noisy).await.problem(422, "invalid-request");
    assert_eq!(items[0]["pointer"], "/scene/casing/measured/heights/0");
    // A circle that was measured repeats as any other does.
    let circle = plan(even(72).collect(), &|_, _| 0.1).await.body;
    assert_eq!((&circle["symmetry"]["repeats"], circle.get("casing_shape")), (&json!(4), None), "{circle}");
    app.stop().await;
}
