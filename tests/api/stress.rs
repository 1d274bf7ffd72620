//! Stress and validity of the speeds of a sweep.

use rubmap::impeller::{ImpellerParameters, generate};
use rubmap::solid::material::FatigueStrength;
use serde_json::{Value, json};

use super::app::{Api, TestApp, modal_analysis_of, sweep_of};
use super::generation::coarse;
use super::model::{self, files_in};
use super::studies::study_of;

pub(super) fn package(parameters: &ImpellerParameters) -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    rubmap::package::write(&generate(parameters).unwrap(), &mut bytes).unwrap();
    bytes.into_inner()
}

/// Parameters of the generator's impeller with a coarse mesh.
pub(super) fn impeller() -> ImpellerParameters {
    let mut given = serde_json::to_value(ImpellerParameters::default()).unwrap();
    let wanted = coarse();
    for field in ["contact_nodes", "mesh"] {
        given[field] = wanted[field].clone();
    }
    serde_json::from_value(given).unwrap()
}

/// Request for a sweep in which a generated impeller rubs at two speeds.
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
    let parameters = impeller();
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
        // Measures take the place of geometry.
        let measured = names.contains(&"excess_energy");
        let geometry = ["displacement_over_thickness", "displacement_over_chord", "rotation"];
        assert!(geometry.iter().all(|name| names.contains(name) != measured), "{validity}");
        assert!(names.contains(&"second_order_gap") == measured && names.contains(&"neighbour_approach"));
        // The tip of the generator's blade has this thickness, and more just below it.
        let of = |name: &str| {
            checks.iter().find(|check| check["what"] == name).unwrap()["value"].as_f64().unwrap()
        };
        assert!(of(if measured { "excess_energy" } else { "displacement_over_thickness" }) > 0.0);
        assert!(of("contact_over_lobe") > 0.0);
    }
    let thickness = api.get(&format!("/v1/models/{model}")).await.body["mesh"]["tip_thickness"].clone();
    let thickness = thickness.as_f64().unwrap();
    let [tip, root] = [parameters.tip_thickness, parameters.root_thickness];
    // The thickness is found to the facets of a coarse mesh.
    assert!(thickness > 0.8 * tip && thickness < 0.5 * (tip + root), "{thickness} {tip} {root}");

    // No other number of the sweep depends on stress, and validity needs none of it.
    let without = points(api, &rubbing(&model, None)).await;
    for (with, without) in found.iter().zip(&without) {
        assert_eq!(with["responses"], without["responses"]);
        assert!(without.get("stress").is_none() && without["validity"]["verdict"].is_string());
    }
    // Strengths that the request gives count, whatever the model has.
    let strengths = json!({"WHEEL": {"yield_strength": 828.0, "ultimate_strength": 895.0,
        "fatigue_strength": {"amplitude": 500.0, "source": "a handbook"}}});
    let judged = points(api, &rubbing(&model, Some(json!({"strengths": strengths})))).await;
    for (bare, judged) in found.iter().zip(&judged) {
        assert_eq!(bare["stress"]["largest"], judged["stress"]["largest"]);
        let cycle = &judged["stress"]["cycles"][0];
        let [alternating, mean, used] =
            ["alternating", "mean", "utilisation"].map(|name| cycle[name].as_f64().unwrap());
        assert!((used - alternating / 500.0 - mean.max(0.0) / 895.0).abs() < 1e-12);
        assert!(bare["stress"]["cycles"][0].get("utilisation").is_none());
    }
    for (given, pointer) in [
        (json!({"BLADE": {}}), "/record/stress/strengths/BLADE"),
        (json!({"WHEEL": {"yield_strength": -1.0}}), "/record/stress/strengths/WHEEL/yield_strength"),
        (
            json!({"WHEEL": {"ultimate_strength": 1.0, "yield_strength": 2.0}}),
            "/record/stress/strengths/WHEEL/yield_strength",
        ),
    ] {
        let refused = api.post("/v1/sweeps", &rubbing(&model, Some(json!({"strengths": given})))).await;
        assert_eq!(refused.status, 422, "{}", refused.body);
        assert_eq!(refused.text("/errors/0/pointer"), pointer);
    }
    // The files give the same numbers, and from another radius fewer places.
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
async fn stress_has_errors_of_its_own_in_targets_and_studies() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(package(&impeller())).await;

    let mut request = rubbing(&model, Some(json!({})));
    request.as_object_mut().unwrap().remove("modes_per_speed");
    request["scene"]["damping"]["modal_ratio"] = json!(0.05);
    request["accuracy"] = json!({"target": 0.2, "of": "stress"});
    let id = api.sweep(&request).await;
    let job = api.finish(&id).await;
    assert_eq!(job["status"], "successful", "{job}");
    let choice = &job["choice"];
    assert_eq!(choice["accuracy"], json!({"target": 0.2, "of": "stress", "seconds": 3600.0}));
    assert!(choice["reason"].as_str().unwrap().contains("largest stress"), "{choice}");
    let map = api.get(&format!("/v1/jobs/{id}/interaction-map")).await.body;
    let errors = &map["errors"];
    let largest = errors["largest_of_stress"].as_f64().unwrap();
    let of = |list: &str| errors[list].as_array().unwrap().clone();
    let estimated = |entry: &Value| entry["estimated_stress_error"].as_f64().unwrap();
    assert_eq!(of("points").iter().map(estimated).fold(0.0, f64::max), largest);
    assert_eq!(errors["target_met"], largest <= 0.2, "{errors}");
    let of_difference = |control: &Value| 2.5 * control["differences"]["stress"].as_f64().unwrap();
    let mut differences: Vec<f64> = of("controls").iter().map(of_difference).collect();
    differences.sort_by(f64::total_cmp);
    let median = differences[differences.len() / 2];
    for control in of("controls") {
        let expected = of_difference(&control).max(median);
        assert!((estimated(&control) - expected).abs() < 1e-12);
    }

    let mut request = study_of(&model);
    request["speeds"] = json!({"values": [1300.0], "unit": "rad_s"});
    request["scene"] = rubbing(&model, None)["scene"].clone();
    request["grid"] =
        json!({"modes_per_speed": [2, 4], "steps_per_revolution": [720], "schemes": ["exact_modal"]});
    let study = async |request: &Value| {
        let id = api.post("/v1/studies", request).await.text("/id");
        let job = api.finish(&id).await;
        assert_eq!(job["status"], "successful", "{job}");
        (api.get(&format!("/v1/jobs/{id}/work-precision")).await.body, id)
    };
    let (without, _) = study(&request).await;
    request["record"] = json!({"stress": {}});
    let (with, id) = study(&request).await;
    assert!(with["settings"]["record"]["stress"]["excluded_radius"].as_f64() > Some(0.0));
    let runs = |study: &Value| study["speeds"][0]["runs"].as_array().unwrap().clone();
    for (with, without) in runs(&with).iter().zip(&runs(&without)) {
        assert!(with["errors"]["stress"].as_f64() > Some(0.0), "{with}");
        assert!(without["errors"].get("stress").is_none(), "{without}");
        for same in ["history", "amplitude"] {
            assert_eq!(with["errors"][same], without["errors"][same]);
        }
    }
    let judged = |run: &Value| run["pareto"].as_array().is_some_and(|of| of.contains(&json!("stress")));
    assert!(runs(&with).iter().any(judged));
    let drawing = api.request("GET", &format!("/v1/jobs/{id}/work-precision?format=svg&quantity=stress"));
    let drawing = drawing.send().await.unwrap().text().await.unwrap();
    assert!(drawing.contains("largest von Mises stress"));
    app.stop().await;
}

