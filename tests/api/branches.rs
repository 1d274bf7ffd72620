//! Branches of periodic responses: followed, reported as they come, found again after a kill.

use serde_json::{Value, json};

use super::app::{Api, TestApp, sweep_of};
use super::case_studies::case_of;
use super::formats::get;
use super::model;
use super::program::Program;

/// Request for branches over speed about the one of [`case_of`].
pub(super) fn branches_of(model: &str) -> Value {
    let mut request = case_of(model);
    request["scene"]["damping"] = json!({"modal_ratio": 0.02});
    let speed = request["speed"]["value"].as_f64().unwrap();
    request["along"] = json!({"parameter": "speed", "from": 0.97 * speed, "to": 1.03 * speed});
    request
}

async fn followed(api: &Api, request: &Value) -> Value {
    let answer = api.post("/v1/branches", request).await;
    assert_eq!(answer.status, 202, "{}", answer.body);
    let id = answer.text("/id");
    let job = api.finish(&id).await;
    assert_eq!(job["status"], "successful", "{job}");
    let found = api.get(&format!("/v1/jobs/{id}/branches")).await;
    assert_eq!(found.status, 200, "{}", found.body);
    found.body
}

fn values(branch: &Value) -> Vec<f64> {
    branch["points"].as_array().unwrap().iter().map(|point| point["value"].as_f64().unwrap()).collect()
}

/// Every stable point of a branch is the limit of a long march at its speed, and the ends are where they were asked for.
#[tokio::test]
async fn branches_are_followed_to_both_ends_and_march_to_the_same() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let request = branches_of(&model);
    let plan = api.post("/v1/branches/plan", &request).await;
    assert_eq!(plan.status, 200, "{}", plan.body);
    assert_eq!(plan.body["reduction"], "to be computed");
    assert_eq!((&plan.body["point"], &plan.body["estimate"]), (&Value::Null, &Value::Null));
    assert_eq!(api.get("/v1/jobs").await.body["jobs"], json!([]), "a plan starts nothing");
    let found = followed(api, &request).await;
    assert_planned(&api.post("/v1/branches/plan", &request).await.body, &found);
    assert_eq!((&found["complete"], &found["parameter"]), (&json!(true), &json!("speed")));
    let branch = &found["branches"][0];
    let ends: Vec<&Value> = branch["ends"].as_array().unwrap().iter().map(|end| &end["why"]).collect();
    assert_eq!(ends, ["leaves_range", "leaves_range"], "{branch}");
    let speeds = values(branch);
    let unit = match request["speed"]["unit"].as_str().unwrap() {
        "rpm" => std::f64::consts::TAU / 60.0,
        "hz" => std::f64::consts::TAU,
        _ => 1.0,
    };
    let along = |field: &str| unit * request["along"][field].as_f64().unwrap();
    assert!((speeds[0] / along("from") - 1.0).abs() < 1e-12, "{speeds:?}");
    assert!((speeds.last().unwrap() / along("to") - 1.0).abs() < 1e-12, "{speeds:?}");
    assert!(speeds.len() > 10, "{speeds:?}");
    for point in branch["points"].as_array().unwrap() {
        assert!(point["residual"].as_f64().unwrap() <= 1e-8, "{point}");
        assert_eq!(point["speed_rad_s"], point["value"]);
    }

    let stable: Vec<&Value> =
        branch["points"].as_array().unwrap().iter().filter(|point| point["stability"] == "stable").collect();
    assert!(stable.len() > 2, "{branch}");
    let mut sweep = sweep_of(&model);
    sweep["scene"] = request["scene"].clone();
    sweep["integration"] = request["integration"].clone();
    sweep["integration"]["revolutions"] = json!(400);
    for knob in ["scheme", "kept_modes", "steps_per_revolution"] {
        if !found[knob].is_null() {
            sweep["integration"][knob] = found[knob].clone();
        }
    }
    let some: Vec<&Value> = stable.iter().step_by(stable.len().div_ceil(8)).copied().collect();
    let speeds: Vec<&Value> = some.iter().map(|point| &point["value"]).collect();
    sweep["speeds"] = json!({"values": speeds, "unit": "rad_s"});
    let id = api.sweep(&sweep).await;
    assert_eq!(api.finish(&id).await["status"], "successful");
    let map = api.get(&format!("/v1/jobs/{id}/interaction-map")).await.body;
    let mut settled = 0;
    for (point, marched) in some.into_iter().zip(map["points"].as_array().unwrap()) {
        // A response may be stable by its multipliers, and attract nothing but what starts next to it.
        if marched["settling"]["largest_change"].as_f64() > Some(1e-9) {
            continue;
        }
        settled += 1;
        let marched = marched["responses"][0]["half_peak_to_peak"].as_f64().unwrap();
        let solved = point["half_peak_to_peak"][0].as_f64().unwrap();
        assert!((solved / marched - 1.0).abs() < 1e-8, "{solved} {marched}: {point}");
    }
    assert!(settled > 1, "{map}");
}

