//! Stress and validity of the speeds of a sweep.

use rubmap::impeller::{ImpellerParameters, generate};
use serde_json::{Value, json};

use super::app::{Api, TestApp, sweep_of};
use super::generation::coarse;
use super::model::{self, files_in};

fn package(parameters: &ImpellerParameters) -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    rubmap::package::write(&generate(parameters).unwrap(), &mut bytes).unwrap();
    bytes.into_inner()
}

/// A generated impeller rubs at two speeds.
fn rubbing(model: &str, stress: Option<Value>) -> Value {
    let mut request = sweep_of(model);
    request["speeds"] = json!({"from": 1200.0, "to": 1500.0, "count": 2, "unit": "rad_s"});
    if let Some(stress) = stress {
        request["record"] = json!({"stress": stress});
    }
    request
}

async fn points(api: &Api, request: &Value) -> Vec<Value> {
    let id = api.sweep(request).await;
    let job = api.finish(&id).await;
    assert_eq!(job["status"], "successful", "{job}");
    let map = api.get(&format!("/v1/jobs/{id}/interaction-map")).await.body;
    map["points"].as_array().unwrap().clone()
}

#[tokio::test]
async fn a_sweep_tells_stress_margin_and_validity() {
    let folder = tempfile::tempdir().unwrap();
    let app = TestApp::start_on(folder.path()).await;
    let api = &app.api;
    let parameters: ImpellerParameters = {
        let mut given = serde_json::to_value(ImpellerParameters::default()).unwrap();
        let wanted = coarse();
        for field in ["contact_nodes", "mesh"] {
            given[field] = wanted[field].clone();
        }
        serde_json::from_value(given).unwrap()
    };
    let model = api.model(package(&parameters)).await;
    let request = rubbing(&model, Some(json!({})));
    let plan = api.post("/v1/sweeps/plan", &request).await;
    assert_eq!(plan.status, 200, "{}", plan.body);
    assert!(plan.body["stress_bytes"].as_u64().unwrap() > 0);
    let radius = plan.body["settings"]["record"]["stress"]["excluded_radius"].as_f64().unwrap();
    assert!(radius > 0.0);

    let found = points(api, &request).await;
    for point in &found {
        let stress = &point["stress"];
        let number = |name: &str| stress[name].as_f64().unwrap_or_else(|| panic!("{name}: {stress}"));
        assert_eq!(number("excluded_radius"), radius);
        assert!(number("excluded_nodes") >= 3.0 && number("followed_nodes") >= 1.0);
        let largest = stress["largest"]["von_mises"].as_f64().unwrap();
        assert!(largest > 0.0 && number("largest_static") > 0.0);
        let revolution = stress["largest"]["revolution"].as_f64().unwrap();
        assert!((11.0..=12.0).contains(&revolution), "the last of 12: {revolution}");
        let cycles = stress["cycles"].as_array().unwrap();
        assert!((1..=20).contains(&cycles.len()), "{stress}");
        let alternating = |cycle: &Value| cycle["alternating"].as_f64().unwrap();
        assert!(cycles.iter().all(|cycle| alternating(cycle) <= largest * (1.0 + 1e-9)));
        let validity = &point["validity"];
        let checks = validity["checks"].as_array().unwrap();
        let names: Vec<&str> = checks.iter().map(|check| check["what"].as_str().unwrap()).collect();
        for name in
            ["displacement_over_thickness", "displacement_over_chord", "rotation", "neighbour_approach"]
        {
            assert!(names.contains(&name), "{validity}");
        }
        // The tip of the generator's blade is so thick, and thicker just below it.
        let of = |name: &str| {
            checks.iter().find(|check| check["what"] == name).unwrap()["value"].as_f64().unwrap()
        };
        assert!(of("displacement_over_thickness") > 0.0 && of("contact_over_lobe") > 0.0);
    }
    let thickness = api.get(&format!("/v1/models/{model}")).await.body["mesh"]["tip_thickness"].clone();
    let thickness = thickness.as_f64().unwrap();
    let [tip, root] = [parameters.tip_thickness, parameters.root_thickness];
    // To the facets of a coarse mesh.
    assert!(thickness > 0.8 * tip && thickness < 0.5 * (tip + root), "{thickness} {tip} {root}");

    // Nothing else of the sweep knows of it, and validity needs none of it.
    let without = points(api, &rubbing(&model, None)).await;
    for (with, without) in found.iter().zip(&without) {
        assert_eq!(with["responses"], without["responses"]);
        assert!(without.get("stress").is_none() && without["validity"]["verdict"].is_string());
    }
    // The same numbers from the files, from another radius fewer places.
    let bases = folder.path().join("bases");
    let names = files_in(&bases.join(&files_in(&bases)[0]));
    assert!(names.iter().any(|name| name.contains("stress-")), "{names:?}");
    app.stop().await;
    let app = TestApp::start_on(folder.path()).await;
    let mut again = rubbing(&model, Some(json!({})));
    again["max_engine_order"] = 8.into();
    again["peak_prominence"] = 0.2.into();
    let again = points(&app.api, &again).await;
    for (first, second) in found.iter().zip(&again) {
        assert_eq!(first["stress"], second["stress"]);
    }
    let wider = points(&app.api, &rubbing(&model, Some(json!({"excluded_radius": 2.0 * radius})))).await;
    for (first, second) in found.iter().zip(&wider) {
        let number = |point: &Value, name: &str| point["stress"][name].as_f64().unwrap();
        assert!(number(second, "excluded_nodes") > number(first, "excluded_nodes"));
        let largest = |point: &Value| point["stress"]["largest"]["von_mises"].as_f64().unwrap();
        assert!(largest(second) <= largest(first));
    }
    app.stop().await;
}

#[tokio::test]
async fn stress_without_elements_is_refused_where_it_is_asked_for() {
    let app = TestApp::start().await;
    let model = app.api.model(model::package(1.0)).await;
    let answer = app.api.post("/v1/sweeps", &rubbing(&model, Some(json!({})))).await;
    assert_eq!(answer.status, 422, "{}", answer.body);
    assert!(answer.body.to_string().contains("/record/stress"), "{}", answer.body);
    let answer = app.api.post("/v1/sweeps", &rubbing(&model, Some(json!({"excluded_radius": -1.0})))).await;
    assert!(answer.body.to_string().contains("/record/stress/excluded_radius"), "{}", answer.body);
    app.stop().await;
}
