//! Sweeps up and down: one speed after the other.

use serde_json::{Value, json};

use super::app::{Api, TestApp, long_sweep_of, sweep_of};
use super::model;

/// Speeds in rad/s, out of order.
const SPEEDS: [f64; 6] = [500.0, 300.0, 900.0, 700.0, 400.0, 600.0];

/// Indices of the speeds from the fastest to the slowest.
const DOWN: [u64; 6] = [2, 3, 5, 0, 4, 1];

fn downwards(mut request: Value) -> Value {
    request["speeds"] = json!({"values": SPEEDS, "unit": "rad_s"});
    request["sweep"] = "down".into();
    request
}

/// Indices of the finished speeds, ascending.
pub(crate) async fn finished(api: &Api, id: &str) -> Vec<u64> {
    let map = api.get(&format!("/v1/jobs/{id}/interaction-map")).await.body;
    map["points"].as_array().unwrap().iter().map(|point| point["index"].as_u64().unwrap()).collect()
}

/// Indices of the first `count` of `order`, ascending.
pub(crate) fn first_of(order: &[u64], count: usize) -> Vec<u64> {
    let mut first = order[..count].to_vec();
    first.sort_unstable();
    first
}

#[tokio::test]
async fn speeds_follow_each_other_downwards() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let id = api.sweep(&downwards(long_sweep_of(&model, 6))).await;
    let mut seen = Vec::new();
    loop {
        let now = finished(api, &id).await;
        assert_eq!(now, first_of(&DOWN, now.len()), "out of order");
        if seen.last() != Some(&now.len()) {
            seen.push(now.len());
        }
        if now.len() == DOWN.len() {
            break;
        }
        let job = api.job(&id).await;
        // The job may have ended since.
        assert!(!["failed", "dismissed"].contains(&job.text("/status").as_str()), "{}", job.body);
    }
    assert!(seen.len() > 3, "too fast to be followed: {seen:?}");
    let job = api.finish(&id).await;
    assert_eq!((&job["status"], &job["speeds"]["finished"]), (&json!("successful"), &json!(6)), "{job}");
    let map = api.get(&format!("/v1/jobs/{id}/interaction-map")).await.body;
    assert_eq!(map["settings"]["sweep"], "down");
    assert_eq!(map["speeds_rad_s"], json!(SPEEDS), "shown in the order given");
    assert_eq!(map["plan"]["workers"], 1, "the other worker cannot help");
    assert!(map["points"][2].get("message").is_none(), "the first one starts from rest as it should");
    assert_eq!(api.get(&format!("/v1/jobs/{id}/critical-speeds")).await.status, 200);
    app.stop().await;
}

#[tokio::test]
async fn a_chain_is_the_same_to_the_bit_for_any_number_of_workers() {
    let mut all = Vec::new();
    for workers in [1, 2] {
        let app = TestApp::start_with(|config| config.workers = Some(workers)).await;
        let model = app.api.model(model::package(1.0)).await;
        let id = app.api.sweep(&downwards(sweep_of(&model))).await;
        // Another job computes meanwhile.
        let other = app.api.sweep(&sweep_of(&model)).await;
        assert_eq!(app.api.finish(&id).await["status"], "successful");
        assert_eq!(app.api.finish(&other).await["status"], "successful");
        let mut spectra = Vec::new();
        for speed in 0..SPEEDS.len() {
            let body = app.api.get(&format!("/v1/jobs/{id}/spectra/{speed}")).await.body;
            assert!(body["spectra"].is_object(), "{body}");
            spectra.push((body["spectra"].clone(), body["point"]["message"].clone()));
        }
        all.push(spectra);
        app.stop().await;
    }
    assert_eq!(all[0], all[1]);
}
