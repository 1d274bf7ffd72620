//! Sensors at any node: their names, refusals, and the files that their rows are read from.

use std::path::Path;

use serde_json::{Value, json};

use super::app::{Api, TestApp, sweep_of};
use super::formats;
use super::model::{self, files_in};

/// Bytes before the rows of a basis.
const HEADER: usize = 88;

/// Request for a short sweep with `sensors`.
fn sweep_with(model: &str, sensors: Value) -> Value {
    let mut request = sweep_of(model);
    request["speeds"]["count"] = 2.into();
    request["sensors"] = sensors;
    request
}

/// Runs a sweep; returns the levels of all sensors at all its speeds.
async fn levels(api: &Api, request: &Value) -> Vec<Vec<f64>> {
    let id = api.sweep(request).await;
    let job = api.finish(&id).await;
    assert_eq!(job["status"], "successful", "{job}");
    let map = api.get(&format!("/v1/jobs/{id}/interaction-map")).await.body;
    let points = map["points"].as_array().unwrap().iter();
    let levels = |point: &Value| {
        let responses = point["responses"].as_array().unwrap().iter();
        responses.map(|response| response["rms"].as_f64().unwrap()).collect()
    };
    points.map(levels).collect()
}

/// Files of the only basis.
fn basis(data: &Path) -> Vec<std::path::PathBuf> {
    let root = data.join("bases");
    let [folder] = &files_in(&root)[..] else { panic!("{:?}", files_in(&root)) };
    let folder = root.join(folder);
    files_in(&folder).into_iter().map(|file| folder.join(file)).collect()
}

#[tokio::test]
async fn gauges_are_found_and_refused() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package_with_a_clamped_node()).await;
    let gauge = json!({"at": [42.5, 42.5, 5.0], "direction": [5.0, 5.0, 10.0], "length": 12.0});
    let request = sweep_with(
        &model,
        json!([{"gauge": gauge, "sector": 1}, {"gauge": {"nodes": [2, 5]}}, {"contact_node": 0, "component": "radial"}]),
    );
    let plan = api.post("/v1/sweeps/plan", &request).await;
    assert_eq!(plan.status, 200, "{}", plan.body);
    let placed = &plan.body["placed_sensors"][0];
    assert_eq!((&placed["node"], &placed["end"]["node"]), (&json!(2), &json!(4)), "{placed}");
    let (length, off) = (placed["end"]["length"].as_f64().unwrap(), placed["distance"].as_f64().unwrap());
    assert!((length - 150f64.sqrt()).abs() < 1e-12 && (off - (0.5 * 150f64.sqrt() - 6.0)).abs() < 1e-12);
    assert!(placed["angle_deg"].as_f64().unwrap() < 1e-9 && placed["asked_length"] == 12.0, "{placed}");
    let settled = &plan.body["settings"]["sensors"];
    assert_eq!(settled[0], json!({"sector": 1, "gauge": {"nodes": [2, 4]}}));

    let id = api.sweep(&request).await;
    assert_eq!(api.finish(&id).await["status"], "successful");
    let table =
        formats::get(api, &format!("/v1/jobs/{id}/critical-speeds?sensor=0&format=csv"), &[]).await.good();
    assert!(table.text().contains("rms_strain"), "{}", table.text());
    let map =
        formats::get(api, &format!("/v1/jobs/{id}/interaction-map?sensor=0&format=svg"), &[]).await.good();
    assert!(map.text().contains("strain between nodes 2 and 4 of sector 1"), "{}", map.text());
    let spectra = formats::get(api, &format!("/v1/jobs/{id}/spectra/0?format=csv"), &[]).await.good();
    assert!(spectra.text().contains("amplitude_mm_or_strain"), "{}", spectra.text());

    for (sensor, pointer) in [
        (json!({"gauge": {"nodes": [2, 99]}}), "/sensors/0/gauge/nodes/1"),
        (json!({"gauge": {"nodes": [2, 2]}}), "/sensors/0/gauge/nodes"),
        (json!({"gauge": {"nodes": [2, 4], "length": 3.0}}), "/sensors/0/gauge"),
        (json!({"gauge": {"nodes": [2, 4]}, "component": "radial"}), "/sensors/0"),
        (json!({"gauge": {"at": [0, 0, 0], "direction": [1, 0, 0]}}), "/sensors/0/gauge/length"),
        (
            json!({"gauge": {"at": [0, 0, 0], "direction": [0, 0, 0], "length": 1}}),
            "/sensors/0/gauge/direction",
        ),
        (
            json!({"gauge": {"at": [45, 45, 10], "direction": [1, 0, 0], "length": 0.1}}),
            "/sensors/0/gauge/length",
        ),
        (json!({"gauge": {}}), "/sensors/0/gauge/at"),
        (json!({"gauge": {"at": [4000, 0, 0], "direction": [1, 0, 0], "length": 5}}), "/sensors/0/gauge/at"),
        (
            json!({"gauge": {"at": [42.5, 42.5, 5.0], "direction": [5.0, 5.0, 1.0], "length": 12.0}}),
            "/sensors/0/gauge/direction",
        ),
    ] {
        let refused = api.post("/v1/sweeps", &sweep_with(&model, json!([sensor]))).await;
        assert_eq!(refused.status, 422, "{sensor}: {}", refused.body);
        assert_eq!(refused.body["errors"][0]["pointer"], pointer, "{sensor}: {}", refused.body);
        assert_eq!(refused.body["errors"].as_array().unwrap().len(), 1, "{sensor}: {}", refused.body);
    }
}

