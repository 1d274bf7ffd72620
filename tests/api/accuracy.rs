//! Jobs with an accuracy or a budget in place of knobs, and the errors of their results.

use serde_json::{Value, json};

use super::app::{TestApp, modal_analysis_of, sweep_of};
use super::model;

fn without_knobs(mut request: Value) -> Value {
    request.as_object_mut().unwrap().remove("modes_per_speed");
    request
}

#[tokio::test]
async fn a_target_is_planned_met_and_reported() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let mut request = without_knobs(sweep_of(&model));
    request["scene"]["damping"]["modal_ratio"] = json!(0.05);
    request["accuracy"] = json!({"target": 0.05});
    let plan = api.post("/v1/sweeps/plan", &request).await;
    assert_eq!(plan.status, 200, "{}", plan.body);
    assert!(plan.body["choice"].is_null());
    assert_eq!(plan.body["pilot_speeds_rad_s"].as_array().unwrap().len(), 4);

    let id = api.sweep(&request).await;
    let job = api.finish(&id).await;
    assert_eq!(job["status"], "successful", "{job}");
    let choice = &job["choice"];
    assert!(choice["estimated_error"].as_f64() <= Some(0.05), "{choice}");
    assert_eq!((&choice["kind"], &choice["setting"]["scheme"]), (&json!("setting"), &json!("exact_modal")));
    let map = api.get(&format!("/v1/jobs/{id}/interaction-map")).await.body;
    assert_eq!(map["settings"]["modes_per_speed"], choice["setting"]["modes_per_speed"]);
    assert_eq!(
        map["settings"]["integration"]["steps_per_revolution"],
        choice["setting"]["steps_per_revolution"]
    );
    let asked = json!({"target": 0.05, "seconds": 3600.0});
    assert_eq!((&choice["accuracy"], &map["settings"]["accuracy"]), (&asked, &Value::Null));
    assert_eq!(plan.body["settings"]["accuracy"], asked, "the bound is said beforehand");
    assert!(choice["spent_s"].as_f64().is_some_and(|spent| spent > 0.0 && spent < 3600.0), "{choice}");
    assert_eq!(map["settings"]["control_speeds"], 5);
    for point in map["points"].as_array().unwrap() {
        assert_eq!(point["steps_per_revolution"], choice["setting"]["steps_per_revolution"]);
    }
    let errors = &map["errors"];
    assert_eq!(
        (errors["controls"].as_array().unwrap().len(), errors["points"].as_array().unwrap().len()),
        (5, 6)
    );
    assert!(errors["target_met"].is_boolean() && errors["message"].is_string());
    for control in errors["controls"].as_array().unwrap() {
        assert_eq!(
            control["setting"]["steps_per_revolution"].as_u64(),
            Some(2 * choice["setting"]["steps_per_revolution"].as_u64().unwrap())
        );
    }
    let table = api.get(&format!("/v1/jobs/{id}/critical-speeds")).await.body;
    for critical in table["critical_speeds"].as_array().unwrap() {
        let index = &critical["index"];
        let of = errors["points"].as_array().unwrap().iter().find(|point| &point["index"] == index).unwrap();
        assert_eq!(critical["amplitude_error"], of["estimated_error"]);
    }

    // The pilot runs are stored: the plan has the choice at once, and the settings of the result give the same numbers.
    let plan = api.post("/v1/sweeps/plan", &request).await.body;
    assert_eq!(plan["choice"]["setting"], choice["setting"]);
    assert!(plan["estimate"].is_object() && plan["pilot_speeds_rad_s"].is_null());
    let same = api.sweep(&map["settings"]).await;
    assert_eq!(api.finish(&same).await["status"], "successful");
    let same = api.get(&format!("/v1/jobs/{same}/interaction-map")).await.body;
    assert_eq!(same["amplitude"], map["amplitude"]);
    assert_eq!(same["errors"]["points"], map["errors"]["points"]);
    assert!(same["errors"]["target_met"].is_null(), "nobody asked");
    app.stop().await;
}

