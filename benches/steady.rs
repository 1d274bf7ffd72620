//! Steady responses solved for and marched to: `cargo bench --bench steady [-- DAMPING …]`: the demo's sweep, speed by speed on one worker of the
//! service. Run it on an otherwise idle machine.
//!
//! A march takes 50 revolutions, or as many as it takes until it repeats (`"revolutions": "auto"`), and beside that as many as it needs until every
//! revolution shows the amplitude of a stable response to a thousandth, up to [`LONG`].

#[path = "service/demo.rs"]
mod demo;
mod service;

use std::collections::BTreeMap;

use anyhow::{Context, bail};
use rubmap::impeller::Preset;
use serde_json::{Value, json};

use demo::demo_sweep;
use service::Service;

const SPEEDS: u32 = 24;
const REVOLUTIONS: u64 = 50;
const LONG: u64 = 300;
const SETTLED: f64 = 1e-3;

fn main() -> anyhow::Result<()> {
    let asked: Vec<f64> = std::env::args().skip(1).filter_map(|argument| argument.parse().ok()).collect();
    let dampings = if asked.is_empty() { vec![1e-2, 5e-3, 1e-3, 5e-4] } else { asked };
    tokio::runtime::Builder::new_multi_thread().enable_all().build()?.block_on(measure(&dampings))
}

async fn measure(dampings: &[f64]) -> anyhow::Result<()> {
    let service = Service::start(1, &Preset::Small.parameters()).await?;
    println!(
        "{SPEEDS} speeds; times are sums over all of them, of stable responses over those that a march comes to.\n"
    );
    println!(
        "| damping | found | of these | taken by `auto` | marched {REVOLUTIONS} rev, s | marched until it repeats | of these, s | all, s | `periodic`, s | ratio | `auto`, s | stable: marched to 1e-3, s | `periodic`, s | ratio |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|---|---|---|---|");
    for &damping in dampings {
        let mut points = Vec::new();
        for how in ["march", "periodic", "auto"] {
            points.push(swept(&service, damping, how, &json!(REVOLUTIONS)).await?);
        }
        let [marched, periodic, auto] = &points[..] else { bail!("three sweeps") };
        let until = swept(&service, damping, "march", &json!("auto")).await?;
        let (repeating, _): (Vec<Value>, Vec<Value>) =
            until.iter().cloned().partition(|point| point["march"]["period_revolutions"].is_u64());
        let seconds =
            |points: &[Value]| points.iter().filter_map(|point| point["wall_time_s"].as_f64()).sum::<f64>();
        let mut kinds = BTreeMap::<&str, usize>::new();
        for point in periodic {
            *kinds.entry(point["steady"]["stability"].as_str().unwrap_or("none")).or_default() += 1;
        }
        let found = SPEEDS as usize - kinds.remove("none").unwrap_or(0);
        let kinds: Vec<String> = kinds.into_iter().map(|(kind, count)| format!("{count} {kind}")).collect();
        let taken = auto.iter().filter(|point| point["steady"]["taken"] == true).count();
        let (mut long, mut solved) = (0.0, 0.0);
        for index in 0..SPEEDS as usize {
            let steady = &periodic[index]["steady"];
            if steady["stability"] != "stable" {
                continue;
            }
            let Some(amplitude) = steady["half_peak_to_peak"][0].as_f64() else { continue };
            let Some(revolutions) = settles(&service, damping, &marched[index], amplitude).await? else {
                continue;
            };
            let time = |point: &Value| point["wall_time_s"].as_f64().unwrap_or(0.0);
            long += revolutions as f64 / REVOLUTIONS as f64 * time(&marched[index]);
            solved += time(&periodic[index]);
        }
        let (marched, periodic, auto) = (seconds(marched), seconds(periodic), seconds(auto));
        println!(
            "| {damping} | {found} | {} | {taken} | {marched:.1} | {} | {:.1} | {:.1} | {periodic:.1} | {:.1} | {auto:.1} | {long:.1} | {solved:.1} | {:.1} |",
            kinds.join(", "),
            repeating.len(),
            seconds(&repeating),
            seconds(&until),
            marched / periodic,
            long / solved
        );
    }
    service.stop().await
}

/// Number of revolutions after which a march shows this amplitude; `None` if it does not in [`LONG`].
async fn settles(
    service: &Service,
    damping: f64,
    point: &Value,
    amplitude: f64,
) -> anyhow::Result<Option<u64>> {
    let mut case = sweep(&service.model, damping, "march", &json!(LONG));
    let fields = case.as_object_mut().context("no object")?;
    fields.remove("speeds");
    fields.insert("speed".to_owned(), json!({"value": point["speed_rad_s"], "unit": "rad_s"}));
    fields.insert("record".to_owned(), json!({"revolutions": [0, LONG], "quantities": ["displacement"]}));
    let path = service.done("case-studies", &case).await?;
    let histories = service.get(&format!("{path}/histories")).await?;
    let line: Vec<f64> = histories["sensors"][0]["displacement"]
        .as_array()
        .context("no history")?
        .iter()
        .filter_map(Value::as_f64)
        .collect();
    let off = |revolution: &[f64]| {
        let (low, high) = revolution.iter().fold((f64::MAX, f64::MIN), |(l, h), &x| (l.min(x), h.max(x)));
        (0.5 * (high - low) / amplitude - 1.0).abs() > SETTLED
    };
    let last = line.chunks_exact(line.len() / LONG as usize).rposition(off).map_or(0, |last| last as u64 + 1);
    // One more revolution is needed to read the amplitude from.
    Ok((last < LONG - 1).then_some(last + 1))
}

async fn swept(
    service: &Service,
    damping: f64,
    how: &str,
    revolutions: &Value,
) -> anyhow::Result<Vec<Value>> {
    let path = service.done("sweeps", &sweep(&service.model, damping, how, revolutions)).await?;
    service.points(&path).await
}

fn sweep(model: &Value, damping: f64, how: &str, revolutions: &Value) -> Value {
    let mut sweep = demo_sweep(model, SPEEDS, revolutions);
    sweep["scene"]["damping"]["modal_ratio"] = json!(damping);
    sweep["integration"]["steady"] = json!(how);
    sweep
}
