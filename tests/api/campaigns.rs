//! Campaigns: many designs in one job, each as its own sweep would have it; reported as they come, paused, found again after a kill.

use serde_json::{Value, json};

use super::app::{Api, TestApp, sweep_of};
use super::formats::{get, table};
use super::model;
use super::npz::Npz;
use super::program::Program;

/// Request for a grid of clearance and damping over the three slowest speeds of [`sweep_of`].
pub(crate) fn campaign_of(model: &str) -> Value {
    let mut request = sweep_of(model);
    request["speeds"] = json!({"from": 300.0, "to": 540.0, "count": 3, "unit": "rad_s"});
    request["parameters"] = json!([
        {"name": "clearance", "at": ["/scene/casing/clearance/leading", "/scene/casing/clearance/trailing"], "change": "add",
            "from": -0.05, "to": 0.05, "levels": 2},
        {"name": "damping", "at": ["/scene/damping/modal_ratio"], "distribution": "log_uniform", "from": 0.01, "to": 0.04, "levels": 2},
    ]);
    request["design"] = json!({"kind": "grid"});
    request
}

/// Request for a campaign that looks for the clearance at which the limit is met.
fn threshold_of(model: &str) -> Value {
    let mut request = campaign_of(model);
    request["parameters"][0] =
        json!({"name": "clearance", "at": ["/scene/casing/clearance/leading"], "from": 0.2, "to": 0.5});
    request["parameters"][1]["levels"] = Value::Null;
    request["parameters"][1].as_object_mut().unwrap().remove("levels");
    request["design"] = json!({"kind": "latin_hypercube", "size": 6, "seed": 2});
    request["limit"] = json!(1.0);
    request["threshold"] = json!({"parameter": "clearance", "probability": 0.8, "within": 0.001, "batch": 4, "most_designs": 14});
    request
}

async fn posted(api: &Api, request: &Value) -> String {
    let answer = api.post("/v1/campaigns", request).await;
    assert_eq!(answer.status, 202, "{}", answer.body);
    answer.text("/id")
}

async fn told(api: &Api, id: &str) -> Value {
    let answer = api.get(&format!("/v1/jobs/{id}/campaign")).await;
    assert_eq!(answer.status, 200, "{}", answer.body);
    answer.body
}

/// Results of a campaign without the times of this machine.
fn timeless(mut campaign: Value) -> Value {
    campaign["spent"]["computing_time_s"] = Value::Null;
    campaign["plan"] = Value::Null;
    campaign
}

