//! Sweeps that add speeds around their peaks.

use serde_json::{Value, json};

use super::app::{Api, TestApp, sweep_of};
use super::kill::points;
use super::model;
use super::program::Program;

/// Number of speeds of the coarse sweep.
const COARSE: usize = 9;

/// Request for a sweep whose grid is too coarse for its peaks.
fn coarse_sweep_of(model: &str) -> Value {
    let mut request = sweep_of(model);
    request["speeds"]["count"] = COARSE.into();
    request["refine"] = true.into();
    request
}

async fn map(api: &Api, id: &str) -> Value {
    api.get(&format!("/v1/jobs/{id}/interaction-map")).await.body
}

async fn table(api: &Api, id: &str, sensor: usize) -> Value {
    let answer = api.get(&format!("/v1/jobs/{id}/critical-speeds?sensor={sensor}")).await;
    assert_eq!(answer.status, 200, "{}", answer.body);
    answer.body
}

/// Amplitudes and points of a map, without the times.
fn timeless(mut map: Value) -> (Value, Value) {
    for point in map["points"].as_array_mut().unwrap() {
        point["wall_time_s"] = Value::Null;
    }
    (map["amplitude"].take(), map["points"].take())
}

fn inside(speed: &&Value) -> bool {
    speed["at_edge"] == false
}

#[tokio::test]
async fn every_peak_inside_the_range_ends_up_resolved() {
    let mut maps = Vec::new();
    for workers in [1, 2] {
        let app = TestApp::start_with(|config| config.workers = Some(workers)).await;
        let api = &app.api;
        let model = api.model(model::package(1.0)).await;
        let mut request = coarse_sweep_of(&model);

        request["refine"] = false.into();
        let id = api.sweep(&request).await;
        api.finish(&id).await;
        let coarse = table(api, &id, 0).await;
        let coarse_speeds = coarse["critical_speeds"].as_array().unwrap();
        assert!(coarse_speeds.iter().filter(inside).any(|speed| speed["resolved"] == false), "{coarse}");
        assert!(coarse.get("refinement").is_none() && coarse["settings"]["refine"] == false);

        request["refine"] = true.into();
        let id = api.sweep(&request).await;
        let job = api.finish(&id).await;
        assert_eq!(job["status"], "successful", "{job}");
        let fine = map(api, &id).await;
        let speeds = fine["speeds_rad_s"].as_array().unwrap();
        assert_eq!(speeds[..COARSE], coarse_grid());
        let added = speeds.len() - COARSE;
        assert_eq!(job["speeds"]["total"], speeds.len());
        assert_eq!(job["speeds"]["finished"], speeds.len());
        assert!(added > 0);
        let lists = fine["settings"]["speeds"].as_array().unwrap();
        let refinement = &fine["refinement"];
        assert_eq!((&refinement["added"], &refinement["rounds"]), (&json!(added), &json!(lists.len() - 1)));
        let mut unresolved = Vec::new();
        for sensor in 0..2 {
            let table = table(api, &id, sensor).await;
            assert_eq!(&table["refinement"], refinement);
            let peaks = table["critical_speeds"].as_array().unwrap();
            assert!(!peaks.is_empty());
            for peak in peaks {
                assert_eq!(peak["resolved"], inside(&peak), "{peak}");
                let speed = peak["speed_rad_s"].as_f64().unwrap();
                if peak["resolved"] == false {
                    unresolved
                        .push(json!({"sensor": sensor, "speed_rad_s": speed, "reason": "end_of_range"}));
                }
                let error = peak["speed_error_rad_s"].as_f64().unwrap();
                assert_eq!(Some(speed), speeds[peak["index"].as_u64().unwrap() as usize].as_f64());
                // Nothing was computed closer to the peak than its error says, on one side at least.
                let computed = speeds.iter().map(|other| (other.as_f64().unwrap() - speed).abs());
                let closest = computed.filter(|distance| *distance > 0.0).fold(f64::INFINITY, f64::min);
                assert!(error >= closest && (error < 600.0 / 8.0 || peak["at_edge"] == true), "{peak}");
            }
        }
        // A refinement is complete if it leaves no peak unresolved, of the wheel or of a sensor.
        let left = refinement["unresolved"].as_array().cloned().unwrap_or_default();
        assert_eq!(refinement["complete"], left.is_empty());
        let (of_wheel, of_sensors): (Vec<_>, Vec<_>) =
            left.into_iter().partition(|peak| peak.get("sensor").is_none());
        assert_eq!(of_sensors, unresolved);
        assert!(of_wheel.iter().all(|peak| peak["reason"] == "end_of_range"), "{of_wheel:?}");

        // The same speeds are asked for by name.
        let mut explicit = request.clone();
        explicit["speeds"] = json!({"values": speeds, "unit": "rad_s"});
        explicit["refine"] = false.into();
        let by_name = api.sweep(&explicit).await;
        api.finish(&by_name).await;
        let by_name = timeless(map(api, &by_name).await);
        let fine = timeless(fine);
        assert_eq!(by_name, fine);
        maps.push(fine);
        app.stop().await;
    }
    assert_eq!(maps[0], maps[1], "the number of workers");
}

