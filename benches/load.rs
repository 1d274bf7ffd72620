//! Load on the service: latencies of clients, and times of sweeps beside them: `cargo bench --bench load [-- CLIENTS SECONDS]`. Clients
//! poll jobs, list them and ask for plans, 200 requests a second together, beside two sweeps on two workers; the same sweeps alone
//! before it, in the same run, and beside open pages that watch one of them. Then a listing of 10,000 jobs in pages. Run it on an
//! otherwise idle machine. `cargo bench --bench load -- abuse`: only what one client can keep from others.

#[path = "service/abuse.rs"]
mod abuse;

use std::sync::Arc;
use std::time::{Duration, Instant};

use anyhow::{Context, bail};
use futures::StreamExt;
use reqwest::Client;
use rubmap::app::App;
use rubmap::config::Config;
use rubmap::impeller::{ImpellerParameters, PaperCasing, generate};
use serde_json::{Value, json};
use tokio_util::sync::CancellationToken;

/// Requests a second, all clients together.
const RATE: f64 = 200.0;

/// Pages that watch a sweep.
const PAGES: usize = 20;

/// Time after which a page asks again for the map that grows, at least, as `web/` has it.
const MAP_PAUSE: Duration = Duration::from_secs(5);

/// Number of jobs that are listed.
const LISTED: usize = 10_000;

fn main() -> anyhow::Result<()> {
    let given: Vec<usize> = std::env::args().skip(1).filter_map(|argument| argument.parse().ok()).collect();
    let (clients, seconds) = (given.first().copied().unwrap_or(200), given.get(1).copied().unwrap_or(30));
    tokio::runtime::Builder::new_multi_thread()
        .enable_all()
        .build()?
        .block_on(measure(clients, seconds as u64))
}

async fn measure(clients: usize, seconds: u64) -> anyhow::Result<()> {
    let folder = tempfile::tempdir()?;
    let config = Config { workers: Some(2), ..Config::local(folder.path()) };
    let app = App::build(config).await?;
    let (base, stop) = (format!("http://{}", app.addr()), CancellationToken::new());
    let service = tokio::spawn(app.run_until_stopped(stop.clone()));
    let client = Client::new();
    let mut package = std::io::Cursor::new(Vec::new());
    rubmap::package::write(&generate(&ImpellerParameters::default())?, &mut package)?;
    let upload = client.post(format!("{base}/v1/models")).header("content-type", "application/zip");
    let model: Value = upload.body(package.into_inner()).send().await?.json().await?;
    let model = model["id"].as_str().context("no model")?.to_owned();

    // These sweeps make the reduction and warm the machine.
    sweeps(&client, &base, &model, 2).await?;
    if std::env::args().any(|argument| argument == "abuse") {
        abuse::planning(&client, &base, &sweep(&model, 2)).await?;
        abuse::slow_readers(&client, &base, &model).await?;
        stop.cancel();
        return Ok(service.await?);
    }
    let alone = sweeps(&client, &base, &model, 24).await?;
    let running = tokio::spawn({
        let (client, base, model) = (client.clone(), base.clone(), model.clone());
        async move { sweeps(&client, &base, &model, 24).await }
    });
    let load = load(&client, &base, &model, clients, Duration::from_secs(seconds));
    let (mut latencies, errors) = load.await?;
    let beside = running.await??;
    latencies.sort_unstable();
    let at = |share: f64| latencies[((latencies.len() - 1) as f64 * share) as usize].as_secs_f64() * 1e3;
    println!(
        "{clients} clients, {} requests, {errors} errors; p50 {:.1} ms, p99 {:.1} ms, longest {:.1} ms",
        latencies.len(),
        at(0.5),
        at(0.99),
        at(1.0)
    );
    println!(
        "two sweeps of 24 speeds: alone {:.1} s, beside the load {:.1} s, ratio {:.3}",
        alone.as_secs_f64(),
        beside.as_secs_f64(),
        beside.as_secs_f64() / alone.as_secs_f64()
    );
    let watched = watched(&client, &base, &model).await?;
    println!(
        "beside {PAGES} open pages {:.1} s, ratio {:.3}",
        watched.as_secs_f64(),
        watched.as_secs_f64() / alone.as_secs_f64()
    );
    list(&client, &base, &model).await?;
    stop.cancel();
    service.await?;
    Ok(())
}

/// Runs two sweeps side by side; time from the first post to the end of both.
async fn sweeps(client: &Client, base: &str, model: &str, speeds: u32) -> anyhow::Result<Duration> {
    let begin = Instant::now();
    let ids =
        [post(client, base, &sweep(model, speeds)).await?, post(client, base, &sweep(model, speeds)).await?];
    for id in ids {
        loop {
            let job: Value = client.get(format!("{base}/v1/jobs/{id}")).send().await?.json().await?;
            match job["status"].as_str() {
                Some("accepted" | "running") => tokio::time::sleep(Duration::from_millis(100)).await,
                Some("successful") => break,
                _ => bail!("{job}"),
            }
        }
    }
    Ok(begin.elapsed())
}

fn sweep(model: &str, speeds: u32) -> Value {
    let PaperCasing { leading_clearance, trailing_clearance, restriction } =
        PaperCasing::of(&ImpellerParameters::default());
    json!({
        "model": model,
        "speeds": {"from": 12_000, "to": 36_000, "count": speeds, "unit": "rpm"},
        "scene": {
            "centrifugal_stiffening": true,
            "damping": {"modal_ratio": 0.005},
            "casing": {
                "clearance": {"leading": leading_clearance, "trailing": trailing_clearance},
                "lobes": {"count": 2, "amplitude": restriction, "width_rad": 0.35},
            },
            "contact": {},
        },
        "integration": {"revolutions": 50},
    })
}

