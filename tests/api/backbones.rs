//! Backbone curves of modal analyses, from the package to the figure.

use serde_json::{Value, json};

use super::app::{TestApp, modal_analysis_of};
use super::formats::get;
use super::model;
use super::stress::{impeller, package};

/// Request for the backbone curves of two nodal diameters of a generated impeller.
fn asked(model: &str, backbones: Value) -> Value {
    let mut request = modal_analysis_of(model);
    request["backbones"] = backbones;
    request
}

#[tokio::test]
async fn frequencies_change_with_the_amplitude() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(package(&impeller())).await;
    let request = asked(&model, json!({"nodal_diameters": [2, 1]}));
    let id = api.post("/v1/modal-analyses", &request).await.text("/id");
    let job = api.finish(&id).await;
    assert_eq!(job["status"], "successful", "{job}");
    let path = format!("/v1/jobs/{id}/backbones");
    assert!(job["links"].as_array().unwrap().contains(&json!({"href": path, "rel": "backbones"})), "{job}");
    // Twice the thickness of the blade at its tip.
    let settings = &job["request"]["backbones"];
    let facts = api.get(&format!("/v1/models/{model}")).await.body;
    let thickness = facts["mesh"]["tip_thickness"].as_f64().unwrap();
    assert_eq!(
        settings,
        &json!({"coordinates": 4, "nodal_diameters": [1, 2], "largest_amplitude": 2.0 * thickness})
    );

    let found = api.get(&path).await.body;
    let campbell = api.get(&format!("/v1/jobs/{id}/campbell")).await.body;
    assert_eq!(found["speed_rad_s"], 900.0);
    let curves = found["curves"].as_array().unwrap();
    let modes: Vec<_> = curves.iter().map(|curve| [&curve["nodal_diameter"], &curve["family"]]).collect();
    assert_eq!(json!(modes), json!([[1, 1], [1, 2], [2, 1], [2, 2]]));
    for curve in curves {
        let number = |point: &Value, name: &str| point[name].as_f64().unwrap();
        let points = curve["points"].as_array().unwrap();
        let (i, family) = (curve["nodal_diameter"].as_u64().unwrap(), curve["family"].as_u64().unwrap());
        let linear = &campbell["frequencies_hz"][6][i as usize][family as usize - 1];
        let begin = number(&points[0], "frequency_hz");
        assert!((begin / linear.as_f64().unwrap() - 1.0).abs() < 1e-9, "{begin} {linear}");
        assert!(points.len() > 10, "{curve}");
        for pair in points.windows(2) {
            assert!(number(&pair[1], "amplitude") > number(&pair[0], "amplitude"));
            assert!(number(&pair[1], "harmonics_percent") < 0.1, "{curve}");
        }
        let change = number(points.last().unwrap(), "change_percent");
        assert!(change.abs() > 1e-3 && change.abs() < 50.0, "{change}");
        let reached = number(points.last().unwrap(), "amplitude") > 1.999 * thickness;
        assert_eq!(curve["complete"], reached, "{curve}");
    }

    // All forms, and the plan with its price.
    let csv = get(api, &format!("{path}?format=csv"), &[]).await.good();
    let columns = "nodal_diameter,family,amplitude_um,frequency_hz,change_percent";
    assert!(csv.text().starts_with(columns), "{}", csv.text());
    let header = csv.text().lines().next().unwrap();
    assert!(header.ends_with("harmonics_percent,complete,end,passed"), "{header}");
    let ends =
        csv.text().lines().filter(|line| line.contains(",true,the largest amplitude is reached,")).count();
    let complete = curves.iter().filter(|curve| curve["complete"] == true);
    let points: usize = complete.map(|curve| curve["points"].as_array().unwrap().len()).sum();
    assert!(points > 0 && ends == points, "{ends} {points}");
    let report = get(api, &format!("/v1/jobs/{id}/report"), &[]).await.good();
    assert!(report.text().contains("Backbone curves at 8,594 rpm"), "{}", report.text());
    let figure = api.get(&format!("{path}?format=plotly")).await.body;
    assert_eq!(figure["layout"]["meta"]["kind"], "backbones");
    let svg = get(api, &format!("{path}?format=svg"), &[]).await.good();
    for words in ["change of the natural frequency, %", "nodal diameter 1"] {
        assert!(svg.text().contains(words), "{}", svg.text());
    }
    let seconds = |plan: Value| plan["computing_time_s"].as_f64().unwrap();
    let plan = |request: Value| async move { api.post("/v1/modal-analyses/plan", &request).await.body };
    let (with, without) = (plan(request).await, plan(modal_analysis_of(&model)).await);
    assert!(without.get("backbones_time_s").is_none(), "{without}");
    let curves = with["backbones_time_s"].as_f64().unwrap();
    assert!(curves > 0.0 && seconds(with) > curves);
}

#[tokio::test]
async fn curves_that_cannot_be_found_are_refused_at_their_fields() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(package(&impeller())).await;
    let refused = |request: Value| async move {
        api.post("/v1/modal-analyses", &request).await.pointers(422, "invalid-request")
    };
    let nine = asked(&model, json!({"coordinates": 9}));
    assert_eq!(refused(nine).await, ["/backbones/coordinates"]);
    // Nothing, a length in a wrong unit, and one beyond all bounds.
    for length in [0.0, 1e12, 1e31] {
        let asked = asked(&model, json!({"largest_amplitude": length}));
        assert_eq!(refused(asked).await, ["/backbones/largest_amplitude"], "{length}");
    }
    let far = asked(&model, json!({"nodal_diameters": [1, 1, 99]}));
    assert_eq!(refused(far).await, ["/backbones/nodal_diameters/1", "/backbones/nodal_diameters/2"]);
    let mut unstored = asked(&model, json!({}));
    unstored["fields"] = json!(false);
    assert_eq!(refused(unstored).await, ["/fields"]);
    let bare = api.model(model::package(1.0)).await;
    assert_eq!(refused(asked(&bare, json!({}))).await, ["/backbones"]);

    let id = api.post("/v1/modal-analyses", &modal_analysis_of(&bare)).await.text("/id");
    api.finish(&id).await;
    api.get(&format!("/v1/jobs/{id}/backbones")).await.problem(409, "result-unavailable");
}
