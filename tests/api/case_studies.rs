//! Case studies, histories of sweeps, and contact over speed.

use serde_json::{Value, json};

use super::app::{Api, TestApp, sweep_of};
use super::model;

/// Request for a case study of speed 2 of [`sweep_of`].
pub(super) fn case_of(model: &str) -> Value {
    let sweep = sweep_of(model);
    let values = sweep["speeds"]["values"].as_array();
    let value = match values {
        Some(values) => values[2].clone(),
        None => {
            let number = |field: &str| sweep["speeds"][field].as_f64().unwrap();
            let (from, to, count) = (number("from"), number("to"), number("count"));
            json!(from + 2.0 * (to - from) / (count - 1.0))
        }
    };
    let mut case = sweep.clone();
    let fields = case.as_object_mut().unwrap();
    fields.remove("speeds");
    fields.insert("speed".to_owned(), json!({"value": value, "unit": sweep["speeds"]["unit"]}));
    case
}

async fn histories(api: &Api, id: &str, speed: u32) -> Value {
    let answer = api.get(&format!("/v1/jobs/{id}/histories?speed={speed}")).await;
    assert_eq!(answer.status, 200, "{}", answer.body);
    answer.body
}

fn numbers(list: &Value) -> Vec<f64> {
    list.as_array().unwrap().iter().map(|number| number.as_f64().unwrap()).collect()
}

/// Histories without the fields that say where they come from.
fn happened(mut histories: Value) -> Value {
    let fields = histories.as_object_mut().unwrap();
    fields.retain(|field, _| !["index", "settings"].contains(&field.as_str()));
    let point = fields["point"].as_object_mut().unwrap();
    point.retain(|field, _| !["index", "wall_time_s", "scheme"].contains(&field.as_str()));
    histories
}

#[tokio::test]
async fn a_case_study_that_diverges_is_counted_so() {
    let app = TestApp::start().await;
    let api = &app.api;
    let mut request = case_of(&api.model(model::package(1.0)).await);
    request["scene"]["engine_order_excitation"] =
        json!([{"order": 1, "contact_nodes": [0], "component": "tangential", "amplitude": 1e12}]);
    let id = api.post("/v1/case-studies", &request).await.text("/id").to_owned();
    let job = api.finish(&id).await;
    let counts = json!({"total": 1, "finished": 1, "diverged": 1, "failed": 0});
    assert_eq!((&job["status"], &job["speeds"]), (&json!("successful"), &counts), "{job}");
    let point = histories(api, &id, 0).await["point"].clone();
    assert_eq!(point["status"], "diverged", "{point}");
    app.stop().await;
}

#[tokio::test]
async fn a_case_study_tells_what_happens_at_a_speed() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let mut request = case_of(&model);
    request["record"] = json!({"revolutions": [0, 2]});
    let answer = api.post("/v1/case-studies", &request).await;
    assert_eq!(answer.body["kind"], "case_study", "{}", answer.body);
    let id = answer.text("/id");
    let job = api.finish(&id).await;
    assert_eq!((&job["status"], &job["speeds"]["total"]), (&json!("successful"), &json!(1)), "{job}");

    let found = histories(api, &id, 0).await;
    let samples = found["samples_per_revolution"].as_u64().unwrap() as usize;
    for sensor in found["sensors"].as_array().unwrap() {
        let (u, v) = (numbers(&sensor["displacement"]), numbers(&sensor["velocity"]));
        assert_eq!((u.len(), v.len()), (2 * samples, 2 * samples));
        // Displacements are the integral of velocities.
        let step = std::f64::consts::TAU / (found["speed_rad_s"].as_f64().unwrap() * samples as f64);
        let travelled: f64 = v.windows(2).map(|pair| 0.5 * step * (pair[0] + pair[1])).sum();
        let most = u.iter().fold(0.0f64, |most, x| most.max(x.abs()));
        assert!((u[u.len() - 1] - u[0] - travelled).abs() < 0.02 * most, "{travelled} of {most}");
    }
    let energy = &found["energy"];
    let parts = ["mechanical", "contact_work", "damping_loss"].map(|part| numbers(&energy[part]));
    let most = parts[0].iter().fold(0.0f64, |most, e| most.max(e.abs()));
    for ((now, work), loss) in parts[0].iter().zip(&parts[1]).zip(&parts[2]) {
        assert!((energy["initial"].as_f64().unwrap() + work - loss - now).abs() < 1e-9 * most);
    }
    let force = found["contact"]["force"].as_array().unwrap();
    assert_eq!((force.len(), force[0].as_array().unwrap().len()), (4, 2), "sectors, contact nodes");
    assert!(force.iter().flat_map(|blade| numbers(&blade[0])).any(|force| force > 0.0), "nothing touched");
    api.get(&format!("/v1/jobs/{id}/interaction-map")).await.problem(409, "wrong-job-kind");
    app.stop().await;
}

