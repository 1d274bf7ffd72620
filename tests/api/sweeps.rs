//! Sweeps, the main job: upload, sweep, poll, results.

use serde_json::{Value, json};

use super::app::{Api, TestApp, modal_analysis_of, sweep_of};
use super::model;

#[tokio::test]
async fn from_package_to_interaction_map() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let answer = api.post("/v1/sweeps", &sweep_of(&model)).await;
    assert_eq!(answer.status, 202, "{}", answer.body);
    let id = answer.text("/id");
    assert_eq!(answer.location, Some(format!("/v1/jobs/{id}")));
    assert_eq!(answer.body["status"], "accepted");

    let job = api.finish(&id).await;
    assert_eq!(job["status"], "successful", "{job}");
    assert_eq!(job["progress"], 100);
    assert_eq!(job["speeds"], json!({"total": 6, "finished": 6, "diverged": 0, "failed": 0}));
    assert!(job["created_at"].as_str() <= job["started_at"].as_str());
    assert!(job["started_at"].as_str() <= job["finished_at"].as_str());

    let map = api.get(&format!("/v1/jobs/{id}/interaction-map")).await.body;
    assert_eq!(map["speeds_rad_s"].as_array().unwrap().len(), 6);
    let columns = map["engine_orders"].as_array().unwrap().len();
    assert_eq!(columns, 4 * 8 + 1, "four bins per engine order, up to 8");
    for row in map["amplitude"].as_array().unwrap() {
        assert_eq!(row.as_array().unwrap().len(), columns);
    }
    assert_eq!(map["points"].as_array().unwrap().len(), 6);
    assert!(
        map["points"].as_array().unwrap().iter().any(|point| point["contact_share"].as_f64().unwrap() > 0.0),
        "lobes higher than the clearance must touch"
    );
    assert_eq!(map["settings"]["sensors"].as_array().unwrap().len(), 2, "the default sensors are shown");
    assert_eq!(map["units"]["length"], "mm");

    let spectra = api.get(&format!("/v1/jobs/{id}/spectra/2")).await.body;
    assert_eq!(spectra["spectra"]["sensors"][0]["amplitude"], map["amplitude"][2]);
    let nodal_diameter =
        api.get(&format!("/v1/jobs/{id}/interaction-map?sensor=1&nodal_diameter=2")).await.body;
    assert_eq!(
        spectra["spectra"]["sensors"][1]["nodal_diameters"][2], nodal_diameter["amplitude"][2],
        "the map of a nodal diameter is a slice of the spectra"
    );

    let table = api.get(&format!("/v1/jobs/{id}/critical-speeds")).await;
    assert_eq!(table.status, 200, "{}", table.body);
    assert!(table.body["critical_speeds"].is_array());
    let other = api.get(&format!("/v1/jobs/{id}/critical-speeds?sensor=1")).await.body;
    assert_eq!(other["sensor"], map["settings"]["sensors"][1]);

    for (query, parameter) in [
        ("sensor=2", "sensor"),
        ("sensor=-1", "sensor"),
        ("nodal_diameter=3", "nodal_diameter"),
        ("sensers=0", "sensers"),
    ] {
        let answer = api.get(&format!("/v1/jobs/{id}/interaction-map?{query}")).await;
        assert_eq!(answer.problem(400, "invalid-parameter")[0]["parameter"], parameter);
    }
    api.get(&format!("/v1/jobs/{id}/spectra/6")).await.problem(404, "speed-not-found");
    api.get(&format!("/v1/jobs/{id}/campbell")).await.problem(409, "wrong-job-kind");
    assert_eq!(api.delete(&format!("/v1/jobs/{id}")).await.status, 204);
    app.stop().await;
}

#[tokio::test]
async fn from_package_to_campbell_diagram() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let answer = api.post("/v1/modal-analyses", &modal_analysis_of(&model)).await;
    assert_eq!(answer.status, 202, "{}", answer.body);
    let id = answer.text("/id");
    let job = api.finish(&id).await;
    assert_eq!(job["status"], "successful", "{job}");
    assert_eq!(job["kind"], "modal_analysis");
    let campbell = api.get(&format!("/v1/jobs/{id}/campbell")).await.body;
    let frequencies = campbell["frequencies_hz"].as_array().unwrap();
    assert_eq!(frequencies.len(), 7);
    assert_eq!(frequencies[0].as_array().unwrap().len(), 3, "nodal diameters 0, 1 and 2 of 4 sectors");
    assert_eq!(frequencies[0][0].as_array().unwrap().len(), 2);
    api.get(&format!("/v1/jobs/{id}/interaction-map")).await.problem(409, "wrong-job-kind");
    app.stop().await;
}

#[tokio::test]
async fn the_number_of_workers_changes_no_bit() {
    let mut all = Vec::new();
    for workers in [1, 2] {
        let app = TestApp::start_with(|config| config.workers = Some(workers)).await;
        let model = app.api.model(model::package(1.0)).await;
        let id = app.api.sweep(&sweep_of(&model)).await;
        assert_eq!(app.api.finish(&id).await["status"], "successful");
        all.push(spectra(&app.api, &id, 6).await);
        app.stop().await;
    }
    assert_eq!(all[0], all[1]);
}

