//! Length of a march where the request does not give it: until its motion repeats.

use serde_json::{Value, json};

use super::app::{Api, TestApp, sweep_of};
use super::model;

/// Request for a sweep that says nothing of its revolutions, but for `integration`.
fn sweep(model: &str, integration: Value) -> Value {
    let mut sweep = sweep_of(model);
    sweep["integration"] = integration;
    sweep
}

fn case(model: &str, record: Value) -> Value {
    let mut case = sweep(model, json!({}));
    case["scene"]["damping"] = json!({"modal_ratio": 0.05});
    let fields = case.as_object_mut().unwrap();
    fields.remove("speeds");
    fields.insert("speed".to_owned(), json!({"value": 540.0, "unit": "rad_s"}));
    fields.insert("record".to_owned(), record);
    case
}

async fn map(api: &Api, sweep: &Value) -> Value {
    let id = api.sweep(sweep).await;
    let job = api.finish(&id).await;
    assert_eq!(job["status"], "successful", "{job}");
    api.get(&format!("/v1/jobs/{id}/interaction-map")).await.body
}

async fn histories(api: &Api, case: &Value) -> Value {
    let id = api.post("/v1/case-studies", case).await.text("/id");
    let job = api.finish(&id).await;
    assert_eq!(job["status"], "successful", "{job}");
    api.get(&format!("/v1/jobs/{id}/histories")).await.body
}

fn taken(point: &Value) -> u64 {
    let march = point["march"]["revolutions"].as_u64();
    march.unwrap_or_else(|| panic!("{point}"))
}

#[tokio::test]
async fn a_sweep_that_says_nothing_marches_until_it_repeats() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let found = map(api, &sweep(&model, json!({}))).await;
    assert_eq!(found["settings"]["integration"]["revolutions"], "auto");
    let points = found["points"].as_array().unwrap();
    assert!(points.iter().any(|point| point["march"]["period_revolutions"].is_u64()), "{found}");
    let said =
        json!({"revolutions": "auto", "most_revolutions": 100, "settled_to": 1e-3, "window_revolutions": 20});
    assert_eq!(map(api, &sweep(&model, said)).await["amplitude"], found["amplitude"]);

    // A given number has its usual meaning.
    let numbered = map(api, &sweep(&model, json!({"revolutions": 50}))).await;
    for point in numbered["points"].as_array().unwrap() {
        let steps = 50 * point["steps_per_revolution"].as_u64().unwrap();
        assert_eq!((&point["march"], point["steps"].as_u64()), (&Value::Null, Some(steps)));
    }
    app.stop().await;
}

#[tokio::test]
async fn a_march_is_as_long_as_what_is_recorded_of_it() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let usual = taken(&histories(api, &case(&model, json!({}))).await["point"]);
    assert!(usual < 50, "{usual}: a march that ends before what is recorded below");
    // The first revolutions are recorded however early the march ends, and later ones make it longer.
    for (record, least, most) in
        [([0, 10], usual, usual), ([0, 50], 50, 60), ([40, 50], 50, 60), ([90, 100], 100, 100)]
    {
        let found = histories(api, &case(&model, json!({"revolutions": record}))).await;
        assert_eq!(found["revolutions"], json!(record));
        assert!((least..=most).contains(&taken(&found["point"])), "{record:?}: {}", found["point"]);
        let samples = found["samples_per_revolution"].as_u64().unwrap() * (record[1] - record[0]);
        let line = found["sensors"][0]["displacement"].as_array().unwrap();
        assert_eq!(line.len() as u64, samples, "{record:?}");
    }
    app.stop().await;
}