#[tokio::test]
async fn histories_are_the_same_however_they_are_asked_for() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let wanted = json!({"speeds": [2], "revolutions": [1, 3]});
    let mut request = sweep_of(&model);
    request["record"] = json!({"histories": wanted});
    let with = api.sweep(&request).await;
    let without = api.sweep(&sweep_of(&model)).await;
    let mut case = case_of(&model);
    case["record"] = json!({"revolutions": [1, 3]});
    let case = api.post("/v1/case-studies", &case).await.text("/id");
    for id in [&with, &without, &case] {
        assert_eq!(api.finish(id).await["status"], "successful");
    }
    let later = api.post(&format!("/v1/jobs/{without}/histories"), &wanted).await;
    assert_eq!(later.body["kind"], "case_study", "{}", later.body);
    let later = later.text("/id");
    assert_eq!(api.finish(&later).await["status"], "successful");

    let truth = histories(api, &with, 2).await;
    assert_eq!(happened(histories(api, &later, 2).await), happened(truth.clone()));
    assert_eq!(happened(histories(api, &case, 0).await), happened(truth.clone()));
    // The case study is the run of the sweep.
    let spectra = api.get(&format!("/v1/jobs/{without}/spectra/2")).await.body;
    for field in ["responses", "contact", "energy", "contact_impulse", "settling"] {
        assert_eq!(truth["point"][field], spectra["point"][field], "{field}");
    }
    api.get(&format!("/v1/jobs/{with}/histories?speed=1")).await.problem(404, "history-not-recorded");
    app.stop().await;
}

#[tokio::test]
async fn histories_of_a_chain_are_those_of_its_speeds() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let mut request = sweep_of(&model);
    request["speeds"] = json!({"values": [500.0, 300.0, 900.0], "unit": "rad_s"});
    request["sweep"] = "up".into();
    let id = api.sweep(&request).await;
    assert_eq!(api.finish(&id).await["status"], "successful");
    let wanted = json!({"speeds": [2], "quantities": ["displacement"]});
    let later = api.post(&format!("/v1/jobs/{id}/histories"), &wanted).await.text("/id");
    assert_eq!(api.finish(&later).await["status"], "successful");
    let found = histories(api, &later, 2).await;
    let spectra = api.get(&format!("/v1/jobs/{id}/spectra/2")).await.body;
    assert_eq!(found["point"]["responses"], spectra["point"]["responses"]);
    assert!(found.get("contact").is_none() && found["sensors"][0].get("velocity").is_none());
    app.stop().await;
}

