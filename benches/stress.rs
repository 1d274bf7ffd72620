//! What stress costs a sweep: `cargo bench --bench stress [-- PRESET …]`: three speeds in contact with and without it, in turn, through the
//! service on two workers; measured beside planned. Run it on an otherwise idle machine.

use std::time::Duration;

use anyhow::{Context, bail};
use reqwest::Client;
use rubmap::app::App;
use rubmap::config::Config;
use rubmap::impeller::{Preset, generate};
use serde_json::{Value, json};
use tokio_util::sync::CancellationToken;

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

/// One wheel in a service of its own.
async fn compare(name: &str, preset: Preset) -> anyhow::Result<()> {
    let folder = tempfile::tempdir()?;
    let config = Config { workers: Some(2), upload_bytes: 1 << 30, ..Config::local(folder.path()) };
    let app = App::build(config).await?;
    let (base, stop) = (format!("http://{}", app.addr()), CancellationToken::new());
    let service = tokio::spawn(app.run_until_stopped(stop.clone()));
    let mut package = std::io::Cursor::new(Vec::new());
    rubmap::package::write(&generate(&preset.parameters())?, &mut package)?;
    let api = Api { client: Client::new(), base };
    let model =
        api.send("models", |post| post.header("content-type", "application/zip").body(package.into_inner()));
    let model = model.await?["id"].clone();
    let (mut without, mut with) = (f64::INFINITY, f64::INFINITY);
    for _ in 0..ROUNDS {
        without = without.min(api.seconds(&sweep(&model, false)).await?);
        with = with.min(api.seconds(&sweep(&model, true)).await?);
    }
    let planned = api.planned(&sweep(&model, true)).await? / api.planned(&sweep(&model, false)).await?;
    println!("{name:>8}  {without:>9.3}  {with:>9.3}  {:>6.3}  {planned:>7.3}", with / without);
    stop.cancel();
    service.await?;
    Ok(())
}

struct Api {
    client: Client,
    base: String,
}

impl Api {
    async fn send(
        &self,
        path: &str,
        fill: impl FnOnce(reqwest::RequestBuilder) -> reqwest::RequestBuilder,
    ) -> anyhow::Result<Value> {
        Ok(fill(self.client.post(format!("{}/v1/{path}", self.base))).send().await?.json().await?)
    }

    /// Mean computing time of a speed.
    async fn seconds(&self, request: &Value) -> anyhow::Result<f64> {
        let posted = self.send("sweeps", |post| post.json(request)).await?;
        let path = format!("{}/v1/jobs/{}", self.base, posted["id"].as_str().context(posted.to_string())?);
        loop {
            let job: Value = self.client.get(&path).send().await?.json().await?;
            match job["status"].as_str() {
                Some("accepted" | "running") => tokio::time::sleep(Duration::from_millis(50)).await,
                Some("successful") => break,
                _ => bail!("{job}"),
            }
        }
        let map: Value = self.client.get(format!("{path}/interaction-map")).send().await?.json().await?;
        let points = map["points"].as_array().context("no points")?;
        let seconds = points.iter().filter_map(|point| point["wall_time_s"].as_f64());
        Ok(seconds.sum::<f64>() / points.len() as f64)
    }

    /// The same as planned, in contact all the time.
    async fn planned(&self, request: &Value) -> anyhow::Result<f64> {
        let plan = self.send("sweeps/plan", |post| post.json(request)).await?;
        plan["estimate"]["computing_time_s"]["contact"].as_f64().with_context(|| plan.to_string())
    }
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
