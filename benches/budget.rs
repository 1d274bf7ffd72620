//! Budgets and targets beside what sweeps take: `cargo bench --bench budget [-- NUMBER …]`: sweeps of the demo's impeller with a
//! budget each, or a target where the number is below 1, through the service on two workers and an empty data folder. `planned` is the
//! time passed when the setting was chosen with the time planned for the rest, beside the wall time really taken. Run it on an
//! otherwise idle machine.

use std::time::{Duration, Instant};

use anyhow::{Context, bail};
use reqwest::Client;
use rubmap::app::App;
use rubmap::config::Config;
use rubmap::impeller::{ImpellerParameters, PaperCasing, generate};
use serde_json::{Value, json};
use tokio_util::sync::CancellationToken;

fn main() -> anyhow::Result<()> {
    let given: Vec<f64> = std::env::args().skip(1).filter_map(|argument| argument.parse().ok()).collect();
    let asked = if given.is_empty() { vec![60.0, 120.0, 240.0, 0.05] } else { given };
    let runtime = tokio::runtime::Builder::new_multi_thread().enable_all().build()?;
    println!(
        "{:>8}  {:>9}  {:>9}  {:>8}  {:>36}  {:>9}  {:>9}",
        "asked",
        "chosen s",
        "planned s",
        "taken s",
        "modes, steps/revolution, scheme",
        "estimated",
        "afterwards"
    );
    for number in asked {
        runtime.block_on(keep(number))?;
    }
    Ok(())
}

/// Runs one sweep in a service of its own and prints its times.
async fn keep(number: f64) -> anyhow::Result<()> {
    let folder = tempfile::tempdir()?;
    let config = Config { workers: Some(2), ..Config::local(folder.path()) };
    let app = App::build(config).await?;
    let (base, stop) = (format!("http://{}", app.addr()), CancellationToken::new());
    let service = tokio::spawn(app.run_until_stopped(stop.clone()));
    let mut package = std::io::Cursor::new(Vec::new());
    rubmap::package::write(&generate(&ImpellerParameters::default())?, &mut package)?;
    let client = Client::new();
    let upload = client.post(format!("{base}/v1/models")).header("content-type", "application/zip");
    let model: Value = upload.body(package.into_inner()).send().await?.json().await?;

    let begin = Instant::now();
    let posted = client.post(format!("{base}/v1/sweeps")).json(&sweep(&model["id"], number)).send().await?;
    let posted: Value = posted.json().await?;
    let path = format!("{base}/v1/jobs/{}", posted["id"].as_str().with_context(|| posted.to_string())?);
    let job = loop {
        let job: Value = client.get(&path).send().await?.json().await?;
        match job["status"].as_str() {
            Some("accepted" | "running") => tokio::time::sleep(Duration::from_millis(50)).await,
            Some("successful") => break job,
            _ => bail!("{job}"),
        }
    };
    let taken = begin.elapsed().as_secs_f64();
    let map: Value = client.get(format!("{path}/interaction-map")).send().await?.json().await?;
    let (choice, setting) = (&job["choice"], &job["choice"]["setting"]);
    let told = |field: &str| choice[field].as_f64().unwrap_or(f64::NAN);
    let text = |field: &str| setting[field].to_string().replace('"', "");
    println!(
        "{number:>8}  {:>9.1}  {:>9.1}  {taken:>8.1}  {:>36}  {:>9.1e}  {:>9.1e}",
        told("spent_s"),
        told("spent_s") + told("expected_wall_time_s"),
        ["modes_per_speed", "steps_per_revolution", "scheme"].map(text).join(", "),
        told("estimated_error"),
        map["errors"]["largest"].as_f64().unwrap_or(f64::NAN),
    );
    stop.cancel();
    service.await?;
    Ok(())
}

fn sweep(model: &Value, number: f64) -> Value {
    let casing = PaperCasing::of(&ImpellerParameters::default());
    let mut sweep = json!({
        "model": model,
        "speeds": {"from": 12000, "to": 36000, "count": 60, "unit": "rpm"},
        "scene": {
            "centrifugal_stiffening": true,
            "damping": {"modal_ratio": 0.005},
            "casing": {
                "clearance": {"leading": casing.leading_clearance, "trailing": casing.trailing_clearance},
                "lobes": {"count": 2, "amplitude": casing.restriction, "width_rad": 0.35},
            },
            "contact": {},
        },
        "integration": {"revolutions": 50},
    });
    match number < 1.0 {
        true => sweep["accuracy"] = json!({"target": number}),
        false => sweep["budget"] = json!({"seconds": number}),
    }
    sweep
}
