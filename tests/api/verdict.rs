//! Verdicts on sweeps by operating ranges and limits.

use serde_json::{Value, json};

use super::app::{Api, TestApp, long_sweep_of, modal_analysis_of, sweep_of};
use super::model;

/// Sweep from 300 to 900 rad/s that is judged from 400 to 800 rad/s.
fn judged(model: &str, limits: &Value) -> Value {
    let mut request = sweep_of(model);
    request["speeds"]["count"] = 25.into();
    request["operation"] = json!({"ranges": [{"name": "run", "from": 400.0, "to": 800.0, "unit": "rad_s", "separation_percent": 5.0}]});
    request["limits"] = limits.clone();
    request
}

async fn verdict(api: &Api, id: &str) -> Value {
    let answer = api.get(&format!("/v1/jobs/{id}/verdict")).await;
    assert_eq!(answer.status, 200, "{}", answer.body);
    answer.body
}

#[tokio::test]
async fn a_sweep_is_judged_by_its_ranges_and_limits() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    // A plain sweep is undecided for want of a limit, and numbers of a speed do not depend on what judges them.
    let unrefined = |limits: &Value| {
        let mut request = judged(&model, limits);
        request["refine"] = false.into();
        request
    };
    let mut plain = unrefined(&json!({}));
    for field in ["operation", "limits"] {
        plain.as_object_mut().unwrap().remove(field);
    }
    let plain = api.sweep(&plain).await;
    api.finish(&plain).await;
    let found = verdict(api, &plain).await;
    assert_eq!(found["verdict"], "undecided");
    assert_eq!(found["would_decide"][0]["what"], "no_limit");
    assert!(found["sentence"].as_str().unwrap().contains("No operating range was given"), "{found}");
    assert!(found["settings"].get("operation").is_none() && found["settings"].get("limits").is_none());

    let strict = api.sweep(&unrefined(&json!({"tip_motion": 1e-6}))).await;
    api.finish(&strict).await;
    let map = |id: String| async move { api.get(&format!("/v1/jobs/{id}/interaction-map")).await.body };
    let [before, after] = [map(plain.clone()).await, map(strict.clone()).await];
    assert_eq!(before["amplitude"], after["amplitude"]);
    let found = verdict(api, &strict).await;
    assert_eq!(found["verdict"], "act", "{}", found["sentence"]);
    assert_eq!(found["settings"]["limits"], json!({"tip_motion": 1e-6}));
    assert_eq!(found["settings"]["operation"]["ranges"][0]["name"], "run");
    // The worst value is the largest of the speeds from 380 to 840 rad/s, told from the map alone.
    let points = after["points"].as_array().unwrap();
    let speed = |point: &Value| point["speed_rad_s"].as_f64().unwrap();
    // The largest peak of all tips, which may be that of another tip than the one with the largest root mean square.
    let peak = |point: &Value| {
        let tip = &point["tip"];
        tip.get("largest_half_peak_to_peak").unwrap_or(&tip["half_peak_to_peak"]).clone()
    };
    let motion = |point: &Value| peak(point).as_f64().unwrap();
    let near = points.iter().filter(|point| (380.0..=840.0).contains(&speed(point)));
    let worst = near.clone().max_by(|a, b| motion(a).total_cmp(&motion(b))).unwrap();
    let range = &found["ranges"][0];
    assert_eq!(range["speeds"], json!(near.count()));
    assert_eq!(range["limits"][0]["index"], worst["index"]);
    assert_eq!(range["limits"][0]["judged"]["value"], peak(worst));
    assert_eq!(found["worst"][0]["index"], worst["index"]);
    // Critical speeds are those of the table of the wheel.
    let table = api.get(&format!("/v1/jobs/{strict}/critical-speeds/wheel")).await.body;
    let indices = |list: &Value| {
        list.as_array().unwrap().iter().map(|speed| speed["index"].clone()).collect::<Vec<_>>()
    };
    assert_eq!(indices(&found["critical_speeds"]), indices(&table["critical_speeds"]));
    let report = api.request("GET", &format!("/v1/jobs/{strict}/report")).send().await.unwrap();
    let report = report.text().await.unwrap();
    assert!(report.contains("class=\"verdict act\"><strong>Act:</strong>"), "the report says it first");
    // The level has the same verdict, and every speed with the values that it judges, slowest first.
    let level = api.get(&format!("/v1/jobs/{strict}/level")).await.body;
    assert_eq!(level["verdict"], found);
    let levels = level["speeds"].as_array().unwrap();
    assert_eq!(levels.len(), points.len());
    assert!(levels.is_sorted_by(|a, b| speed(a) < speed(b)));
    for of in levels {
        let point = points.iter().find(|point| point["index"] == of["index"]).unwrap();
        let tip =
            of["values"].as_array().unwrap().iter().find(|value| value["quantity"] == "tip_motion").unwrap();
        assert_eq!((&tip["value"], &tip["standing"]), (&peak(point), &json!("passed")));
    }
    for (query, words) in [("", "tip motion"), ("&quantity=node_force", "contact force on a node")] {
        let drawn =
            api.request("GET", &format!("/v1/jobs/{strict}/level?format=svg{query}")).send().await.unwrap();
        assert!(drawn.text().await.unwrap().contains(words), "{query}");
    }
    let csv = api
        .request("GET", &format!("/v1/jobs/{strict}/level?format=csv"))
        .send()
        .await
        .unwrap()
        .text()
        .await
        .unwrap();
    assert!(csv.starts_with("index,speed_rpm,status,critical,"), "{csv}");
    assert_eq!(csv.lines().count(), 1 + points.len());
    app.stop().await;
}

