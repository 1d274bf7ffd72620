//! Time of jobs beside their computation: `cargo bench --bench jobs`, on an otherwise idle machine. From the start of a service to the
//! first row of a map, for the demo's impeller and for `medium`; and the time of a speed that is not computing, or that does not grow
//! with its revolutions, on one worker.

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
/// Speeds and revolutions: the first two sweeps differ in speeds, the last two in revolutions.
const SWEEPS: [(u32, u32); 3] = [(96, 25), (24, 25), (24, 100)];

fn main() -> anyhow::Result<()> {
    tokio::runtime::Builder::new_multi_thread().enable_all().build()?.block_on(async {
        first_rows().await?;
        beside_computing().await
    })
}

/// Measures the time until the first row of a map.
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
            let job = service.get(&path).await?;
            if !matches!(job["status"].as_str(), Some("accepted" | "running" | "successful")) {
                bail!("{job}");
            }
            tokio::time::sleep(Duration::from_millis(5)).await;
        };
        let waited = begin.elapsed().as_secs_f64();
        println!("| {name} | {uploaded:.2} | {waited:.2} | {:.2} |", computing(&point)?);
        service.stop().await?;
    }
    Ok(())
}

/// Measures the time of a sweep on one worker beyond its speeds, and of a speed beyond its revolutions.
async fn beside_computing() -> anyhow::Result<()> {
    let service = Service::start(1, &Preset::Small.parameters()).await?;
    let sweep = |speeds: u32, revolutions: u32| demo_sweep(&service.model, speeds, &revolutions.into());
    // This sweep makes the reduction and warms the machine.
    service.done("sweeps", &sweep(SWEEPS[1].0, SWEEPS[1].1)).await?;
    println!("\nThe demo's sweep, one worker, its reduction stored; sums over all speeds.\n");
    println!("| speeds | revolutions | sweep, s | computing its speeds, s | beyond, ms | share |");
    println!("|---|---|---|---|---|---|");
    let mut found = Vec::new();
    for (speeds, revolutions) in SWEEPS {
        let begin = Instant::now();
        let path = service.done("sweeps", &sweep(speeds, revolutions)).await?;
        let whole = begin.elapsed().as_secs_f64();
        let points = service.points(&path).await?;
        let computed = points.iter().map(computing).sum::<anyhow::Result<f64>>()?;
        let beyond = whole - computed;
        println!(
            "| {speeds} | {revolutions} | {whole:.2} | {computed:.2} | {:.0} | {:.2} % |",
            1e3 * beyond,
            100.0 * beyond / whole
        );
        found.push((1e3 * computed / f64::from(speeds), 1e3 * beyond));
    }
    let [(_, of_many), (short, of_few), (long, _)] = found[..] else { bail!("three sweeps") };
    let [(many, few), (least, most)] =
        [(SWEEPS[0].0, SWEEPS[1].0), (SWEEPS[1].1, SWEEPS[2].1)].map(|(a, b)| (f64::from(a), f64::from(b)));
    let speed = (of_many - of_few) / (many - few);
    let revolution = (long - short) / (most - least);
    println!(
        "\nBeyond computing: {:.0} ms a sweep, {speed:.2} ms a speed. A revolution takes {revolution:.2} ms, and what is computed once a \
         speed (modes, tables, spectra, audit) {:.1} ms.",
        of_few - few * speed,
        short - least * revolution
    );
    service.stop().await
}

fn computing(point: &Value) -> anyhow::Result<f64> {
    point["wall_time_s"].as_f64().with_context(|| point.to_string())
}