/// Every design has the severities of a sweep of the same scene, to the bit; and the list of jobs has one line.
#[tokio::test]
async fn designs_are_what_their_sweeps_are() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let mut request = campaign_of(&model);
    request["parameters"][0]["name"] = json!("clearance_mm");
    let plan = api.post("/v1/campaigns/plan", &request).await;
    assert_eq!(plan.status, 200, "{}", plan.body);
    assert_eq!((&plan.body["reduction"], &plan.body["estimate"]), (&json!("to be computed"), &Value::Null));
    assert_eq!(api.get("/v1/jobs").await.body["jobs"], json!([]), "a plan starts nothing");

    let id = posted(api, &request).await;
    let job = api.finish(&id).await;
    assert_eq!((&job["status"], &job["kind"]), (&json!("successful"), &json!("campaign")), "{job}");
    assert_eq!((&job["speeds"]["total"], &job["speeds"]["finished"]), (&json!(12), &json!(12)));
    assert_eq!(api.get("/v1/jobs").await.body["jobs"].as_array().unwrap().len(), 1);
    let found = told(api, &id).await;
    assert_eq!(found["designs"].as_array().unwrap().len(), 4);
    let mut settings = found["settings"].clone();
    settings["designs"] = json!([]);
    assert_eq!(job["request"], settings, "designs are told with what they come to");

    for (design, (added, damping)) in [(0, (-0.05, 0.01)), (3, (0.05, 0.04))] {
        let design = &found["designs"][design];
        let values: Vec<f64> =
            design["values"].as_array().unwrap().iter().map(|value| value.as_f64().unwrap()).collect();
        assert!((values[0] - added).abs() < 1e-15 && (values[1] - damping).abs() < 1e-15, "{design}");
        let severities = severities_of(api, &model, &request, &design["values"]).await;
        assert_eq!(design["by_speed"], severities, "{design}");
        let largest = severities.as_array().unwrap().iter().filter_map(Value::as_f64).fold(0.0, f64::max);
        assert_eq!(design["severity"], json!(largest));
    }

    let plan = api.post("/v1/campaigns/plan", &request).await.body;
    assert_eq!(
        (&plan["reduction"], &plan["designs"], &plan["simulations"]),
        (&json!("stored"), &json!(4), &json!(12))
    );
    let [steps, one] = [&plan["estimate"]["steps"], &plan["scene"]["estimate"]["steps"]]
        .map(|steps| steps.as_u64().unwrap());
    assert_eq!((steps, found["plan"]["steps"].as_u64()), (4 * one, Some(steps)));
    let spent = found["spent"]["steps"].as_u64().unwrap();
    assert!(spent <= steps && 4 * spent > steps, "{spent} of {steps}");

    let csv = get(api, &format!("/v1/jobs/{id}/campaign?format=csv"), &[]).await.good();
    let lines = table(csv.text());
    assert_eq!(lines.len(), 5);
    // Parameters stay as the user gave them, whatever their names end in; what the service computed is converted.
    let columns = ["design", "clearance_mm", "damping", "amplitude_um", "worst_speed_rpm", "meets_limit"];
    assert!(lines[0].starts_with(&columns), "{:?}", lines[0]);
    assert_eq!(lines[1][1], "-0.05");
    get(api, &format!("/v1/jobs/{id}/campaign?format=npz"), &[]).await.good();
    let svg = get(api, &format!("/v1/jobs/{id}/campaign?format=svg&parameter=damping"), &[]).await.good();
    assert!(svg.text().contains("over speed and damping"));
    get(api, &format!("/v1/jobs/{id}/campaign?format=plotly"), &[]).await.good();
    assert_eq!(api.get(&format!("/v1/jobs/{id}/campaign?parameter=x")).await.status, 400);
    assert_eq!(api.get(&format!("/v1/jobs/{id}/interaction-map")).await.status, 409);
    app.stop().await;
}

/// Severities of the sweep that a design is.
async fn severities_of(api: &Api, model: &str, request: &Value, values: &Value) -> Value {
    let (added, damping) = (values[0].as_f64().unwrap(), &values[1]);
    let mut sweep = sweep_of(model);
    sweep["speeds"] = request["speeds"].clone();
    sweep["scene"]["damping"]["modal_ratio"] = damping.clone();
    sweep["scene"]["casing"]["clearance"] = json!({"leading": 0.30 + added, "trailing": 0.25 + added});
    let sweep = api.sweep(&sweep).await;
    assert_eq!(api.finish(&sweep).await["status"], "successful");
    let map = api.get(&format!("/v1/jobs/{sweep}/interaction-map")).await.body;
    let largest = |point: &Value| -> f64 {
        let responses = point["responses"].as_array().unwrap().iter();
        responses.map(|response| response["half_peak_to_peak"].as_f64().unwrap()).fold(0.0, f64::max)
    };
    map["points"].as_array().unwrap().iter().map(largest).collect()
}

/// Asserts that no parameter may be called as anything else in tables and archives of this campaign.
async fn columns_are_no_names(api: &Api, request: &Value, id: &str) {
    let named: Vec<&str> = request["parameters"]
        .as_array()
        .unwrap()
        .iter()
        .map(|parameter| parameter["name"].as_str().unwrap())
        .collect();
    let mut columns = std::collections::BTreeSet::new();
    for units in ["rad_s", "rpm", "hz"] {
        let path = format!("/v1/jobs/{id}/campaign?units={units}");
        let csv = get(api, &format!("{path}&format=csv"), &[]).await.good();
        columns.extend(table(csv.text())[0].iter().map(|&name| name.to_owned()));
        let npz = get(api, &format!("{path}&format=npz"), &[]).await.good();
        columns.extend(Npz::read(npz.body()).names().into_iter().map(str::to_owned));
    }
    for column in columns.iter().filter(|column| !named.contains(&column.as_str())) {
        let mut request = request.clone();
        request["parameters"][0]["name"] = json!(column);
        let refused = api.post("/v1/campaigns/plan", &request).await;
        assert_eq!(
            (refused.status.as_u16(), refused.text("/errors/0/pointer").as_str()),
            (422, "/parameters/0/name"),
            "{column}"
        );
    }
}

