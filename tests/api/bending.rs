//! Blades that bend far, from the package to the energies of a run.

use serde_json::{Value, json};

use super::app::{TestApp, sweep_of};
use super::model;
use super::run_ups::run_ups_of;
use super::stress::{impeller, package};

/// Request for a sweep in which a generated impeller rubs at two speeds, its blades bending far.
fn bent(model: &str, include: &str) -> Value {
    let mut request = sweep_of(model);
    request["speeds"] = json!({"from": 1200.0, "to": 1500.0, "count": 2, "unit": "rad_s"});
    request["scene"]["geometric_nonlinearity"] = json!({"include": include, "coordinates": 3});
    request
}

#[tokio::test]
async fn blades_bend_far_at_a_price_with_their_energy() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(package(&impeller())).await;
    let mut linear = bent(&model, "full");
    linear["scene"].as_object_mut().unwrap().remove("geometric_nonlinearity");
    let plain = api.sweep(&linear).await;
    api.finish(&plain).await;

    // Planned before the bending is made.
    let mut run_ups = run_ups_of(&model);
    run_ups["scene"]["geometric_nonlinearity"] = json!({"include": "full"});
    let plan = api.post("/v1/run-ups/plan", &run_ups).await;
    assert_eq!(plan.status, 200, "{}", plan.body);
    assert!(plan.body["runs"][0]["steps"].as_u64() > Some(0), "{}", plan.body);
    let seconds = |plan: &Value| plan["estimate"]["computing_time_s"]["contact"].as_f64().unwrap();
    let planned = |request: Value| async move { api.post("/v1/sweeps/plan", &request).await.body };
    let (without, with) = (planned(linear).await, planned(bent(&model, "full")).await);
    assert!(seconds(&with) > seconds(&without), "{with}");

    for include in ["kinematics", "full"] {
        let id = api.sweep(&bent(&model, include)).await;
        api.finish(&id).await;
        let points = |map: Value| map["points"].as_array().unwrap().clone();
        let map = |id: String| async move { api.get(&format!("/v1/jobs/{id}/interaction-map")).await.body };
        let (found, before) = (points(map(id).await), points(map(plain.clone()).await));
        for (point, linear) in found.iter().zip(&before) {
            assert_eq!(point["status"], "completed", "{point}");
            assert!(point["energy_residual"].as_f64() < Some(1e-9), "{point}");
            assert_ne!(point["tip"], linear["tip"], "{include} changes nothing");
            let energy = &point["energy"];
            let checks = point["validity"]["checks"].as_array().unwrap();
            let named = |what: &str| checks.iter().find(|check| check["what"] == what);
            let outside = named("outside_coordinates").unwrap()["value"].as_f64().unwrap();
            assert!((1e-3..1.0).contains(&outside), "three coordinates carry some of the motion: {point}");
            // Blades that stiffen leave nothing that geometry could guess, or a measure tell.
            for what in ["displacement_over_thickness", "displacement_over_chord", "excess_energy"] {
                assert!(include == "kinematics" || named(what).is_none(), "{point}");
            }
            assert!(named("second_order_gap").is_none(), "{point}");
            if include == "full" {
                assert!(energy["bending_work"].as_f64().unwrap() != 0.0, "{point}");
                assert!(energy["bending_residual"].as_f64() < Some(1e-2), "{point}");
            } else {
                assert_eq!(energy["bending_work"], Value::Null, "{point}");
            }
        }
    }
}

#[tokio::test]
async fn scenes_in_which_blades_cannot_bend_far_are_refused_at_their_fields() {
    let app = TestApp::start().await;
    let api = &app.api;
    let meshed = api.model(package(&impeller())).await;
    let refused = |path: &'static str, request: Value| async move {
        api.post(path, &request).await.pointers(422, "invalid-request")
    };
    let with = |field: &str, value: Value| {
        let mut request = bent(&meshed, "full");
        *request.pointer_mut(field).unwrap() = value;
        request
    };
    let mut unstored = bent(&meshed, "full");
    unstored["fields"] = json!(false);
    assert_eq!(refused("/v1/sweeps", unstored).await, ["/fields"]);
    let nine = with("/scene/geometric_nonlinearity/coordinates", json!(9));
    assert_eq!(refused("/v1/sweeps", nine).await, ["/scene/geometric_nonlinearity/coordinates"]);
    let mut rubbing = bent(&meshed, "kinematics");
    rubbing["scene"]["friction"] = json!({"coefficient": 0.1});
    assert_eq!(refused("/v1/sweeps", rubbing).await, ["/scene/friction"]);
    let without_mesh = bent(&api.model(model::package(1.0)).await, "full");
    assert_eq!(refused("/v1/sweeps", without_mesh).await, ["/scene/geometric_nonlinearity"]);
}
