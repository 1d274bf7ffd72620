//! Convergence studies: POST, poll, work and precision as JSON, CSV and SVG.

use serde_json::{Value, json};

use super::app::{Api, TestApp, sweep_of};
use super::model;
use super::program::Program;

pub(crate) fn study_of(model: &str) -> Value {
    let sweep = sweep_of(model);
    json!({
        "model": model,
        "speeds": {"values": [400.0, 800.0], "unit": "rad_s"},
        "scene": sweep["scene"],
        "grid": {
            "modes_per_speed": [1, 2],
            "steps_per_revolution": [600, 1200, 2400],
            "schemes": ["exact_modal", "central_differences"],
        },
        "integration": {"revolutions": 6, "ramp_revolutions": 1, "window_revolutions": 2},
        "max_engine_order": 8,
    })
}

async fn text(api: &Api, path: &str) -> (String, String) {
    let response = api.request("GET", path).send().await.unwrap();
    assert_eq!(response.status(), 200, "{path}");
    let media_type = response.headers()["content-type"].to_str().unwrap().to_owned();
    (media_type, response.text().await.unwrap())
}

#[tokio::test]
async fn a_study_tells_errors_and_times_of_every_setting() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let answer = api.post("/v1/studies", &study_of(&model)).await;
    assert_eq!(answer.status, 202, "{}", answer.body);
    let id = answer.text("/id");
    let path = format!("/v1/jobs/{id}/work-precision");
    let job = api.finish(&id).await;
    assert_eq!(job["status"], "successful", "{job}");
    assert_eq!((&job["kind"], &job["speeds"]["finished"]), (&json!("study"), &json!(2)));
    let rels: Vec<_> = job["links"].as_array().unwrap().iter().map(|link| &link["rel"]).collect();
    assert_eq!(rels, ["self", "work-precision", "histories", "archive", "model"]);

    let found = api.get(&path).await.body;
    assert_eq!(found["speeds"].as_array().unwrap().len(), 2);
    let sizes: Vec<_> =
        found["reductions"].as_array().unwrap().iter().map(|r| &r["modes_per_speed"]).collect();
    assert_eq!(sizes, [1, 2, 4], "the reference has the grid's last ratio once more");
    for speed in found["speeds"].as_array().unwrap() {
        let runs = speed["runs"].as_array().unwrap();
        assert_eq!(runs.len(), 2 * 2 * 3);
        let reference = &speed["reference"];
        assert_eq!((&reference["scheme"], &reference["modes_per_speed"]), (&json!("exact_modal"), &json!(4)));
        // There are at least 512 samples, a multiple of four sectors and two lobes.
        assert_eq!(reference["steps_per_revolution"], 5120);
        assert!(speed["sensitivity"]["growth"].is_string() && speed["message"].is_string());
        for run in runs {
            assert_eq!(run["status"], "completed", "{run}");
            for quantity in ["history", "amplitude", "impulse"] {
                assert!(run["errors"][quantity].is_f64(), "{quantity}: {run}");
            }
            let cost = &run["cost"];
            assert!(cost["per_revolution_s"].as_f64() > Some(0.0) && cost["repetitions"].as_u64() >= Some(1));
        }
        assert!(
            runs.iter().any(|run| run["pareto"].as_array().is_some_and(|p| p.contains(&json!("amplitude"))))
        );
        let orders = speed["orders"].as_array().unwrap();
        assert_eq!(orders.len(), 4);
        assert_eq!(orders[0]["steps_per_revolution"], json!([1024, 1536, 2560]));
        assert_eq!(
            (
                orders[0]["differences"].as_array().unwrap().len(),
                orders[0]["orders"].as_array().unwrap().len()
            ),
            (2, 1)
        );
    }

    let (media_type, csv) = text(api, &format!("{path}?format=csv")).await;
    assert_eq!(media_type, "text/csv; charset=utf-8");
    let lines: Vec<&str> = csv.lines().collect();
    assert_eq!(lines.len(), 1 + 2 * (12 + 1));
    let columns = lines[0].split(',').count();
    assert!(lines.iter().all(|line| line.split(',').count() == columns));
    for query in ["format=svg", "format=svg&quantity=history&speed=1"] {
        let (media_type, svg) = text(api, &format!("{path}?{query}")).await;
        assert!(media_type == "image/svg+xml" && svg.ends_with("</svg>\n"));
    }
    let histories = api.get(&format!("/v1/jobs/{id}/histories?speed=1")).await.body;
    assert_eq!(
        (&histories["speed_rad_s"], &histories["lines"].as_array().unwrap().len()),
        (&json!(800.0), &3)
    );
    let samples = histories["samples_per_revolution"].as_u64().unwrap();
    for line in histories["lines"].as_array().unwrap() {
        assert_eq!(line["displacement"][1].as_array().unwrap().len() as u64, 3 * samples);
    }
    text(api, &format!("/v1/jobs/{id}/histories?format=svg&sensor=1")).await;

    for (query, parameter) in [
        ("work-precision?speed=2", "speed"),
        ("work-precision?format=pdf", "format"),
        ("work-precision?quantity=beauty", "quantity"),
        ("histories?sensor=2", "sensor"),
        ("histories?format=dvd", "format"),
    ] {
        let answer = api.get(&format!("/v1/jobs/{id}/{query}")).await;
        assert_eq!(answer.problem(400, "invalid-parameter")[0]["parameter"], parameter, "{query}");
    }
    api.get(&format!("/v1/jobs/{id}/campbell")).await.problem(409, "wrong-job-kind");
    app.stop().await;
}