/// A branch that is followed from a hair beside its largest amplitude has the same maximum as from elsewhere.
#[tokio::test]
async fn a_maximum_where_a_branch_begins_is_found() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let mut request = branches_of(&model);
    request["scene"]["damping"] = json!({"modal_ratio": 0.05});
    request["doubled"] = json!(false);
    request["speed"] = json!({"value": 446.0, "unit": "rad_s"});
    request["along"] = json!({"parameter": "speed", "from": 436.0, "to": 450.0});
    let found = followed(api, &request).await;
    let maxima = found["branches"][0]["maxima"].as_array().unwrap();
    let number = |maximum: &Value, field: &str| maximum[field].as_f64().unwrap();
    let by_height =
        |a: &&Value, b: &&Value| number(a, "half_peak_to_peak").total_cmp(&number(b, "half_peak_to_peak"));
    let highest = maxima.iter().max_by(by_height).expect("a maximum");
    let at = number(highest, "value");
    request["speed"] = json!({"value": at * (1.0 - 1e-3), "unit": "rad_s"});
    request["along"] = json!({"parameter": "speed", "from": 0.975 * at, "to": 1.02 * at});
    let again = followed(api, &request).await;
    let maxima = again["branches"][0]["maxima"].as_array().unwrap();
    // It is the same as well as steps of time let it be known.
    let same = maxima.iter().find(|other| {
        let off = |field: &str| (number(other, field) / number(highest, field) - 1.0).abs();
        other["sensor"] == highest["sensor"] && off("value") < 5e-3 && off("half_peak_to_peak") < 1e-3
    });
    assert!(same.is_some(), "{highest} is not in {maxima:?}");
    app.stop().await;
}

/// Asserts that branches that go to both ends were stepped as planned, and took no more than that.
fn assert_planned(plan: &Value, found: &Value) {
    assert_eq!(plan["reduction"], "stored");
    let (point, points) = (&plan["point"], found["branches"][0]["points"].as_array().unwrap().len() as u64);
    assert_eq!(point["scheme"]["name"], found["scheme"], "{plan}");
    assert_eq!(point["steps_per_revolution"], found["steps_per_revolution"]);
    let [least, most] = ["points_at_least", "points_at_most"].map(|field| plan[field].as_u64().unwrap());
    assert!(50 <= least && least <= points && points <= most, "{points} points: {plan}");
    assert_eq!(plan["settings"], found["settings"]);
    let [one, all] = [&point["computing_time_s"], &plan["estimate"]["wall_time_s"]];
    for end in ["free", "contact"] {
        let [one, all] = [one, all].map(|time| time[end].as_f64().unwrap());
        assert!(one > 0.0 && (all / (least as f64 * one) - 1.0).abs() < 1e-12, "{plan}");
    }
}

/// A branch of doubled period does not have, where it begins, the stability of the flip: the flip is followed once, by a branch of twice the period.
#[tokio::test]
async fn a_flip_is_doubled_once() {
    let app = TestApp::start().await;
    let api = &app.api;
    let wheel = json!({"sectors": 9, "contact_nodes": 3, "gyroscopic": true});
    let generation = api.post("/v1/models", &wheel).await.text("/id");
    let mut request = branches_of(api.finish(&generation).await["model"].as_str().unwrap());
    request["speed"] = json!({"value": 1559.0, "unit": "rad_s"});
    request["along"] = json!({"parameter": "speed", "from": 1558.0, "to": 1560.5});
    request["scene"] = json!({
        "centrifugal_stiffening": true,
        "damping": {"modal_ratio": 0.005},
        "casing": {
            "clearance": {"leading": 0.30, "trailing": 0.22},
            "lobes": {"count": 2, "amplitude": 0.425, "width_rad": 0.35},
        },
        "contact": {},
    });
    request["integration"] = json!({});
    request["most_points"] = json!(20);
    let found = followed(api, &request).await;
    let branches = found["branches"].as_array().unwrap();
    assert!(branches.len() > 1, "{found}");
    for branch in &branches[1..] {
        assert_eq!((&branch["doubles"][0], &branch["lobe_passages"]), (&json!(0), &json!(2)), "{branch}");
        let begins = branch["doubles"][1].as_f64().unwrap();
        let again = branch["bifurcations"].as_array().unwrap().iter().any(|bifurcation| {
            let [value, error] = ["value", "error"].map(|field| bifurcation[field].as_f64().unwrap());
            bifurcation["kind"] == "flip" && (value - begins).abs() <= error
        });
        assert!(!again, "{branch}");
    }
    app.stop().await;
}