/// Sensitivities of a real wheel: damping alone, which the severity depends on, and the seed of a mistuning of next to nothing.
#[tokio::test]
async fn sensitivities_are_told() {
    let app = TestApp::start().await;
    let api = &app.api;
    let mut request = campaign_of(&api.model(model::package(1.0)).await);
    request["scene"]["mistuning"] = json!({"spread": 1e-9, "seed": 1});
    request["speeds"] = json!({"values": [420.0], "unit": "rad_s"});
    request["parameters"] = json!([
        {"name": "clearance", "at": ["/scene/casing/clearance/leading"], "from": 0.2, "to": 0.4},
        {"name": "seed", "at": ["/scene/mistuning/seed"], "distribution": "whole", "from": 1.0, "to": 9.0},
    ]);
    request["design"] = json!({"kind": "indices", "size": 8});
    let id = posted(api, &request).await;
    assert_eq!(api.finish(&id).await["status"], "successful");
    let found = told(api, &id).await;
    let of = |place: usize, field: &str| found["sensitivities"]["parameters"][place][field].as_f64().unwrap();
    assert_eq!(found["sensitivities"]["blocks"], json!(8));
    assert!(of(0, "total") > 0.3 && of(0, "total_error") > 0.0, "{}", found["sensitivities"]);
    assert!(of(1, "total") < 1e-3, "{}", found["sensitivities"]);
    columns_are_no_names(api, &request, &id).await;
    app.stop().await;
}

/// Results of both models are those of their sweeps, and neither model goes while a campaign wants it.
#[tokio::test]
async fn two_models_are_compared() {
    let app = TestApp::start().await;
    let api = &app.api;
    let (model, other) = (api.model(model::package(1.0)).await, api.model(model::package(1.1)).await);
    let mut request = campaign_of(&model);
    request["compared_model"] = json!(other);
    let id = posted(api, &request).await;
    assert_eq!(api.post(&format!("/v1/jobs/{id}/pause"), &json!({})).await.body["status"], "paused");
    for model in [&model, &other] {
        assert_eq!(api.delete(&format!("/v1/models/{model}")).await.status, 409);
    }
    api.post(&format!("/v1/jobs/{id}/continue"), &json!({})).await;
    let job = api.finish(&id).await;
    assert_eq!((&job["status"], &job["speeds"]["finished"]), (&json!("successful"), &json!(24)), "{job}");

    let found = told(api, &id).await;
    let design = &found["designs"][1];
    for (model, outcome) in [(&model, design), (&other, &design["compared"])] {
        assert_eq!(outcome["by_speed"], severities_of(api, model, &request, &design["values"]).await);
    }
    let comparison = &found["comparison"];
    let differences: Vec<f64> = (0..4)
        .map(|design| &found["designs"][design])
        .map(|design| design["compared"]["severity"].as_f64().unwrap() - design["severity"].as_f64().unwrap())
        .collect();
    let mean = differences.iter().sum::<f64>() / 4.0;
    assert!((comparison["severity"]["mean"].as_f64().unwrap() - mean).abs() < 1e-12, "{comparison}");
    assert_eq!((&comparison["model"], &comparison["severity"]["pairs"]), (&json!(other), &json!(4)));

    let plan = api.post("/v1/campaigns/plan", &request).await.body;
    assert_eq!((&plan["simulations"], &plan["compared"]["reduction"]), (&json!(24), &json!("stored")));
    let steps = |plan: &Value| plan["estimate"]["steps"].as_u64().unwrap();
    assert_eq!(steps(&plan), 4 * (steps(&plan["scene"]) + steps(&plan["compared"])));
    assert_eq!(found["plan"]["steps"], plan["estimate"]["steps"]);
    let csv = get(api, &format!("/v1/jobs/{id}/campaign?format=csv"), &[]).await.good();
    assert!(table(csv.text())[0].contains(&"compared_amplitude_um"), "{}", csv.text());
    columns_are_no_names(api, &request, &id).await;
    let svg = get(api, &format!("/v1/jobs/{id}/campaign?format=svg"), &[]).await.good();
    assert!(svg.text().contains("difference, compared less own"));

    assert_eq!(api.delete(&format!("/v1/models/{other}")).await.status, 204);
    assert_eq!(told(api, &id).await["comparison"], *comparison, "results outlive their models");
    for unknown in [json!("nobody"), json!(other), json!(model)] {
        request["compared_model"] = unknown;
        let refused = api.post("/v1/campaigns", &request).await;
        assert_eq!(
            (refused.status.as_u16(), refused.text("/errors/0/pointer").as_str()),
            (422, "/compared_model")
        );
    }
    app.stop().await;
}

