//! `rubmap study`: shows what accuracy costs in time, over HTTP as any user would find out.

mod report;
pub(super) mod request;

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Args;
use serde_json::Value;

use super::client::Client;
use super::session::{Session, impeller, save, upload};
use super::{progress, request as bodies};
use crate::analysis::result::Quantity;
use crate::analysis::run::{Histories, WorkPrecision};
use crate::cli::stdout::narrate;
use crate::{export, plot};

/// Model and request of a study, and where the results are left.
#[derive(Debug, Args)]
pub(crate) struct StudyArgs {
    /// Model package [default: the impeller of the demo]
    #[arg(long)]
    package: Option<PathBuf>,
    /// JSON file with the body of POST /v1/studies, whose `model` may be left out [default: the demo's scene at 24,000 rpm
    /// with the grid of the paper's five numbers of modes]
    #[arg(long)]
    request: Option<PathBuf>,
    /// Folder for results and drawings; made if missing. A second run reuses the reductions and runs that it shares with the
    /// first, which stay in the folder `data` in it.
    #[arg(long, default_value = "./rubmap-study")]
    out: PathBuf,
    /// Threads that compute [default: one per core]
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=1024))]
    workers: Option<u16>,
}

/// Runs the study; 130, as shells say it, if a signal stopped it.
///
/// # Errors
/// A file or folder that cannot be used, or a step that the service refuses.
pub(super) fn run(args: &StudyArgs) -> anyhow::Result<ExitCode> {
    let body = match &args.request {
        Some(file) => bodies::read(file, "/v1/studies")?,
        None => request::default(),
    };
    let session = Session::begin(&args.out)?;
    let package = match &args.package {
        Some(package) => package.clone(),
        None => impeller::make_package(&args.out)?,
    };
    session.run(args.workers, async |client| {
        let model = upload(client, &package).await?;
        play(client, body, &model.id, &args.out).await
    })
}

/// Posts a study of an uploaded model, waits for it, draws it and prints its results.
pub(super) async fn play(client: &Client, body: Value, model: &str, out: &Path) -> anyhow::Result<()> {
    let body = bodies::of_model(body, model)?;
    let job = client.post_job("/v1/studies", &body).await?;
    let job = progress::follow(client, &job, "study").await?;

    let found: WorkPrecision =
        client.download(job.link("work-precision")?, &out.join("work-precision.json")).await?;
    let mut table = Vec::new();
    export::write_csv(&found, None, &mut table)?;
    save(&out.join("work-precision.csv"), &String::from_utf8(table)?)?;
    for index in 0..found.speeds.len() {
        let speed = name(&found, index);
        for quantity in Quantity::ALL {
            let file = format!("work-precision{speed}-{}.svg", quantity.as_str().replace('_', "-"));
            save(&out.join(file), &plot::work_precision(&found, index, quantity).svg())?;
        }
        let path = format!("{}?speed={index}", job.link("histories")?);
        let histories: Histories =
            client.download(&path, &out.join(format!("histories{speed}.json"))).await?;
        save(&out.join(format!("histories{speed}.svg")), &plot::histories(&histories, 0).svg())?;
    }

    if let Some(first) = found.speeds.first() {
        narrate(&format!("\n{}\n{}", report::front(first), report::orders(first)))?;
        narrate(&format!("\n{}\n", first.message))?;
        narrate(&format!("\n{}", report::places(out, &name(&found, 0))))?;
    }
    Ok(())
}

/// Part of the names of a speed's files that tells the speed: its index, as the service counts, and rpm; empty if it is the only one.
fn name(found: &WorkPrecision, index: usize) -> String {
    match found.speeds.len() {
        1 => String::new(),
        _ => format!("-{index}-{:.0}rpm", report::rpm(found.speeds[index].speed_rad_s)),
    }
}
