//! `rubmap demo`: from an impeller to its critical speeds in about a minute, over HTTP as any user would.

mod report;
mod requests;

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Args;

use super::session::client::Client;
use super::session::{Session, impeller, progress, save, upload};
use super::study;
use crate::analysis::result::{Campbell, CriticalSpeeds, InteractionMap};
use crate::plot::{self, VerticalAxis, Window};

/// What the demo computes and where it leaves its results.
#[derive(Debug, Args)]
pub(crate) struct DemoArgs {
    /// Folder for package, results and drawings; made if missing. A second run writes its results over the first's
    /// and reuses the model and its reduction, which stay in the folder `data` in it.
    #[arg(long, default_value = "./rubmap-demo")]
    out: PathBuf,
    /// Threads that compute [default: one per core]
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=1024))]
    workers: Option<u16>,
    /// Speeds of the sweep, evenly spaced from 12,000 to 36,000 rpm
    #[arg(long, default_value_t = 120, value_parser = clap::value_parser!(u32).range(2..=10_000))]
    speeds: u32,
    /// Revolutions simulated at each speed; the last two fifths make the spectra
    #[arg(long, default_value_t = 50, value_parser = clap::value_parser!(u32).range(5..=10_000))]
    revolutions: u32,
    /// Show what accuracy costs in time, too: the convergence study that `rubmap study` makes
    #[arg(long)]
    full: bool,
}

/// Runs the demo; 130, as shells say it, if a signal stopped it.
///
/// # Errors
/// A folder that cannot be used, or a step that the service refuses.
pub(super) fn run(args: &DemoArgs) -> anyhow::Result<ExitCode> {
    let session = Session::begin(&args.out)?;
    let package = impeller::make_package(&args.out)?;
    session.run(args.workers, async |client| play(args, client, &package).await)
}

/// What a user does: upload, post, wait, download, look.
async fn play(args: &DemoArgs, client: &Client, package: &Path) -> anyhow::Result<()> {
    let model = upload(client, package).await?;
    let modal_analysis = client.post_job("/v1/modal-analyses", &requests::modal_analysis(&model.id)).await?;
    let sweep = requests::sweep(&model.id, args.speeds, args.revolutions);
    let sweep = client.post_job("/v1/sweeps", &sweep).await?;
    let modal_analysis = progress::follow(client, &modal_analysis, "modal analysis").await?;
    let sweep = progress::follow(client, &sweep, "sweep").await?;

    let out = &args.out;
    let campbell: Campbell =
        client.download(modal_analysis.link("campbell")?, &out.join("campbell.json")).await?;
    let map: InteractionMap =
        client.download(sweep.link("interaction-map")?, &out.join("interaction-map.json")).await?;
    let critical: CriticalSpeeds =
        client.download(sweep.link("critical-speeds")?, &out.join("critical-speeds.json")).await?;
    let draw = |axis| plot::interaction_map(&map, Some(&critical), Some(&campbell), axis, Window::default());
    save(&out.join("interaction-map.svg"), &draw(VerticalAxis::EngineOrder))?;
    save(&out.join("interaction-map-frequency.svg"), &draw(VerticalAxis::Frequency))?;
    save(&out.join("campbell.svg"), &plot::campbell(&campbell))?;

    print!("\n{}\n{}", report::credentials(&map), report::critical_speeds(&critical));
    print!("\n{}", report::places(out, sweep.link("interaction-map")?, args.full));
    if args.full {
        println!();
        study::play(client, study::request::default(), &model.id, out).await?;
    }
    Ok(())
}
