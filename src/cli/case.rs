//! `rubmap case`: motion, forces and energy at one speed, over HTTP as any user would find out.

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::bail;
use clap::Args;
use serde_json::{Value, json};

use super::client::Client;
use super::session::{Session, impeller, save, upload};
use super::{progress, request};
use crate::analysis::result::{PointStatus, SpeedHistories};
use crate::cli::stdout::narrate;
use crate::plot::{self, HistoryQuantity};

/// Model and request of a case study, and where the results are left.
#[derive(Debug, Args)]
pub(crate) struct CaseArgs {
    /// Model package [default: the impeller of the demo]
    #[arg(long)]
    package: Option<PathBuf>,
    /// JSON file with the body of POST /v1/case-studies, whose `model` may be left out [default: the demo's scene at 24,000
    /// rpm, the first ten revolutions]
    #[arg(long)]
    request: Option<PathBuf>,
    /// Folder for histories and drawings; made if missing. A second run reuses the model and its reduction, which stay in the folder
    /// `data` in it.
    #[arg(long, default_value = "./rubmap-case")]
    out: PathBuf,
    /// Threads that compute [default: one per core]
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=1024))]
    workers: Option<u16>,
}

/// Drawings of a case study by the names of their files.
const DRAWINGS: [(&str, HistoryQuantity); 5] = [
    ("displacement", HistoryQuantity::Displacement),
    ("velocity", HistoryQuantity::Velocity),
    ("force", HistoryQuantity::Force),
    ("contact", HistoryQuantity::Contact),
    ("energy", HistoryQuantity::Energy),
];

/// Runs the case study; 130, as shells say it, if a signal stopped it.
///
/// # Errors
/// A file or folder that cannot be used, a step that the service refuses, or a speed that cannot be computed.
pub(super) fn run(args: &CaseArgs) -> anyhow::Result<ExitCode> {
    let body = match &args.request {
        Some(file) => request::read(file, "/v1/case-studies")?,
        None => default(),
    };
    let session = Session::begin(&args.out)?;
    let package = match &args.package {
        Some(package) => package.clone(),
        None => impeller::make_package(&args.out)?,
    };
    session.run(args.workers, async |client| {
        let model = upload(client, &package).await?;
        play(args, client, request::of_model(body, &model.id)?).await
    })
}

fn default() -> Value {
    json!({
        "speed": {"value": 24000, "unit": "rpm"},
        "scene": impeller::scene(),
        "record": {"revolutions": [0, 10]},
    })
}

/// Posts the case study, waits for it, draws it and prints its results.
async fn play(args: &CaseArgs, client: &Client, body: Value) -> anyhow::Result<()> {
    let job = client.post_job("/v1/case-studies", &body).await?;
    let job = progress::follow(client, &job, "case").await?;
    let out = &args.out;
    let path = job.link("histories")?;
    let histories: SpeedHistories = client.download(path, &out.join("histories.json")).await?;
    let point = &histories.point;
    if point.status != PointStatus::Completed {
        let reason = point.message.as_deref().unwrap_or("the reason is not known");
        let names = DRAWINGS.map(|(name, _)| format!("{name}.svg"));
        for name in names.iter().map(String::as_str).chain(["trajectories.svg", "histories.csv"]) {
            // Of an earlier run in the same folder.
            let _ = std::fs::remove_file(out.join(name));
        }
        bail!(
            "{:.1} rad/s could not be computed: {reason}; histories.json says so, nothing is drawn",
            point.speed_rad_s
        );
    }
    client.save(&format!("{path}?format=csv"), &out.join("histories.csv")).await?;
    for (name, what) in DRAWINGS {
        save(&out.join(format!("{name}.svg")), &plot::speed_histories(&histories, what, 0).svg())?;
    }
    save(&out.join("trajectories.svg"), &plot::trajectories(&histories).svg())?;
    tell(&histories)?;
    narrate(&format!("\nhistories.json, histories.csv and drawings are in {}", out.display()))?;
    Ok(())
}

fn tell(histories: &SpeedHistories) -> anyhow::Result<()> {
    let point = &histories.point;
    let (length, force) = (&histories.units.length, &histories.units.force);
    let message = point.message.as_deref().unwrap_or("completed");
    narrate(&format!("\n{:.1} rad/s: {message}", point.speed_rad_s))?;
    for response in &point.responses {
        narrate(&format!("  {}: rms {:.4} {length}", response.sensor, response.rms))?;
    }
    if let Some(contact) = &point.contact {
        narrate(&format!(
            "  contact: mean force {:.1} {force}, peak {:.1} {force}, {:.0} closings a revolution, {:.0} % of the clearance taken",
            contact.mean_force,
            contact.peak_force,
            contact.closings_per_revolution,
            100.0 * contact.clearance_consumption
        ))?;
    }
    Ok(())
}