#[tokio::test]
async fn an_unstable_setting_is_listed_with_its_reason() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1e4)).await;
    let mut request = study_of(&model);
    request["speeds"] = json!({"values": [100.0], "unit": "rad_s"});
    let answer = api.post("/v1/studies", &request).await;
    let id = answer.text("/id");
    assert_eq!(api.finish(&id).await["status"], "successful");
    let found = api.get(&format!("/v1/jobs/{id}/work-precision")).await.body;
    let runs = found["speeds"][0]["runs"].as_array().unwrap();
    let unstable: Vec<&Value> = runs.iter().filter(|run| run["status"] == "failed").collect();
    assert!(!unstable.is_empty() && unstable.len() < runs.len());
    for run in unstable {
        assert!(run["message"].as_str().unwrap().contains("unstable"), "{run}");
        assert!(run["scheme"] == "central_differences" && run["errors"].is_null());
    }
    app.stop().await;
}

#[tokio::test]
async fn bad_grids_are_refused_at_once() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let refused = |change: fn(&mut Value)| {
        let mut request = study_of(&model);
        change(&mut request);
        async move { api.post("/v1/studies", &request).await.pointers(422, "invalid-request") }
    };
    assert_eq!(refused(|r| r["grid"]["modes_per_speed"] = json!([])).await, ["/grid/modes_per_speed"]);
    assert_eq!(refused(|r| r["grid"]["modes_per_speed"] = json!([2, 2])).await, ["/grid/modes_per_speed/1"]);
    assert_eq!(refused(|r| r["grid"]["modes_per_speed"] = json!([0, 501])).await.len(), 2);
    assert_eq!(
        refused(|r| r["grid"]["steps_per_revolution"] = json!([16, 9_000_000])).await,
        ["/grid/steps_per_revolution/0", "/grid/steps_per_revolution/1"]
    );
    assert_eq!(refused(|r| r["grid"]["schemes"] = json!(["auto"])).await, ["/grid/schemes/0"]);
    assert_eq!(refused(|r| r["history_revolutions"] = json!(7)).await, ["/history_revolutions"]);
    assert_eq!(
        refused(|r| r["speeds"] = json!({"from": 1, "to": 9, "count": 9, "unit": "rad_s"})).await,
        ["/speeds"]
    );
    assert_eq!(
        refused(|r| r["scene"]["damping"]["modal_ratio"] = json!(-1)).await,
        ["/scene/damping/modal_ratio"]
    );
    assert_eq!(
        refused(|r| r["sensors"] = json!([{"contact_node": 9, "component": "radial"}])).await,
        ["/sensors/0/contact_node"]
    );
    app.stop().await;
}

#[tokio::test]
async fn a_killed_study_goes_on_with_the_runs_it_has() {
    let data = tempfile::tempdir().unwrap();
    let program = Program::serve(data.path());
    let model = program.api.model(model::package(1.0)).await;
    let mut request = study_of(&model);
    request["integration"]["revolutions"] = json!(400);
    let id = program.api.post("/v1/studies", &request).await.text("/id");
    program.api.follow(&id, |job| job["progress"].as_u64() >= Some(20)).await;
    program.kill();

    let costs = async |api: &Api, id: &str| {
        let found = api.get(&format!("/v1/jobs/{id}/work-precision")).await.body;
        let runs = |speed: &Value| speed["runs"].as_array().unwrap().clone();
        let runs: Vec<Value> = found["speeds"].as_array().unwrap().iter().flat_map(runs).collect();
        runs.iter().map(|run| run["cost"].clone()).collect::<Vec<_>>()
    };
    let program = Program::serve(data.path());
    assert!(program.api.job(&id).await.body["progress"].as_u64() >= Some(20), "progress is kept");
    assert_eq!(program.api.finish(&id).await["status"], "successful");
    let first = costs(&program.api, &id).await;
    // Another job on the same scene computes nothing: times, which no second computation would repeat, are the same.
    let again = program.api.post("/v1/studies", &request).await.text("/id");
    assert_eq!(program.api.finish(&again).await["status"], "successful");
    assert_eq!(costs(&program.api, &again).await, first);
}
