//! `rubmap demo`: from an impeller to its critical speeds in about a minute, over HTTP as any user would.

mod args;
mod own;
mod report;
mod requests;
mod results;
mod sensible;

use std::path::Path;
use std::process::ExitCode;

use super::client::Client;
use super::progress;
use super::session::{Session, impeller, upload};
use super::study;
use crate::cli::stdout::narrate;

pub(super) use args::DemoArgs;

/// Runs the demo; 130, as shells say it, if a signal stopped it.
///
/// # Errors
/// A folder that cannot be used, or a step that the service refuses.
pub(super) fn run(args: &DemoArgs) -> anyhow::Result<ExitCode> {
    if let Some(package) = &args.package {
        return own::run(args, package);
    }
    let session = Session::begin(&args.out)?;
    let package = impeller::make_package(&args.out)?;
    session.run(args.workers, async |client| play(args, client, &package).await)
}

/// Plays the user: uploads, posts, waits, downloads, looks.
async fn play(args: &DemoArgs, client: &Client, package: &Path) -> anyhow::Result<()> {
    let model = upload(client, package).await?;
    let modal_analysis = client.post_job("/v1/modal-analyses", &requests::modal_analysis(&model.id)).await?;
    let sweep = requests::sweep(&model.id, args.speeds, args.revolutions);
    let sweep = client.post_job("/v1/sweeps", &sweep).await?;
    let modal_analysis = progress::follow(client, &modal_analysis, "modal analysis").await?;
    let sweep = progress::follow(client, &sweep, "sweep").await?;

    let out = &args.out;
    let results = results::download(client, &modal_analysis, &sweep, out).await?;
    narrate(&format!(
        "\n{}\n\n{}\n{}",
        results.verdict,
        report::credentials(&results.map),
        report::critical_speeds(&results.critical)
    ))?;
    narrate(&format!("\n{}", report::places(out, sweep.link("interaction-map")?, args.full)))?;
    if args.full {
        narrate("\n")?;
        study::play(client, study::request::default(), &model.id, out).await?;
    }
    Ok(())
}