/// Peaks of responses that are solved for are maxima on their branch, also by marches beside it.
#[tokio::test]
async fn peaks_of_solved_responses_are_maxima_on_a_branch() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let mut request = coarse_sweep_of(&model);
    request["scene"]["damping"] = json!({"modal_ratio": 0.1});
    request["integration"]["steady"] = json!("periodic");
    let id = api.sweep(&request).await;
    assert_eq!(api.finish(&id).await["status"], "successful");
    let mut maxima = Vec::new();
    for sensor in 0..2 {
        let table = table(api, &id, sensor).await;
        let peaks = table["critical_speeds"].as_array().unwrap().clone();
        for peak in peaks.into_iter().filter(|peak| peak["on_branch"] == true) {
            let number = |field: &str| peak[field].as_f64().unwrap();
            assert!(number("speed_error_rad_s") <= 1e-5 * number("speed_rad_s"), "{peak}");
            assert_eq!(peak["resolved"], true);
            maxima.push((sensor, number("speed_rad_s"), number("rms")));
        }
    }
    let mut beside = request.clone();
    beside["refine"] = false.into();
    beside["integration"]["steady"] = json!("march");
    beside["integration"]["revolutions"] = json!(400);
    assert!(!maxima.is_empty(), "no peak is on a branch");
    for (sensor, speed, rms) in maxima {
        let values = [1.0 - 1e-3, 1.0, 1.0 + 1e-3].map(|share| share * speed);
        beside["speeds"] = json!({"values": values, "unit": "rad_s"});
        let id = api.sweep(&beside).await;
        api.finish(&id).await;
        let map = map(api, &id).await;
        let marched =
            [0, 1, 2].map(|index| map["points"][index]["responses"][sensor]["rms"].as_f64().unwrap());
        assert!((marched[1] / rms - 1.0).abs() < 1e-6, "{marched:?} {rms}");
        assert!(marched[0] < marched[1] && marched[2] < marched[1], "{marched:?} at {speed}");
    }
}

fn coarse_grid() -> Vec<Value> {
    (0..COARSE).map(|i| json!(300.0 + 600.0 * (i as f64 / (COARSE - 1) as f64))).collect()
}

#[tokio::test]
async fn a_killed_refinement_goes_on_where_it_was() {
    let data = tempfile::tempdir().unwrap();
    let program = Program::serve(data.path());
    let model = program.api.model(model::package(1.0)).await;
    let mut request = coarse_sweep_of(&model);
    request["integration"]["revolutions"] = 500.into();
    let id = program.api.sweep(&request).await;
    program.api.follow(&id, |job| job["speeds"]["total"].as_u64() > Some(COARSE as u64)).await;
    let before = points(&program.api, &id).await;
    program.kill();

    let program = Program::serve(data.path());
    let job = program.api.finish(&id).await;
    assert_eq!(job["status"], "successful", "{job}");
    let after = points(&program.api, &id).await;
    assert!((COARSE..after.len()).contains(&before.len()), "killed with {} of {}", before.len(), after.len());
    for (index, point) in &before {
        assert_eq!(&after[index], point, "speed {index} was computed again");
    }
    let resumed = map(&program.api, &id).await;
    program.kill();

    let undisturbed = tempfile::tempdir().unwrap();
    let program = Program::serve(undisturbed.path());
    assert_eq!(program.api.model(model::package(1.0)).await, model);
    let id = program.api.sweep(&request).await;
    program.api.finish(&id).await;
    let undisturbed = map(&program.api, &id).await;
    assert_eq!(undisturbed["settings"], resumed["settings"]);
    assert_eq!(undisturbed["refinement"], resumed["refinement"]);
    assert_eq!(timeless(undisturbed), timeless(resumed));
}

#[tokio::test]
async fn a_sweep_up_or_down_is_not_refined() {
    let app = TestApp::start().await;
    let model = app.api.model(model::package(1.0)).await;
    let mut request = coarse_sweep_of(&model);
    request["sweep"] = "up".into();
    assert_eq!(app.api.post("/v1/sweeps", &request).await.pointers(422, "invalid-request"), ["/refine"]);
    app.stop().await;
}
