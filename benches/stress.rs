//! Cost of stress in a sweep: `cargo bench --bench stress [-- PRESET …]`: three speeds in contact with and without it, in turn, through the
//! service on two workers; measured beside planned. Run it on an otherwise idle machine.

mod service;

use anyhow::Context;
use rubmap::impeller::Preset;
use serde_json::{Value, json};

use service::Service;

const ROUNDS: usize = 3;

fn main() -> anyhow::Result<()> {
    let asked: Vec<String> = std::env::args().skip(1).filter(|argument| !argument.starts_with('-')).collect();
    let runtime = tokio::runtime::Builder::new_multi_thread().enable_all().build()?;
    println!("{:>8}  {:>9}  {:>9}  {:>6}  {:>7}", "preset", "without s", "with s", "ratio", "planned");
    for (name, preset) in [("small", Preset::Small), ("medium", Preset::Medium), ("paper", Preset::Paper)] {
        if asked.iter().any(|asked| asked == name) || asked.is_empty() && name != "paper" {
            runtime.block_on(compare(name, preset))?;
        }
    }
    Ok(())
}

/// Compares sweeps of one wheel with and without stress, in a service of its own.
async fn compare(name: &str, preset: Preset) -> anyhow::Result<()> {
    let service = Service::start(2, &preset.parameters()).await?;
    let model = service.model.clone();
    let (mut without, mut with) = (f64::INFINITY, f64::INFINITY);
    for _ in 0..ROUNDS {
        without = without.min(seconds(&service, &sweep(&model, false)).await?);
        with = with.min(seconds(&service, &sweep(&model, true)).await?);
    }
    let planned =
        planned(&service, &sweep(&model, true)).await? / planned(&service, &sweep(&model, false)).await?;
    println!("{name:>8}  {without:>9.3}  {with:>9.3}  {:>6.3}  {planned:>7.3}", with / without);
    service.stop().await
}

/// Mean computing time of a speed, s.
async fn seconds(service: &Service, request: &Value) -> anyhow::Result<f64> {
    let points = service.points(&service.done("sweeps", request).await?).await?;
    let seconds = points.iter().filter_map(|point| point["wall_time_s"].as_f64());
    Ok(seconds.sum::<f64>() / points.len() as f64)
}

/// Planned computing time of a speed in contact all the time, s.
async fn planned(service: &Service, request: &Value) -> anyhow::Result<f64> {
    let plan = service.post("sweeps/plan", request).await?;
    plan["estimate"]["computing_time_s"]["contact"].as_f64().with_context(|| plan.to_string())
}

fn sweep(model: &Value, stress: bool) -> Value {
    let mut request = json!({
        "model": model,
        "speeds": {"from": 1200, "to": 1500, "count": 3, "unit": "rad_s"},
        "modes_per_speed": 20,
        "scene": {
            "centrifugal_stiffening": true,
            "damping": {"modal_ratio": 0.02},
            "casing": {
                "clearance": {"leading": 0.3, "trailing": 0.25},
                "lobes": {"count": 2, "amplitude": 0.4, "width_rad": 0.35},
            },
            "contact": {},
        },
        "integration": {"revolutions": 50, "window_revolutions": 20, "ramp_revolutions": 5.0},
        "max_engine_order": 30,
    });
    if stress {
        request["record"] = json!({"stress": {}});
    }
    request
}