#[tokio::test]
async fn a_budget_chooses_what_it_pays_for() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let mut request = without_knobs(sweep_of(&model));
    request["budget"] = json!({"seconds": 60});
    let id = api.sweep(&request).await;
    let job = api.finish(&id).await;
    assert_eq!(job["status"], "successful", "{job}");
    assert!(job["choice"]["expected_wall_time_s"].as_f64() < Some(60.0), "{job}");

    request["budget"] = json!({"seconds": 1});
    request["speeds"]["count"] = json!(3000);
    request["integration"]["revolutions"] = json!(200);
    let id = api.sweep(&request).await;
    let job = api.finish(&id).await;
    assert_eq!(
        (&job["status"], &job["error"]["errors"][0]["pointer"]),
        (&json!("failed"), &json!("/budget/seconds"))
    );
    assert_eq!(job["speeds"]["finished"], 0, "said before the sweep spends its time");
    app.stop().await;
}

#[tokio::test]
async fn a_target_that_cannot_be_met_is_said_before_the_sweep() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let mut request = without_knobs(sweep_of(&model));
    request["accuracy"] = json!({"target": 1e-9});
    let id = api.sweep(&request).await;
    let job = api.finish(&id).await;
    assert_eq!(
        (&job["status"], &job["error"]["errors"][0]["pointer"]),
        (&json!("failed"), &json!("/accuracy/target"))
    );
    assert_eq!(job["speeds"]["finished"], 0);
    // The choice is stored, and the plan says so at once.
    let plan = api.post("/v1/sweeps/plan", &request).await;
    assert_eq!(plan.pointers(422, "invalid-request"), ["/accuracy/target"]);
    app.stop().await;
}

#[tokio::test]
async fn a_climb_ends_with_its_time() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let mut request = without_knobs(sweep_of(&model));
    // Every pilot run takes some seconds.
    request["integration"]["revolutions"] = json!(20_000);
    request["accuracy"] = json!({"target": 1e-6, "seconds": 1});
    let id = api.sweep(&request).await;
    let job = api.finish(&id).await;
    let error = &job["error"]["errors"][0];
    assert_eq!((&job["status"], &error["pointer"]), (&json!("failed"), &json!("/accuracy/seconds")), "{job}");
    request["accuracy"]["seconds"] = json!(0.5);
    let pointers = api.post("/v1/sweeps", &request).await.pointers(422, "invalid-request");
    assert_eq!(pointers, ["/accuracy/seconds"]);
    app.stop().await;
}

#[tokio::test]
async fn a_modal_analysis_takes_as_many_modes_as_its_accuracy_needs() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let mut request = without_knobs(modal_analysis_of(&model));
    request["accuracy"] = json!({"target": 1e-6});
    let answer = api.post("/v1/modal-analyses", &request).await;
    let id = answer.text("/id");
    let job = api.finish(&id).await;
    assert_eq!(job["status"], "successful", "{job}");
    assert!(job["choice"]["error"].as_f64() <= Some(1e-6), "{job}");
    let campbell = api.get(&format!("/v1/jobs/{id}/campbell")).await.body;
    assert_eq!(campbell["settings"]["modes_per_speed"], job["choice"]["modes_per_speed"]);
    let plan = api.post("/v1/modal-analyses/plan", &request).await.body;
    assert_eq!(
        plan["choice"],
        json!({
            "accuracy": {"target": 1e-6, "seconds": 3600.0}, "modes_per_speed": job["choice"]["modes_per_speed"], "error": job["choice"]["error"],
            "reason": job["choice"]["reason"], "tried": job["choice"]["tried"],
        })
    );
    app.stop().await;
}

#[tokio::test]
async fn knobs_beside_an_accuracy_are_refused() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let mut request = sweep_of(&model);
    request["accuracy"] = json!({"target": 0.01});
    request["budget"] = json!({"seconds": 10});
    request["integration"]["steps_per_revolution"] = json!(3600);
    let pointers = api.post("/v1/sweeps", &request).await.pointers(422, "invalid-request");
    assert_eq!(pointers, ["/budget", "/modes_per_speed", "/integration/steps_per_revolution"]);
    let mut request = without_knobs(sweep_of(&model));
    request["accuracy"] = json!({"target": 0});
    assert_eq!(api.post("/v1/sweeps", &request).await.pointers(422, "invalid-request"), ["/accuracy/target"]);
    request["accuracy"] = json!({"target": 0.1});
    request["sweep"] = json!("up");
    request["control_speeds"] = json!(3);
    assert_eq!(api.post("/v1/sweeps", &request).await.pointers(422, "invalid-request"), ["/control_speeds"]);
    app.stop().await;
}