#[tokio::test]
async fn what_is_too_long_is_refused_where_the_length_is_said() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    for (integration, pointer, says) in [
        (
            json!({"most_revolutions": 10}),
            "/integration/window_revolutions",
            "between 1 and 10 revolutions (most_revolutions)",
        ),
        (
            json!({"window_revolutions": 120}),
            "/integration/window_revolutions",
            "between 1 and 100 revolutions (most_revolutions)",
        ),
        (
            json!({"ramp_revolutions": 90.0}),
            "/integration/window_revolutions",
            "need more than 100 (most_revolutions)",
        ),
        (
            json!({"revolutions": 10}),
            "/integration/window_revolutions",
            "between 1 and 10 revolutions (revolutions)",
        ),
        (json!({"revolutions": 0, "window_revolutions": 1}), "/integration/revolutions", "\"auto\""),
    ] {
        let refused = api.post("/v1/sweeps", &sweep(&model, integration)).await;
        let items = refused.problem(422, "invalid-request");
        let found = items.iter().find(|item| item["pointer"] == pointer);
        let found = found.unwrap_or_else(|| panic!("{pointer}: {}", refused.body));
        assert!(found["detail"].as_str().unwrap().contains(says), "{found}");
    }
    let refused = api.post("/v1/case-studies", &case(&model, json!({"revolutions": [0, 120]}))).await;
    let items = refused.problem(422, "invalid-request");
    assert_eq!(items[0]["pointer"], "/record/revolutions");
    assert!(items[0]["detail"].as_str().unwrap().contains("integration.most_revolutions"), "{}", items[0]);

    // The place of the axis at the end of a march is not known unless the length of the march is.
    let mut chain = sweep(&model, json!({}));
    chain["sweep"] = json!("up");
    chain["scene"]["orbit"] = json!({"radius": 0.02, "whirl_ratio": 0.5});
    let refused = api.post("/v1/sweeps", &chain).await;
    let items = refused.problem(422, "invalid-request");
    assert_eq!(items[0]["pointer"], "/sweep");
    assert!(items[0]["detail"].as_str().unwrap().contains("give a number of revolutions"), "{}", items[0]);
    chain["integration"]["revolutions"] = json!(50);
    assert_eq!(api.post("/v1/sweeps/plan", &chain).await.status, 200);
    app.stop().await;
}

#[tokio::test]
async fn speeds_of_a_chain_that_end_by_themselves_are_recorded_as_they_were() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let mut chain = sweep(&model, json!({}));
    chain["sweep"] = json!("down");
    chain["record"] = json!({"histories": {"speeds": [0, 3], "quantities": ["displacement"]}});
    let id = api.sweep(&chain).await;
    assert_eq!(api.finish(&id).await["status"], "successful");
    let found = api.get(&format!("/v1/jobs/{id}/interaction-map")).await.body;
    for speed in [0, 3] {
        let recorded = api.get(&format!("/v1/jobs/{id}/histories?speed={speed}")).await.body;
        let point = &found["points"][speed];
        assert_eq!(recorded["point"]["march"], point["march"]);
        assert_eq!(recorded["point"]["responses"], point["responses"]);
        let [begin, end] = [0, 1].map(|place| recorded["revolutions"][place].as_u64().unwrap());
        let window = point["march"]["period_revolutions"].as_u64().unwrap_or(20);
        assert_eq!((begin, end), (taken(point) - window, taken(point)));
    }
    app.stop().await;
}

#[tokio::test]
async fn control_runs_are_held_against_runs_of_another_length() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let mut request = sweep(&model, json!({}));
    request["control_speeds"] = json!(3);
    request["scene"]["damping"] = json!({"modal_ratio": 0.05});
    let short = map(api, &request).await;
    request["integration"] = json!({"revolutions": 100});
    let long = map(api, &request).await;
    // A run that ends early is known as well as one that does not; what adds up over it is not compared with what adds up over more.
    let controls = |map: &Value| map["errors"]["controls"].as_array().unwrap().clone();
    assert_eq!(controls(&short).len(), 3);
    let mut lengths = Vec::new();
    for (short_of, long_of) in controls(&short).iter().zip(&controls(&long)) {
        let point = &short["points"][short_of["index"].as_u64().unwrap() as usize];
        lengths.push(taken(point));
        for quantity in ["amplitude", "engine_orders", "impulse"] {
            let of = |control: &Value| control["differences"][quantity].as_f64().unwrap();
            let (short, long) = (of(short_of), of(long_of));
            assert!((short - long).abs() <= 1e-3 + 0.02 * long, "{quantity}: {short} {long} {point}");
        }
    }
    assert!(lengths.iter().any(|&taken| taken < 50), "{lengths:?}");
    app.stop().await;
}

#[tokio::test]
async fn what_nothing_damps_takes_all_revolutions_and_says_why() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let mut undamped = sweep(&model, json!({"most_revolutions": 30}));
    undamped["scene"].as_object_mut().unwrap().remove("damping");
    let found = map(api, &undamped).await;
    for point in found["points"].as_array().unwrap() {
        let reason = point["march"]["reason"].as_str().unwrap_or_default();
        assert!(taken(point) == 30 && reason.contains("without damping"), "{point}");
    }
    // A wheel at rest repeats, whatever damps it.
    undamped["scene"]["casing"]["clearance"] = json!({"leading": 2.0, "trailing": 2.0});
    undamped["integration"] = json!({});
    for point in map(api, &undamped).await["points"].as_array().unwrap() {
        assert!(taken(point) < 20 && point["march"]["period_revolutions"] == 1, "{point}");
    }
    app.stop().await;
}
