//! Hostile clients, and what they keep from others: requests that take long to plan, and readers that do not read.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use anyhow::Context;
use reqwest::Client;
use serde_json::{Value, json};

/// Polls of `/healthz` beside each kind of client.
const POLLS: usize = 200;

/// Time between two polls.
const BETWEEN: Duration = Duration::from_millis(25);

/// Requests of each kind: their path, what they ask for, and whether it can be planned.
fn requests(sweep: &Value) -> Vec<(&'static str, &'static str, Value)> {
    let scene = &sweep["scene"];
    let with = |fields: Value| {
        let mut body = json!({"model": sweep["model"], "scene": scene});
        for (field, value) in fields.as_object().into_iter().flatten() {
            body[field] = value.clone();
        }
        body
    };
    let speeds = json!({"from": 12_000, "to": 36_000, "count": 200, "unit": "rpm"});
    let parameter = json!({"name": "clearance", "at": ["/scene/casing/clearance/leading"], "change": "add", "from": 0.0, "to": 0.1});
    let campaign = |parameter: &Value| {
        with(json!({
            "speeds": {"values": [20_000.0], "unit": "rpm"}, "parameters": [parameter],
            "design": {"kind": "latin_hypercube", "size": 350},
        }))
    };
    let angles: Vec<f64> = (0..20_000).map(|k| k as f64 * std::f64::consts::TAU / 20_000.0).collect();
    let heights: Vec<f64> = angles.iter().map(|angle| 0.1 * (2.0 * angle).cos()).collect();
    let table = json!({"angles_rad": angles, "chord": [0.0, 1.0], "heights": [&heights, &heights]});
    let mut measured = campaign(&parameter);
    measured["scene"]["casing"]["measured"] = table.clone();
    let mut moving = measured.clone();
    moving["parameters"][0]["at"] = json!(["/scene/casing/measured/heights/0/5"]);
    let run_ups = |tolerance: f64| {
        let rates: Vec<f64> = (0..100).map(|k| 1000.0 + 10.0 * f64::from(k)).collect();
        with(json!({
            "speed": {"unit": "rpm", "from": 22_400, "to": 26_000, "rates": rates},
            "angle_tolerance_rad": tolerance,
        }))
    };
    let mut sweep_of_table = with(json!({"speeds": speeds}));
    sweep_of_table["scene"]["casing"]["measured"] = table;
    vec![
        ("sweep", "sweeps/plan", with(json!({"speeds": speeds}))),
        ("sweep with a measured casing of 2 x 20,000 heights", "sweeps/plan", sweep_of_table),
        ("campaign of 350 designs", "campaigns/plan", campaign(&parameter)),
        ("campaign of 350 designs with that casing", "campaigns/plan", measured),
        ("campaign of 350 designs that change that casing", "campaigns/plan", moving),
        ("run-ups at 100 rates, 1e-3 rad", "run-ups/plan", run_ups(1e-3)),
        ("run-ups at 100 rates, 1.05e-8 rad", "run-ups/plan", run_ups(1.05e-8)),
        ("modal analysis", "modal-analyses/plan", json!({"model": sweep["model"], "speeds": speeds})),
        (
            "branches",
            "branches/plan",
            with(
                json!({"speed": {"value": 20_000, "unit": "rpm"}, "along": {"parameter": "speed", "from": 18_000, "to": 22_000}}),
            ),
        ),
        ("generation of an impeller", "models/plan", json!({"preset": "paper"})),
    ]
}

/// Prints one row for each kind of request: its bytes, its answer, and after which time that comes while nothing else is asked; then the
/// longest poll beside two clients that repeat it, and the longest plan of a sweep of somebody else.
pub(super) async fn planning(client: &Client, base: &str, sweep: &Value) -> anyhow::Result<()> {
    for (kind, path, body) in requests(sweep) {
        let text = Arc::new(serde_json::to_vec(&body)?);
        let url = format!("{base}/v1/{path}");
        let send = |text: Arc<Vec<u8>>, client: Client, url: String| async move {
            let sent = client.post(url).header("content-type", "application/json").body(text.to_vec()).send();
            let answer = sent.await?;
            let status = answer.status();
            answer.bytes().await?;
            Ok::<_, reqwest::Error>(status)
        };
        let begin = Instant::now();
        let status = send(Arc::clone(&text), client.clone(), url.clone()).await?;
        let spent = begin.elapsed();
        let stop = Arc::new(AtomicBool::new(false));
        let hostile: Vec<_> = (0..2)
            .map(|_| {
                let (text, client, url, stop) =
                    (Arc::clone(&text), client.clone(), url.clone(), Arc::clone(&stop));
                tokio::spawn(async move {
                    while !stop.load(Ordering::Relaxed) {
                        if send(Arc::clone(&text), client.clone(), url.clone()).await.is_err() {
                            break;
                        }
                    }
                })
            })
            .collect();
        let plan = async {
            let begin = Instant::now();
            client.post(format!("{base}/v1/sweeps/plan")).json(sweep).send().await?.bytes().await?;
            Ok::<_, anyhow::Error>(begin.elapsed())
        };
        let (longest, plan) = tokio::join!(longest_poll(client, base), plan);
        stop.store(true, Ordering::Relaxed);
        for task in hostile {
            task.await?;
        }
        println!(
            "{kind}: {} bytes, answered {}, in {:.0} ms; beside two such clients the longest of {POLLS} polls of /healthz {:.1} ms, a \
             plan {:.0} ms",
            text.len(),
            status.as_u16(),
            spent.as_secs_f64() * 1e3,
            longest?.as_secs_f64() * 1e3,
            plan?.as_secs_f64() * 1e3,
        );
    }
    Ok(())
}

/// Prints how long a reader waits for the mesh of the model while eight others ask for it and read nothing.
pub(super) async fn slow_readers(client: &Client, base: &str, model: &str) -> anyhow::Result<()> {
    let url = format!("{base}/v1/models/{model}/mesh");
    let whole = |client: Client| {
        let url = url.clone();
        async move {
            let begin = Instant::now();
            let bytes = client.get(url).send().await?.error_for_status()?.bytes().await?.len();
            Ok::<_, anyhow::Error>((begin.elapsed(), bytes))
        }
    };
    let (alone, bytes) = whole(client.clone()).await?;
    let mut unread = Vec::new();
    for _ in 0..8 {
        unread.push(client.get(&url).send().await?.error_for_status()?);
    }
    let (beside, longest) = tokio::join!(whole(client.clone()), longest_poll(client, base));
    println!(
        "a mesh of {bytes} bytes: {:.2} s alone, {:.2} s beside {} readers that do not read; longest poll of /healthz {:.1} ms",
        alone.as_secs_f64(),
        beside.context("the mesh")?.0.as_secs_f64(),
        unread.len(),
        longest?.as_secs_f64() * 1e3
    );
    Ok(())
}

async fn longest_poll(client: &Client, base: &str) -> anyhow::Result<Duration> {
    let mut longest = Duration::ZERO;
    for _ in 0..POLLS {
        let begin = Instant::now();
        client.get(format!("{base}/healthz")).send().await?.error_for_status()?.bytes().await?;
        longest = longest.max(begin.elapsed());
        tokio::time::sleep(BETWEEN).await;
    }
    Ok(longest)
}