#[tokio::test]
async fn nodes_points_and_directions_are_sensors() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package_with_a_clamped_node()).await;
    let request = sweep_with(
        &model,
        json!([
            {"contact_node": 1, "sector": 2, "component": "radial"},
            // This names the same sensor by its number.
            {"node": 4, "sector": 2, "component": "radial"},
            {"nearest": [40.0, 38.0, 0.0], "component": "tangential"},
            {"node": 5, "sector": 3, "direction": [3.0, 0.0, 4.0]},
        ]),
    );
    let plan = api.post("/v1/sweeps/plan", &request).await;
    assert_eq!(plan.status, 200, "{}", plan.body);
    let plan = plan.body;
    assert_eq!(
        plan["placed_sensors"],
        json!([
            {"sensor": 1, "node": 4, "position": [45.0, 45.0, 10.0], "contact_node": 1},
            {"sensor": 2, "node": 2, "position": [40.0, 40.0, 0.0], "distance": 2.0},
            {"sensor": 3, "node": 5, "position": [0.0, 50.0, 0.0]},
        ])
    );
    let settled = &plan["settings"]["sensors"];
    assert_eq!(settled[0], request["sensors"][0], "a contact node is written as ever");
    assert_eq!(settled[2], json!({"node": 2, "sector": 0, "component": "tangential"}));
    // Each of the four nodes has three DOF; there are two contact nodes and three modes, and nodal diameters 0 to 2.
    assert_eq!(plan["basis_bytes_at_most"], 12 * 9 * 16 * 3);

    let id = api.sweep(&request).await;
    assert_eq!(api.finish(&id).await["status"], "successful");
    let map = api.get(&format!("/v1/jobs/{id}/interaction-map?sensor=2")).await.body;
    assert_eq!(map["sensor"], settled[2]);
    for point in map["points"].as_array().unwrap() {
        let responses = point["responses"].as_array().unwrap();
        assert_eq!(responses[0]["rms"], responses[1]["rms"]);
        assert!(responses[2]["rms"].as_f64() > Some(0.0) && responses[3]["rms"].as_f64() > Some(0.0));
    }
    let spectra = api.get(&format!("/v1/jobs/{id}/spectra/0")).await.body;
    assert_eq!(spectra["spectra"]["sensors"][3]["sensor"], settled[3], "{spectra}");
    assert_eq!(api.get(&format!("/v1/jobs/{id}/critical-speeds?sensor=3")).await.status, 200);
    let plan = api.post("/v1/sweeps/plan", &request).await.body;
    assert_eq!((&plan["reduction"], &plan["basis_bytes_at_most"]), (&json!("stored"), &Value::Null));
    // The bases of a model go with it.
    assert_eq!(basis(app.data()).len(), 3);
    assert_eq!(api.delete(&format!("/v1/models/{model}")).await.status, 204);
    assert_eq!(files_in(&app.data().join("bases")), [""; 0]);
    app.stop().await;
}

#[tokio::test]
async fn sensors_that_are_nowhere_or_never_move_are_refused() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package_with_a_clamped_node()).await;
    for (sensor, pointer) in [
        (json!({"node": 77, "component": "radial"}), "/node"),
        (json!({"node": 6, "component": "radial"}), "/node"),
        (json!({"node": 2, "component": "normal"}), "/component"),
        (json!({"component": "radial"}), ""),
        (json!({"contact_node": 0, "node": 2, "component": "radial"}), ""),
        (json!({"node": 2, "nearest": [0, 0, 0], "component": "radial"}), ""),
        (json!({"node": 2}), ""),
        (json!({"node": 2, "component": "radial", "direction": [1, 0, 0]}), "/direction"),
        (json!({"node": 2, "direction": [0, 0, 0]}), "/direction"),
        (json!({"node": 2, "direction": [1, 0]}), "/direction"),
        (json!({"nearest": [1, 0, 0, 0], "component": "axial"}), "/nearest"),
        (json!({"node": 2, "sector": 4, "component": "radial"}), "/sector"),
    ] {
        let sound = json!({"contact_node": 0, "component": "radial"});
        let request = sweep_with(&model, json!([sound, sensor]));
        for path in ["/v1/sweeps/plan", "/v1/sweeps"] {
            let pointers = api.post(path, &request).await.pointers(422, "invalid-request");
            assert_eq!(pointers, [format!("/sensors/1{pointer}")], "{sensor}");
        }
    }
    let request = sweep_with(
        &model,
        json!([{"node": 77, "component": "radial"}, {"contact_node": 9, "component": "axial"}]),
    );
    let pointers = api.post("/v1/sweeps", &request).await.pointers(422, "invalid-request");
    assert_eq!(pointers, ["/sensors/0/node", "/sensors/1/contact_node"]);
    app.stop().await;
}