#[tokio::test]
async fn critical_speeds_can_be_recorded() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let mut request = sweep_of(&model);
    request["record"] = json!({"histories": {"quantities": ["displacement"]}});
    let id = api.sweep(&request).await;
    assert_eq!(api.finish(&id).await["status"], "successful");
    let mut critical = Vec::new();
    for sensor in 0..2 {
        let table = api.get(&format!("/v1/jobs/{id}/critical-speeds?sensor={sensor}")).await.body;
        let peaks = table["critical_speeds"].as_array().unwrap();
        critical.extend(peaks.iter().map(|peak| peak["index"].as_u64().unwrap() as u32));
    }
    assert!(!critical.is_empty());
    let first = api.get(&format!("/v1/jobs/{id}/histories")).await.body;
    assert_eq!(Some(first["index"].as_u64().unwrap() as u32), critical.iter().copied().min());
    for speed in critical {
        assert_eq!(histories(api, &id, speed).await["index"], speed);
    }
    app.stop().await;
}

#[tokio::test]
async fn contact_is_told_per_speed_and_node() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let id = api.sweep(&sweep_of(&model)).await;
    assert_eq!(api.finish(&id).await["status"], "successful");
    let map = api.get(&format!("/v1/jobs/{id}/forces")).await.body;
    let rows = map["rows"].as_array().unwrap();
    assert_eq!(rows.len(), 6);
    for (index, row) in rows.iter().enumerate() {
        let speed = api.get(&format!("/v1/jobs/{id}/spectra/{index}")).await.body;
        assert_eq!(row["summary"], speed["point"]["contact"]);
        let blades = speed["contact"]["impulse_per_revolution"].as_array().unwrap();
        let all: f64 = blades.iter().flat_map(numbers).sum();
        let revolution = std::f64::consts::TAU / speed["point"]["speed_rad_s"].as_f64().unwrap();
        let mean = row["summary"]["mean_force"].as_f64().unwrap();
        assert!((mean - all / revolution).abs() <= 1e-12 * mean, "{mean}");
        for (node, worst) in numbers(&row["impulse_per_revolution"]).into_iter().enumerate() {
            assert_eq!(worst, blades.iter().map(|blade| numbers(blade)[node]).fold(0.0, f64::max));
        }
        assert!(numbers(&row["contact_share"]).iter().all(|share| (0.0..=1.0).contains(share)));
        let peak = row["summary"]["peak_node_force"].as_f64().unwrap();
        assert!(row["summary"]["peak_force"].as_f64().unwrap() >= peak);
    }
    assert!(rows.iter().any(|row| row["summary"]["mean_force"].as_f64().unwrap() > 0.0));
    app.stop().await;
}

#[tokio::test]
async fn one_table_ranks_the_critical_speeds_of_the_wheel() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let mut request = sweep_of(&model);
    // Sensors are at every component of every node of a blade, which all move alike.
    let sensor =
        |node: u32, component: &str| json!({"contact_node": node, "sector": 0, "component": component});
    let components = ["radial", "tangential", "axial"];
    request["sensors"] = (0..2).flat_map(|node| components.map(|c| sensor(node, c))).collect();
    request["peak_prominence"] = json!(0.0);
    let id = api.sweep(&request).await;
    assert_eq!(api.finish(&id).await["status"], "successful");
    let table = api.get(&format!("/v1/jobs/{id}/critical-speeds/wheel")).await;
    assert_eq!(table.status, 200, "{}", table.body);
    let speeds = table.body["critical_speeds"].as_array().unwrap();
    assert!(!speeds.is_empty());
    let severity: Vec<f64> = speeds.iter().map(|speed| speed["severity"].as_f64().unwrap()).collect();
    assert!(severity.is_sorted_by(|a, b| a >= b), "{severity:?}");
    assert_eq!(table.body["sensors"].as_array().unwrap().len(), 6);
    let map = api.get(&format!("/v1/jobs/{id}/interaction-map")).await.body;
    for point in map["points"].as_array().unwrap() {
        // Sensors are read at every sample, tips at some of them.
        let responses = point["responses"].as_array().unwrap();
        let most = responses.iter().map(|r| r["rms"].as_f64().unwrap()).fold(0.0, f64::max);
        let tip = point["tip"]["rms"].as_f64().unwrap();
        assert!((tip - most).abs() < 0.02 * most, "{tip} {most}");
        let (over, clearance) = (point["tip"]["over_clearance"].as_f64().unwrap(), [0.30, 0.25]);
        let node = point["tip"]["contact_node"].as_u64().unwrap() as usize;
        let expected = point["tip"]["half_peak_to_peak"].as_f64().unwrap() / clearance[node];
        assert!((over - expected).abs() < 1e-12 * expected);
    }
    app.stop().await;
}

