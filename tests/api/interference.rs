//! Interference diagrams, and families that are followed over speed.

use serde_json::{Value, json};

use super::app::{TestApp, modal_analysis_of};
use super::model;

#[tokio::test]
async fn the_order_of_speeds_changes_no_family() {
    let app = TestApp::start().await;
    let model = app.api.model(model::package(1.0)).await;
    let mut found = Vec::new();
    for speeds in [[0.0, 900.0, 300.0, 600.0], [600.0, 300.0, 900.0, 0.0]] {
        let mut request = modal_analysis_of(&model);
        request["speeds"] = speeds.iter().map(|speed| json!({"values": [speed], "unit": "rad_s"})).collect();
        let id = app.api.post("/v1/modal-analyses", &request).await.text("/id");
        assert_eq!(app.api.finish(&id).await["status"], "successful");
        let campbell = app.api.get(&format!("/v1/jobs/{id}/campbell")).await.body;
        let parts = ["speeds_rad_s", "frequencies_hz", "followed", "crossings", "driven_crossings"];
        found.push(parts.map(|part| serde_json::to_string(&campbell[part]).unwrap()));
    }
    assert_eq!(found[0], found[1]);
    assert!(found[0][2].contains("assurance"));
    app.stop().await;
}

/// Rank, asked for, has nothing that was followed.
#[tokio::test]
async fn families_by_rank_are_not_followed() {
    let app = TestApp::start().await;
    let model = app.api.model(model::package(1.0)).await;
    let mut request = modal_analysis_of(&model);
    request["families_by"] = json!("rank");
    let id = app.api.post("/v1/modal-analyses", &request).await.text("/id");
    assert_eq!(app.api.finish(&id).await["status"], "successful");
    let campbell = app.api.get(&format!("/v1/jobs/{id}/campbell")).await.body;
    assert_eq!((&campbell["followed"], &campbell["settings"]["families_by"]), (&Value::Null, &json!("rank")));
    let diagram = app.api.get(&format!("/v1/jobs/{id}/interference")).await.body;
    assert_eq!(diagram["families_by"], "rank");
    app.stop().await;
}

#[tokio::test]
async fn interference_diagrams_are_made_at_any_speed() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let id = api.post("/v1/modal-analyses", &modal_analysis_of(&model)).await.text("/id");
    assert_eq!(api.finish(&id).await["status"], "successful");
    let campbell = api.get(&format!("/v1/jobs/{id}/campbell")).await.body;
    let path = format!("/v1/jobs/{id}/interference");
    let highest = campbell["speeds_rad_s"].as_array().unwrap().last().unwrap().as_f64().unwrap();

    let at_top = api.get(&path).await.body;
    assert_eq!(at_top["speed_rad_s"].as_f64(), Some(highest));
    let modes = at_top["modes"].as_array().unwrap();
    let last = campbell["frequencies_hz"].as_array().unwrap().last().unwrap();
    for mode in modes {
        let at = |name: &str| mode[name].as_u64().unwrap() as usize;
        assert_eq!(mode["frequency_hz"], last[at("nodal_diameter")][at("family") - 1]);
    }
    // Four sectors: engine orders 1 to 6 drive 1, 2, 1, 0, 1, 2.
    let orders = api.get(&format!("{path}?max_engine_order=6")).await.body["engine_orders"].clone();
    let driven: Vec<u64> =
        orders.as_array().unwrap().iter().map(|order| order["nodal_diameter"].as_u64().unwrap()).collect();
    assert_eq!(driven, [1, 2, 1, 0, 1, 2]);

    let between = api.get(&format!("{path}?speed={}&unit=rad_s&lobes=3", 0.99 * highest)).await.body;
    assert_eq!(between["between_rad_s"][1].as_f64(), Some(highest));
    assert_eq!(between["lobes"], 3);
    for (query, name) in [
        (format!("speed={}", 1.01 * highest), "speed"),
        ("from=3".to_owned(), "to"),
        ("from=3&to=2".to_owned(), "to"),
        ("lobes=0".to_owned(), "lobes"),
        ("max_engine_order=1001".to_owned(), "max_engine_order"),
    ] {
        let items = api.get(&format!("{path}?{query}")).await.problem(400, "invalid-parameter");
        assert_eq!(items[0]["parameter"], name, "{query}");
    }
    app.stop().await;
}