/// Branches over damping, clearance and the lobes: the scene as it is lies on each, with the same amplitude.
#[tokio::test]
async fn branches_over_other_numbers_pass_through_the_scene_as_it_is() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let mut amplitudes = Vec::new();
    for (parameter, from, to) in
        [("damping", 0.9, 1.0), ("clearance", 0.998, 1.002), ("lobe_amplitude", 0.998, 1.0)]
    {
        let mut request = branches_of(&model);
        request["along"] = json!({"parameter": parameter, "from": from, "to": to});
        request["most_points"] = json!(8);
        let found = followed(api, &request).await;
        let branch = &found["branches"][0];
        let place = values(branch).iter().position(|&value| value == 1.0).expect("the scene as it is");
        amplitudes.push(branch["points"][place]["half_peak_to_peak"][0].as_f64().unwrap());
    }
    assert!(amplitudes.iter().all(|amplitude| amplitude == &amplitudes[0]), "{amplitudes:?}");
}

/// Rest is the response, at every speed, where nothing ever touches.
#[tokio::test]
async fn rest_is_a_branch_too() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let mut request = branches_of(&model);
    request["scene"]["casing"]["lobes"]["amplitude"] = json!(1e-6);
    let found = followed(api, &request).await;
    let branch = &found["branches"][0];
    assert_eq!(branch["ends"].as_array().unwrap().len(), 2, "{branch}");
    for point in branch["points"].as_array().unwrap() {
        assert_eq!(
            (&point["stability"], &point["half_peak_to_peak"][0]),
            (&json!("stable"), &json!(0.0)),
            "{point}"
        );
    }
    assert_eq!(branch["bifurcations"], json!([]));
    assert_eq!(branch["maxima"], json!([]));
}

#[tokio::test]
async fn what_cannot_be_followed_is_refused_at_its_field() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let deformed = api.model(model::deformed_package()).await;
    let refused = async |change: &dyn Fn(&mut Value), pointer: &str| {
        let mut request = branches_of(&model);
        change(&mut request);
        let answer = api.post("/v1/branches", &request).await;
        assert_eq!(answer.status, 422, "{}", answer.body);
        assert_eq!(api.post("/v1/branches/plan", &request).await.body["errors"], answer.body["errors"]);
        let errors = answer.body["errors"].as_array().unwrap();
        assert!(errors.iter().any(|error| error["pointer"] == pointer), "{pointer}: {errors:?}");
    };
    refused(&|request| request["along"]["from"] = json!(1e9), "/along/from").await;
    refused(&|request| request["along"]["to"] = json!(0.0), "/along/to").await;
    refused(
        &|request| request["along"] = json!({"parameter": "damping", "from": 0.0, "to": 1.0}),
        "/along/from",
    )
    .await;
    refused(
        &|request| {
            request["along"] = json!({"parameter": "damping", "from": 0.5, "to": 1.0});
            request["scene"]["damping"] = Value::Null;
        },
        "/along/parameter",
    )
    .await;
    refused(
        &|request| {
            request["model"] = json!(deformed);
            request["scene"]["centrifugal_stiffening"] = json!(true);
            request["along"]["to"] = json!(5_000.0);
        },
        "/along/to",
    )
    .await;
    for (parameter, lacks) in [
        ("damping", json!({"damping": {"modal_ratio": 0.0}})),
        ("clearance", json!({"contact": null})),
        ("lobe_amplitude", json!({"contact": null})),
    ] {
        let change = |request: &mut Value| {
            request["along"] = json!({"parameter": parameter, "from": 0.5, "to": 2.0});
            for (effect, value) in lacks.as_object().unwrap() {
                request["scene"][effect] = value.clone();
            }
        };
        refused(&change, "/along/parameter").await;
    }
    refused(
        &|request| request["along"] = json!({"parameter": "damping", "from": 0.5, "to": 200.0}),
        "/along/to",
    )
    .await;
    let abradable = json!({"modulus": 1000.0, "yield_stress": 10.0, "hardening": 10.0, "thickness": 1.0});
    refused(&|request| request["scene"]["abradable"] = abradable.clone(), "/scene/abradable").await;
    let disc = json!({"coefficient": 0.1, "law": "disc"});
    refused(&|request| request["scene"]["friction"] = disc.clone(), "/scene/friction/law").await;
    refused(
        &|request| request["scene"]["orbit"] = json!({"radius": 0.01, "whirl_ratio": 0.123_456}),
        "/scene/orbit/whirl_ratio",
    )
    .await;
    refused(&|request| request["integration"]["steady"] = json!("auto"), "/integration/steady").await;
    refused(&|request| request["most_points"] = json!(0), "/most_points").await;
    refused(&|request| request["speed"]["value"] = json!(-3.0), "/speed/value").await;
}