/// Spectra of all speeds of a sweep. JSON carries every number exactly.
async fn spectra(api: &Api, id: &str, speeds: u32) -> Vec<Value> {
    let mut all = Vec::new();
    for speed in 0..speeds {
        let spectra = api.get(&format!("/v1/jobs/{id}/spectra/{speed}")).await.body["spectra"].clone();
        assert!(spectra.is_object());
        all.push(spectra);
    }
    all
}

#[tokio::test]
async fn what_only_the_reduced_model_can_tell_fails_the_job_with_a_pointer() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let mut request = sweep_of(&model);
    request["integration"]["scheme"] = "central_differences".into();
    request["integration"]["steps_per_revolution"] = 40.into();
    let id = api.sweep(&request).await;
    let job = api.finish(&id).await;
    assert_eq!(job["status"], "failed", "{job}");
    assert_eq!(job["error"]["type"], "urn:rubmap:problem:invalid-request");
    assert_eq!(job["error"]["errors"][0]["pointer"], "/integration/steps_per_revolution");
    assert_eq!(job["speeds"]["finished"], 0, "nothing runs before the check");
    // Now that the reduction is stored, the same refusal comes at once.
    let again = api.post("/v1/sweeps", &request).await.problem(422, "invalid-request");
    assert_eq!(Value::from(again), job["error"]["errors"]);
    api.get(&format!("/v1/jobs/{id}/critical-speeds")).await.problem(409, "result-unavailable");
    api.get(&format!("/v1/jobs/{id}/spectra/0")).await.problem(404, "speed-not-found");
    app.stop().await;
}

/// A sweep whose speeds all fail by themselves has failed: they are no result.
#[tokio::test]
async fn a_sweep_without_a_completed_speed_has_failed() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let mut request = sweep_of(&model);
    request["scene"]["initial"] = json!({"nodal_diameter": 0, "family": 99, "amplitude": 0.01});
    let id = api.sweep(&request).await;
    let job = api.finish(&id).await;
    assert_eq!((&job["status"], &job["speeds"]["failed"]), (&json!("failed"), &json!(6)), "{job}");
    assert_eq!(job["error"]["type"], "urn:rubmap:problem:nothing-completed");
    let detail = job["error"]["detail"].as_str().unwrap();
    assert!(detail.starts_with("none of the 6 speeds was completed: 0 diverged, 6 could not"), "{detail}");
    assert!(detail.contains("at 300.000000 rad/s nodal diameter 0 of the reduced wheel has"), "{detail}");
    // Finished speeds stay readable; results of all speeds together are not there, and the answer says where to look.
    let map = api.get(&format!("/v1/jobs/{id}/interaction-map")).await;
    assert_eq!((map.status.as_u16(), map.body["points"].as_array().unwrap().len()), (200, 6));
    let critical = api.get(&format!("/v1/jobs/{id}/critical-speeds")).await;
    critical.problem(409, "result-unavailable");
    assert!(critical.text("/detail").contains("the interaction map has those that are done"));
    app.stop().await;
}

#[tokio::test]
async fn the_reduction_is_computed_once() {
    let data = tempfile::tempdir().unwrap();
    let app = TestApp::start_on(data.path()).await;
    let model = app.api.model(model::package(1.0)).await;
    // Two jobs at once share a reduction, and so does a third after a restart.
    let first = app.api.post("/v1/modal-analyses", &modal_analysis_of(&model)).await.text("/id");
    let second = app.api.post("/v1/modal-analyses", &modal_analysis_of(&model)).await.text("/id");
    let mut reductions = Vec::new();
    for id in [&first, &second] {
        assert_eq!(app.api.finish(id).await["status"], "successful");
        reductions.push(app.api.get(&format!("/v1/jobs/{id}/campbell")).await.body["reduction"].clone());
    }
    app.stop().await;
    let app = TestApp::start_on(data.path()).await;
    let third = app.api.post("/v1/modal-analyses", &modal_analysis_of(&model)).await.text("/id");
    assert_eq!(app.api.finish(&third).await["status"], "successful");
    reductions.push(app.api.get(&format!("/v1/jobs/{third}/campbell")).await.body["reduction"].clone());
    // The report carries its wall time: no two computations have the same.
    assert!(reductions[0]["wall_time_s"].as_f64().unwrap() > 0.0);
    assert_eq!(reductions[0], reductions[1]);
    assert_eq!(reductions[0], reductions[2]);
    // The model and the job say in words what was found about the stiffness.
    let job = app.api.job(&third).await;
    assert_eq!(job.body["reduction"], reductions[0]);
    let detail = app.api.get(&format!("/v1/models/{model}")).await;
    assert_eq!(detail.body["reductions"], json!([reductions[0]]));
    assert!(detail.text("/reductions/0/stiffening/message").contains("no centrifugal stiffening"));
    app.stop().await;
}
