//! What jobs take beside their computation: `cargo bench --bench jobs`, on an otherwise idle machine. From the start of a service to the
//! first row of a map, for the demo's impeller and for `medium`; and what a speed takes that is not computed, or that does not grow with
//! its revolutions, on one worker.

#[path = "service/demo.rs"]
mod demo;
mod service;

use std::time::{Duration, Instant};

use anyhow::{Context, bail};
use rubmap::impeller::Preset;
use serde_json::Value;

use demo::demo_sweep;
use service::Service;

/// Workers of the first table: those of a service on two cores.
const WORKERS: u16 = 2;
const SPEEDS: u32 = 24;
const REVOLUTIONS: [u32; 3] = [25, 50, 100];

fn main() -> anyhow::Result<()> {
    tokio::runtime::Builder::new_multi_thread().enable_all().build()?.block_on(async {
        first_rows().await?;
        beside_computing().await
    })
}

/// How long one waits for something to look at.
async fn first_rows() -> anyhow::Result<()> {
    println!("Waiting, {WORKERS} workers; each from the end of what stands before it.\n");
    println!(
        "| impeller | service and upload, s | first row of the map, s | of it computing that speed, s |"
    );
    println!("|---|---|---|---|");
    for (name, preset) in [("`demo`", Preset::Small), ("`medium`", Preset::Medium)] {
        let begin = Instant::now();
        let service = Service::start(WORKERS, &preset.parameters()).await?;
        let uploaded = begin.elapsed().as_secs_f64();
        let begin = Instant::now();
        let posted = service.post("sweeps", &demo_sweep(&service.model, SPEEDS, &50.into())).await?;
        let path = format!("jobs/{}", posted["id"].as_str().with_context(|| posted.to_string())?);
        let point = loop {
            let map = service.get(&format!("{path}/interaction-map")).await?;
            if let Some(point) = map["points"].as_array().and_then(|points| points.first()) {
                break point.clone();
            }
            tokio::time::sleep(Duration::from_millis(5)).await;
        };
        let waited = begin.elapsed().as_secs_f64();
        println!("| {name} | {uploaded:.2} | {waited:.2} | {:.2} |", computing(&point)?);
        service.stop().await?;
    }
    Ok(())
}

/// What a speed takes on one worker, by what of it grows with the revolutions and what is computed.
async fn beside_computing() -> anyhow::Result<()> {
    let service = Service::start(1, &Preset::Small.parameters()).await?;
    let sweep = |revolutions: u32| demo_sweep(&service.model, SPEEDS, &revolutions.into());
    // The reduction is made, and the machine warm.
    service.points(&sweep(REVOLUTIONS[0])).await?;
    println!("\nThe demo's sweep, {SPEEDS} speeds, one worker, its reduction stored.\n");
    println!("| revolutions | a speed, ms | of it computing, ms | beyond, ms | share |");
    println!("|---|---|---|---|---|");
    let mut lines = Vec::new();
    for revolutions in REVOLUTIONS {
        let begin = Instant::now();
        let points = service.points(&sweep(revolutions)).await?;
        let speed = 1e3 * begin.elapsed().as_secs_f64() / f64::from(SPEEDS);
        let computed: f64 = points.iter().map(computing).sum::<anyhow::Result<f64>>()?;
        let computed = 1e3 * computed / f64::from(SPEEDS);
        let beyond = speed - computed;
        println!(
            "| {revolutions} | {speed:.1} | {computed:.1} | {beyond:.1} | {:.2} % |",
            100.0 * beyond / speed
        );
        lines.push((f64::from(revolutions), computed));
    }
    let [(few, least), .., (many, most)] = lines[..] else { bail!("two numbers of revolutions at least") };
    let each = (most - least) / (many - few);
    println!(
        "\nA revolution takes {each:.2} ms; what is computed once a speed (modes, tables, spectra, audit) {:.1} ms.",
        least - few * each
    );
    service.stop().await
}

fn computing(point: &Value) -> anyhow::Result<f64> {
    point["wall_time_s"].as_f64().with_context(|| point.to_string())
}