#[tokio::test]
async fn linear_theory_that_cannot_be_checked_leaves_the_verdict_open() {
    let app = TestApp::start().await;
    let api = &app.api;
    // A package without elements, whose tips move by more than a thousandth of their line.
    let model = api.model(model::package(1.0)).await;
    let mut request = judged(&model, &json!({"tip_motion": 1e6}));
    for (thickness, open, validity) in [(None, true, "not_checked"), (Some(1e6), false, "linear")] {
        request["blade_thickness"] = json!(thickness);
        let id = api.sweep(&request).await;
        api.finish(&id).await;
        let points = api.get(&format!("/v1/jobs/{id}/interaction-map")).await.body["points"].clone();
        let seen = |point: &&Value| point["validity"]["verdict"] == validity;
        let seen = points.as_array().unwrap().iter().filter(seen).count();
        assert!(seen > 0, "{points}");
        let found = verdict(api, &id).await;
        let of_theory = |of: &&Value| of["what"] == "linear_theory_not_checked";
        let question = found["would_decide"].as_array().unwrap().iter().find(of_theory);
        assert_eq!(question.is_some(), open, "{found}");
        if let Some(question) = question {
            assert_eq!(found["verdict"], "undecided");
            assert!(question["remedy"].as_str().unwrap().contains("elements of the mesh"), "{question}");
        }
    }
    app.stop().await;
}

#[tokio::test]
async fn impossible_ranges_and_limits_are_refused_at_their_field() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let range = |name: &str, from: f64, to: f64| json!({"name": name, "from": from, "to": to, "unit": "rpm"});
    let mut separated = range("a", 1.0, 2.0);
    separated["separation_percent"] = json!(-1.0);
    let many: Vec<Value> = (0..101).map(|nth| range(&nth.to_string(), 1.0, 2.0)).collect();
    for (ranges, pointers) in [
        (json!([]), &["/operation/ranges"][..]),
        (json!(many), &["/operation/ranges"]),
        (json!([range("a", 1.0, 2.0), range("a", 3.0, 4.0)]), &["/operation/ranges/1/name"]),
        (json!([range(" ", 2.0, 2.0)]), &["/operation/ranges/0/name", "/operation/ranges/0/to"]),
        (json!([range("a", -1.0, 2.0)]), &["/operation/ranges/0/from"]),
        (json!([separated]), &["/operation/ranges/0/separation_percent"]),
    ] {
        let mut request = sweep_of(&model);
        request["operation"] = json!({"ranges": ranges});
        for route in ["/v1/sweeps", "/v1/sweeps/plan"] {
            assert_eq!(api.post(route, &request).await.pointers(422, "invalid-request"), pointers);
        }
    }
    let mut thin = sweep_of(&model);
    thin["blade_thickness"] = json!(0.0);
    assert_eq!(api.post("/v1/sweeps", &thin).await.pointers(422, "invalid-request"), ["/blade_thickness"]);
    for (limits, pointers) in [
        (json!({"tip_motion": 0.0, "node_force": -1.0}), &["/limits/tip_motion", "/limits/node_force"][..]),
        (json!({"utilisation": 0.9}), &["/limits/utilisation"]),
    ] {
        let mut request = sweep_of(&model);
        request["limits"] = limits;
        assert_eq!(api.post("/v1/sweeps", &request).await.pointers(422, "invalid-request"), pointers);
    }
    app.stop().await;
}

#[tokio::test]
async fn a_verdict_can_be_read_while_the_job_runs_and_of_sweeps_only() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let mut long = long_sweep_of(&model, 200);
    long["limits"] = json!({"tip_motion": 1e6});
    let running = api.sweep(&long).await;
    let found = verdict(api, &running).await;
    assert_eq!(found["verdict"], "undecided", "{}", found["sentence"]);
    let kinds: Vec<&Value> =
        found["would_decide"].as_array().unwrap().iter().map(|open| &open["what"]).collect();
    assert!(kinds.contains(&&json!("speeds_missing")), "{kinds:?}");
    assert!(found["sentence"].as_str().unwrap().ends_with(" The job is not done yet."), "{found}");
    api.delete(&format!("/v1/jobs/{running}")).await;
    let cancelled = verdict(api, &running).await;
    assert!(!cancelled["sentence"].as_str().unwrap().contains("not done yet"), "{cancelled}");

    let modal = api.post("/v1/modal-analyses", &modal_analysis_of(&model)).await.text("/id").to_owned();
    api.get(&format!("/v1/jobs/{modal}/verdict")).await.problem(409, "wrong-job-kind");
    api.get(&format!("/v1/jobs/{modal}/level")).await.problem(409, "wrong-job-kind");
    api.get("/v1/jobs/00000000-0000-0000-0000-000000000000/verdict").await.problem(404, "job-not-found");
    app.stop().await;
}