/// A paused campaign does not go on, its finished designs can be read, and nothing is computed again afterwards.
#[tokio::test]
async fn a_campaign_that_is_set_aside_goes_on() {
    let app = TestApp::start().await;
    let api = &app.api;
    let mut request = campaign_of(&api.model(model::package(1.0)).await);
    request["integration"]["revolutions"] = 500.into();
    let id = posted(api, &request).await;
    api.follow(&id, |job| job["speeds"]["finished"].as_u64() >= Some(2)).await;
    let paused = api.post(&format!("/v1/jobs/{id}/pause"), &json!({})).await;
    assert_eq!((paused.status.as_u16(), &paused.body["status"]), (200, &json!("paused")), "{}", paused.body);
    assert_eq!(api.post(&format!("/v1/jobs/{id}/pause"), &json!({})).await.status, 200);
    let before = told(api, &id).await;
    let count = |campaign: &Value| -> u64 {
        campaign["designs"]
            .as_array()
            .unwrap()
            .iter()
            .map(|design| design["finished"].as_u64().unwrap())
            .sum()
    };
    assert!((2..12).contains(&count(&before)), "{before}");
    assert_eq!(api.get("/v1/jobs?status=paused").await.body["jobs"].as_array().unwrap().len(), 1);
    // The campaign stays paused as long as another job takes, for which there is a worker now.
    let other = api.sweep(&sweep_of(request["model"].as_str().unwrap())).await;
    assert_eq!(api.finish(&other).await["status"], "successful");
    // One speed of each worker, which was being stored at that moment, may have come after the answer.
    assert!(count(&told(api, &id).await) <= count(&before) + 4, "it went on");

    // A job that is paused and continued in quick turns forgets nothing.
    for _ in 0..8 {
        for verb in ["continue", "pause", "continue"] {
            let answer = api.post(&format!("/v1/jobs/{id}/{verb}"), &json!({})).await;
            assert_eq!(answer.status, 200, "{}", answer.body);
        }
    }
    assert_eq!(api.finish(&id).await["status"], "successful");
    let after = told(api, &id).await;
    assert_eq!(count(&after), 12);
    let spent = |campaign: &Value| campaign["spent"]["steps"].as_u64().unwrap();
    assert_eq!(spent(&after) * count(&before), spent(&before) * 12, "all speeds take as many steps");
    for verb in ["pause", "continue"] {
        let refused = api.post(&format!("/v1/jobs/{id}/{verb}"), &json!({})).await;
        assert_eq!(
            (refused.status.as_u16(), &refused.body["type"]),
            (409, &json!("urn:rubmap:problem:job-ended"))
        );
        assert_eq!(
            api.post(&format!("/v1/jobs/0198c5a2-7c1e-7d54-9f3b-2f6d7a6f4b10/{verb}"), &json!({}))
                .await
                .status,
            404
        );
    }
    app.stop().await;
}