#[tokio::test]
async fn more_sensors_than_sixty_four() {
    let app = TestApp::start().await;
    let model = app.api.model(model::package(1.0)).await;
    let component = |k: u32| if k.is_multiple_of(2) { "radial" } else { "axial" };
    let sensor = |k: u32| json!({"node": 1 + k % 5, "sector": k % 4, "component": component(k)});
    let sensors: Vec<Value> = (0..130).map(sensor).collect();
    let levels = levels(&app.api, &sweep_with(&model, sensors.into())).await;
    assert!(levels.iter().all(|point| point.len() == 130));
    // Node 5 of a sector is node 1 of the next one.
    for point in levels {
        for k in 0..130 {
            let twin = (0..130).find(|t| k % 5 == 4 && t % 5 == 0 && t % 4 == (k + 1) % 4 && t % 2 == k % 2);
            assert!(twin.is_none_or(|twin| point[k] == point[twin]));
        }
    }
    app.stop().await;
}

#[tokio::test]
async fn a_basis_that_is_lost_is_computed_again() {
    let data = tempfile::tempdir().unwrap();
    let mut request = Value::Null;
    let (mut first, mut written) = (None, None);
    // The file stays as it is; is lost; is damaged in a row, in the header; is cut short; is another's.
    for spoil in 0..6 {
        let app = TestApp::start_on(data.path()).await;
        let api = &app.api;
        let model = api.model(model::package(1.0)).await;
        request = sweep_with(
            &model,
            json!([{"node": 2, "component": "radial"}, {"node": 5, "component": "axial"}]),
        );
        let levels = levels(api, &request).await;
        assert_eq!(first.get_or_insert_with(|| levels.clone()), &levels, "after {spoil}");
        app.stop().await;
        let files = basis(data.path());
        assert_eq!(files.len(), 3);
        let mut bytes = std::fs::read(&files[1]).unwrap();
        assert_eq!(written.get_or_insert_with(|| bytes.clone()), &bytes, "after {spoil}");
        match spoil {
            0 => continue,
            1 => std::fs::remove_file(&files[1]).unwrap(),
            // The radial row of node 2 is the fourth of twelve.
            2 => {
                let row = (bytes.len() - HEADER) / 12;
                bytes[HEADER + 3 * row + 5] ^= 1;
            }
            3 => bytes[40] ^= 1,
            4 => bytes.truncate(100),
            _ => bytes = std::fs::read(&files[2]).unwrap(),
        }
        if spoil > 1 {
            std::fs::write(&files[1], bytes).unwrap();
        }
    }
    // No basis can be stored in this place.
    std::fs::remove_dir_all(data.path().join("bases")).unwrap();
    std::fs::write(data.path().join("bases"), "").unwrap();
    for _ in 0..2 {
        let app = TestApp::start_on(data.path()).await;
        assert_eq!(first.as_ref(), Some(&levels(&app.api, &request).await));
        app.stop().await;
    }
}

#[tokio::test]
async fn a_start_removes_bases_that_nobody_will_read() {
    let data = tempfile::tempdir().unwrap();
    let app = TestApp::start_on(data.path()).await;
    let model = app.api.model(model::package(1.0)).await;
    levels(&app.api, &sweep_with(&model, json!([{"contact_node": 0, "component": "radial"}]))).await;
    app.stop().await;
    let kept = basis(data.path());
    let root = data.path().join("bases");
    std::fs::create_dir(root.join(format!("{}-3", "0".repeat(64)))).unwrap();
    std::fs::write(root.join(format!("{model}-3/unfinished-x")), "killed while writing").unwrap();
    std::fs::write(root.join(format!("{model}-3/0.0.0-1-harmonic-0")), "another version").unwrap();
    let app = TestApp::start_on(data.path()).await;
    assert_eq!(basis(data.path()), kept);
    app.stop().await;
}