/// Branches are the same in all forms, also of a job that was dismissed, and are nothing of another kind of job.
#[tokio::test]
async fn branches_are_told_in_all_forms_and_of_other_jobs_not_at_all() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let mut request = branches_of(&model);
    request["most_points"] = json!(3);
    let answer = api.post("/v1/branches", &request).await;
    let id = answer.text("/id");
    let job = api.finish(&id).await;
    assert_eq!((&job["status"], &job["kind"]), (&json!("successful"), &json!("branches")), "{job}");
    let path = format!("/v1/jobs/{id}/branches");
    assert!(job["links"].as_array().unwrap().iter().any(|link| link["href"] == path.as_str()), "{job}");
    let csv = get(api, &format!("{path}?format=csv"), &[]).await.good();
    let found = api.get(&path).await.body;
    assert_eq!(csv.text().lines().count(), 1 + values(&found["branches"][0]).len(), "{}", csv.text());
    assert!(csv.text().starts_with("branch,value_rpm,speed_rpm,"), "{}", csv.text());
    for form in ["svg", "plotly", "npz", "png"] {
        get(api, &format!("{path}?format={form}"), &[]).await.good();
    }
    assert_eq!(api.get(&format!("{path}?sensor=99")).await.status, 400);
    assert_eq!(api.get(&format!("{path}?sweep={id}")).await.status, 409);
    assert_eq!(api.get(&format!("/v1/jobs/{id}/interaction-map")).await.status, 409);
    let other = api.model(model::package(2.0)).await;
    let of_other = api.sweep(&sweep_of(&other)).await;
    assert_eq!(api.get(&format!("{path}?format=svg&sweep={of_other}")).await.status, 400);
    let branch = &found["branches"][0];
    assert!([0, 1].iter().all(|end| branch["ends"][end]["why"] == "most_points"), "{found}");
    assert_eq!(values(branch).len(), 3 + 1 + 3);
}

/// Branches that are killed between two legs go on to the same bits.
#[tokio::test]
async fn killed_branches_go_on_where_they_were() {
    let data = tempfile::tempdir().unwrap();
    let program = Program::serve(data.path());
    let model = program.api.model(model::package(1.0)).await;
    let mut request = branches_of(&model);
    request["most_points"] = json!(12);
    let answer = program.api.post("/v1/branches", &request).await;
    let id = answer.text("/id");
    let path = format!("/v1/jobs/{id}/branches");
    program.api.follow(&id, |job| job["stored_bytes"].as_u64() > Some(0)).await;
    let before = program.api.get(&path).await;
    assert_eq!(before.status, 200, "{}", before.body);
    assert_eq!(before.body["complete"], false);
    program.kill();

    let program = Program::serve(data.path());
    let job = program.api.finish(&id).await;
    assert_eq!(job["status"], "successful", "{job}");
    let resumed = program.api.get(&path).await.body;
    program.kill();
    let app = TestApp::start().await;
    let again = app.api.model(model::package(1.0)).await;
    assert_eq!(again, model);
    assert_eq!(followed(&app.api, &request).await, resumed);
}