async fn post(client: &Client, base: &str, request: &Value) -> anyhow::Result<String> {
    let answer: Value = client.post(format!("{base}/v1/sweeps")).json(request).send().await?.json().await?;
    Ok(answer["id"].as_str().with_context(|| answer.to_string())?.to_owned())
}

/// Sends requests; returns the latencies of polls and how many requests failed.
async fn load(
    client: &Client,
    base: &str,
    model: &str,
    clients: usize,
    time: Duration,
) -> anyhow::Result<(Vec<Duration>, usize)> {
    let request = Arc::new(sweep(model, 2));
    let listed: Value = client.get(format!("{base}/v1/jobs?limit=1")).send().await?.json().await?;
    let id = Arc::new(listed["jobs"][0]["id"].as_str().context("no job")?.to_owned());
    let pause = Duration::from_secs_f64(clients as f64 / RATE);
    let tasks: Vec<_> = (0..clients)
        .map(|index| {
            let (client, base, id, request) =
                (client.clone(), base.to_owned(), Arc::clone(&id), Arc::clone(&request));
            tokio::spawn(async move {
                let (mut latencies, mut errors) = (Vec::new(), 0);
                tokio::time::sleep(pause.mul_f64(index as f64 / clients as f64)).await;
                let begin = Instant::now();
                let mut beat = tokio::time::interval(pause);
                while begin.elapsed() < time {
                    beat.tick().await;
                    let asked = Instant::now();
                    // One in fifty asks for a plan, one in ten lists; the others poll.
                    let turn = latencies.len() + index;
                    let sent = if turn.is_multiple_of(50) {
                        client.post(format!("{base}/v1/sweeps/plan")).json(&*request).send().await
                    } else if turn.is_multiple_of(10) {
                        client.get(format!("{base}/v1/jobs?limit=20")).send().await
                    } else {
                        client.get(format!("{base}/v1/jobs/{id}")).send().await
                    };
                    let whole = match sent.and_then(reqwest::Response::error_for_status) {
                        Ok(answer) => answer.bytes().await.is_ok(),
                        Err(_) => false,
                    };
                    errors += usize::from(!whole);
                    latencies.push(asked.elapsed());
                }
                (latencies, errors)
            })
        })
        .collect();
    let (mut latencies, mut errors) = (Vec::new(), 0);
    for task in tasks {
        let (some, failed) = task.await?;
        latencies.extend(some);
        errors += failed;
    }
    Ok((latencies, errors))
}

/// Runs two sweeps, of which pages watch the one that was posted last.
async fn watched(client: &Client, base: &str, model: &str) -> anyhow::Result<Duration> {
    let running = tokio::spawn({
        let (client, base, model) = (client.clone(), base.to_owned(), model.to_owned());
        async move { sweeps(&client, &base, &model, 24).await }
    });
    let id = loop {
        let listed: Value =
            client.get(format!("{base}/v1/jobs?status=running&limit=1")).send().await?.json().await?;
        match listed["jobs"][0]["id"].as_str() {
            Some(id) => break id.to_owned(),
            None => tokio::time::sleep(Duration::from_millis(10)).await,
        }
    };
    let pages: Vec<_> =
        (0..PAGES).map(|_| tokio::spawn(page(client.clone(), format!("{base}/v1/jobs/{id}")))).collect();
    for page in pages {
        page.await??;
    }
    running.await?
}

/// Sends the requests of a page while it shows a job: its events, and the map after them, until the job has ended.
async fn page(client: Client, job: String) -> anyhow::Result<()> {
    let mut events = client.get(format!("{job}/events")).send().await?.error_for_status()?.bytes_stream();
    let mut shown: Option<Instant> = None;
    while let Some(piece) = events.next().await {
        piece?;
        if shown.is_none_or(|at| at.elapsed() > MAP_PAUSE) {
            let map = client.get(format!("{job}/interaction-map?format=plotly")).send().await?;
            map.error_for_status()?.bytes().await?;
            shown = Some(Instant::now());
        }
    }
    Ok(())
}

/// Posts ten thousand jobs, cancelled as they come, and lists all their pages.
async fn list(client: &Client, base: &str, model: &str) -> anyhow::Result<()> {
    let request = sweep(model, 2);
    for _ in 0..LISTED {
        let id = post(client, base, &request).await?;
        client.delete(format!("{base}/v1/jobs/{id}")).send().await?.error_for_status()?;
    }
    let (mut path, mut slowest, mut pages, mut jobs) = ("/v1/jobs".to_owned(), Duration::ZERO, 0, 0);
    loop {
        let begin = Instant::now();
        let page: Value = client.get(format!("{base}{path}")).send().await?.json().await?;
        slowest = slowest.max(begin.elapsed());
        pages += 1;
        jobs += page["jobs"].as_array().map_or(0, Vec::len);
        match page["next"].as_str() {
            Some(next) => path = next.to_owned(),
            None => break,
        }
    }
    println!("{jobs} jobs in {pages} pages, the slowest {:.1} ms", slowest.as_secs_f64() * 1e3);
    Ok(())
}