/// Tips far from the casing, driven at an engine order, move as linear theory says.
#[tokio::test]
async fn what_motion_takes_of_the_clearance_is_linear_where_nothing_touches() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let mut request = case_of(&model);
    request["scene"]["casing"]["clearance"] = json!({"values": [20.0, 30.0]});
    request["scene"]["casing"].as_object_mut().unwrap().remove("lobes");
    request["scene"]["damping"] = json!({"modal_ratio": 0.02});
    request["scene"]["engine_order_excitation"] =
        json!([{"order": 3, "contact_nodes": [0], "component": "radial", "amplitude": 1.0}]);
    request["integration"] = json!({"revolutions": 120, "window_revolutions": 4});
    let id = api.post("/v1/case-studies", &request).await.text("/id");
    assert_eq!(api.finish(&id).await["status"], "successful");
    let point = histories(api, &id, 0).await["point"].clone();
    let number = |field: &str| point["contact"][field].as_f64().unwrap();
    let (found, linear) = (number("clearance_consumption"), number("linear_clearance_consumption"));
    assert!(linear > 0.0 && (found - linear).abs() < 2e-3 * linear, "{found} {linear}");
    assert_eq!(number("mean_force"), 0.0);
    app.stop().await;
}

#[tokio::test]
async fn what_cannot_be_recorded_is_refused_where_it_is_asked_for() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    for (record, pointer) in [
        (json!({"revolutions": [3, 2]}), "/record/revolutions"),
        (json!({"revolutions": [0, 1000]}), "/record/revolutions"),
        (json!({"quantities": ["energy", "energy"]}), "/record/quantities/1"),
        (json!({"quantities": ["stress"]}), "/record/quantities/0"),
    ] {
        let mut case = case_of(&model);
        case["record"] = record;
        let answer = api.post("/v1/case-studies", &case).await;
        assert_eq!(answer.pointers(422, "invalid-request"), [pointer], "{}", answer.body);
    }
    let mut case = case_of(&model);
    case["speed"]["value"] = json!(-1.0);
    assert_eq!(api.post("/v1/case-studies", &case).await.pointers(422, "invalid-request"), ["/speed/value"]);
    for (histories, pointer) in [
        (json!({"speeds": [6]}), "/record/histories/speeds/0"),
        (json!({"speeds": [1, 1]}), "/record/histories/speeds/1"),
        (json!({"speeds": []}), "/record/histories/speeds"),
        (json!({"speeds": "all"}), "/record/histories/speeds"),
        (json!({"revolutions": [0, 9999]}), "/record/histories/revolutions"),
    ] {
        let mut sweep = sweep_of(&model);
        sweep["record"] = json!({"histories": histories});
        let answer = api.post("/v1/sweeps", &sweep).await;
        assert_eq!(answer.pointers(422, "invalid-request"), [pointer], "{}", answer.body);
    }
    let id = api.sweep(&sweep_of(&model)).await;
    api.finish(&id).await;
    let answer = api.post(&format!("/v1/jobs/{id}/histories"), &json!({"speeds": [6]})).await;
    assert_eq!(answer.pointers(422, "invalid-request"), ["/speeds/0"]);
    let modal = api.post("/v1/modal-analyses", &super::app::modal_analysis_of(&model)).await.text("/id");
    api.finish(&modal).await;
    api.post(&format!("/v1/jobs/{modal}/histories"), &json!({})).await.problem(409, "wrong-job-kind");
    app.stop().await;
}