/// A campaign that is killed, and paused over a restart, adds the designs and finds the numbers that it would have undisturbed.
#[tokio::test]
async fn a_killed_campaign_ends_as_if_undisturbed() {
    let undisturbed = tempfile::tempdir().unwrap();
    let program = Program::serve(undisturbed.path());
    let model = program.api.model(model::package(1.0)).await;
    let mut request = threshold_of(&model);
    // Half of the first designs meet the limit.
    let mut first = request.clone();
    first.as_object_mut().unwrap().retain(|field, _| field != "limit" && field != "threshold");
    let id = posted(&program.api, &first).await;
    assert_eq!(program.api.finish(&id).await["status"], "successful");
    let first = told(&program.api, &id).await;
    let mut severities: Vec<f64> = first["designs"]
        .as_array()
        .unwrap()
        .iter()
        .map(|design| design["severity"].as_f64().unwrap())
        .collect();
    severities.sort_by(f64::total_cmp);
    request["limit"] = json!(0.5 * (severities[2] + severities[3]));
    let id = posted(&program.api, &request).await;
    assert_eq!(program.api.finish(&id).await["status"], "successful");
    let expected = told(&program.api, &id).await;
    program.kill();
    let designs = expected["designs"].as_array().unwrap().len();
    assert!(designs > 6, "designs were added: {}", expected["threshold"]);

    let data = tempfile::tempdir().unwrap();
    let program = Program::serve(data.path());
    assert_eq!(program.api.model(model::package(1.0)).await, model);
    let id = posted(&program.api, &request).await;
    program.api.follow(&id, |job| job["speeds"]["finished"].as_u64() >= Some(5)).await;
    program.kill();
    let program = Program::serve(data.path());
    // The campaign is in its second round.
    program.api.follow(&id, |job| job["speeds"]["total"].as_u64() > Some(18)).await;
    program.kill();
    let program = Program::serve(data.path());
    let paused = program.api.post(&format!("/v1/jobs/{id}/pause"), &json!({})).await;
    assert_eq!(paused.status, 200, "{}", paused.body);
    program.kill();
    let program = Program::serve(data.path());
    assert_eq!(program.api.job(&id).await.body["status"], "paused");
    program.api.post(&format!("/v1/jobs/{id}/continue"), &json!({})).await;
    assert_eq!(program.api.finish(&id).await["status"], "successful");
    assert_eq!(timeless(told(&program.api, &id).await), timeless(expected));
}

#[tokio::test]
async fn what_makes_no_campaign_is_refused_at_its_field() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let refused = async |change: &dyn Fn(&mut Value), pointer: &str| {
        let mut request = campaign_of(&model);
        change(&mut request);
        let answer = api.post("/v1/campaigns", &request).await;
        assert_eq!(answer.status, 422, "{}", answer.body);
        assert_eq!(api.post("/v1/campaigns/plan", &request).await.body["errors"], answer.body["errors"]);
        let errors = answer.body["errors"].as_array().unwrap();
        assert!(errors.iter().any(|error| error["pointer"] == pointer), "{pointer}: {errors:?}");
    };
    refused(&|request| request["parameters"] = json!([]), "/parameters").await;
    refused(
        &|request| request["parameters"][0]["at"] = json!(["/scene/friction/coefficient"]),
        "/parameters/0/at/0",
    )
    .await;
    refused(
        &|request| request["parameters"][0]["distribution"] = json!("gaussian"),
        "/parameters/0/distribution",
    )
    .await;
    refused(&|request| request["parameters"][1]["to"] = json!(3.0), "/parameters/1").await;
    refused(&|request| request["design"] = json!({"kind": "sobol"}), "/design/size").await;
    refused(&|request| request["severity"] = json!("utilisation"), "/severity").await;
    refused(&|request| request["threshold"] = json!({"parameter": "clearance"}), "/limit").await;
    refused(
        &|request| request["scene"]["damping"]["modal_ratio"] = json!(-1.0),
        "/scene/damping/modal_ratio",
    )
    .await;
    refused(&|request| request["sweep"] = json!("up"), "/sweep").await;
    app.stop().await;
}

/// Plans of sweeps have their turns while the designs of a large campaign are checked, and the check ends with its client.
#[tokio::test]
async fn a_large_campaign_leaves_other_plans_their_turns() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let mut large = campaign_of(&model);
    for parameter in large["parameters"].as_array_mut().unwrap() {
        parameter.as_object_mut().unwrap().remove("levels");
    }
    large["design"] = json!({"kind": "sobol", "size": 8192, "seed": 1});
    let heights: Vec<f64> = (0..2000).map(|k| 0.01 * f64::from(k % 7)).collect();
    let angles: Vec<f64> = (0..2000).map(|k| f64::from(k) * std::f64::consts::TAU / 2000.0).collect();
    large["scene"]["casing"].as_object_mut().unwrap().remove("lobes");
    large["scene"]["casing"]["measured"] =
        json!({"angles_rad": angles, "heights": [heights.clone(), heights], "chord": [0.0, 1.0]});
    let plans = async {
        for _ in 0..2 {
            let plan = api.post("/v1/sweeps/plan", &sweep_of(&model)).await;
            assert_eq!(plan.status, 200, "{}", plan.body);
        }
    };
    tokio::select! {
        biased;
        answer = api.post("/v1/campaigns/plan", &large) => panic!("ahead of two small plans: {}", answer.body),
        () = plans => {}
    }
    app.stop().await;
}