/// Ranks critical speeds by utilisation on request; a map's csv has it as a column.
#[tokio::test]
async fn critical_speeds_are_ranked_by_utilisation_on_request() {
    let app = TestApp::start().await;
    let api = &app.api;
    let mut parameters = impeller();
    parameters.material.ultimate_strength = Some(1000.0);
    parameters.material.fatigue_strength =
        Some(FatigueStrength { amplitude: 400.0, source: "a test".to_owned() });
    let model = api.model(package(&parameters)).await;
    let mut request = rubbing(&model, Some(json!({})));
    request["speeds"] = json!({"from": 700.0, "to": 1500.0, "count": 7, "unit": "rad_s"});
    request["peak_prominence"] = json!(0.0);
    let id = api.sweep(&request).await;
    assert_eq!(api.finish(&id).await["status"], "successful");
    for path in ["critical-speeds", "critical-speeds/wheel"] {
        let table = async |query: &str| {
            let table = api.get(&format!("/v1/jobs/{id}/{path}{query}")).await.body;
            table["critical_speeds"].as_array().unwrap().clone()
        };
        let (usual, ranked) = (table("").await, table("?rank=utilisation").await);
        let used: Vec<f64> = ranked.iter().map(|speed| speed["utilisation"].as_f64().unwrap()).collect();
        println!("{path}: {used:?}");
        assert!(used.len() > 1 && used.is_sorted_by(|a, b| a >= b), "{path}: {used:?}");
        assert!(usual.len() == ranked.len() && usual.iter().all(|speed| ranked.contains(speed)), "{path}");
    }
    let csv = api.request("GET", &format!("/v1/jobs/{id}/interaction-map?format=csv"));
    let csv = csv.send().await.unwrap().text().await.unwrap();
    let rows: Vec<Vec<&str>> = csv.lines().map(|line| line.split(',').collect()).collect();
    let column = rows[0].iter().position(|name| *name == "utilisation").unwrap();
    assert!(rows.len() == 8 && rows[1..].iter().all(|row| row[column].parse::<f64>().unwrap() > 0.0));
    app.stop().await;
}

#[tokio::test]
async fn a_target_or_study_of_stress_is_refused_where_there_is_none() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let refused =
        async |path: &str, request: &Value| api.post(path, request).await.pointers(422, "invalid-request");
    let mut request = rubbing(&model, None);
    request.as_object_mut().unwrap().remove("modes_per_speed");
    request["accuracy"] = json!({"target": 0.2, "of": "stress"});
    assert_eq!(refused("/v1/sweeps", &request).await, ["/accuracy/of"]);
    request["record"] = json!({"stress": {"excluded_radius": 1.0}});
    assert_eq!(refused("/v1/sweeps", &request).await, ["/record/stress"]);
    let mut request = modal_analysis_of(&model);
    request.as_object_mut().unwrap().remove("modes_per_speed");
    request["accuracy"] = json!({"target": 0.2, "of": "stress"});
    assert_eq!(refused("/v1/modal-analyses", &request).await, ["/accuracy/of"]);
    let mut request = study_of(&model);
    request["record"] = json!({"stress": {"excluded_radius": 1.0}});
    assert_eq!(refused("/v1/studies", &request).await, ["/record/stress"]);
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
