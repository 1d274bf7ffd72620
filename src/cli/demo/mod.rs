//! `rubmap demo`: from an impeller to its critical speeds in about a minute, over HTTP as any user would.

mod client;
mod progress;
mod report;
mod requests;

use std::fs::File;
use std::io::BufWriter;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

use crate::analysis::result::{Campbell, CriticalSpeeds, InteractionMap};
use crate::app::App;
use crate::config::Config;
use crate::impeller::{ImpellerParameters, generate};
use crate::plot::{self, VerticalAxis};
use anyhow::{Context, bail};
use clap::Args;
use tokio_util::sync::CancellationToken;

use super::signals::stop_signal;
use client::Client;

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
}

/// Runs the demo; 130, as shells say it, if a signal stopped it.
///
/// # Errors
/// A folder that cannot be used, or a step that the service refuses.
pub(super) fn run(args: &DemoArgs) -> anyhow::Result<ExitCode> {
    let begin = Instant::now();
    std::fs::create_dir_all(&args.out).with_context(|| format!("cannot make {}", args.out.display()))?;
    let package = make_package(&args.out)?;
    let config = Config {
        addr: ([127, 0, 0, 1], 0).into(),
        data: args.out.join("data"),
        workers: args.workers,
        upload_bytes: 1 << 30,
        expanded_bytes: None,
        memory_bytes: None,
    };
    let runtime = tokio::runtime::Builder::new_multi_thread().enable_all().build()?;
    match runtime.block_on(with_service(args, config, &package))? {
        Ending::Played => println!("\nDone in {:.0} s.", begin.elapsed().as_secs_f64()),
        Ending::Stopped => {
            eprintln!("\nStopped; the demo's jobs are cancelled. What it left is in {}.", args.out.display());
            return Ok(ExitCode::from(130));
        }
    }
    Ok(ExitCode::SUCCESS)
}

/// How a demo without errors ends.
enum Ending {
    /// It has shown everything.
    Played,
    /// A signal stopped it.
    Stopped,
}

/// Makes the demo's impeller and keeps it in the out folder.
fn make_package(out: &Path) -> anyhow::Result<PathBuf> {
    let path = out.join("impeller.zip");
    let package = generate(&ImpellerParameters::default())?;
    let file = File::create(&path).with_context(|| format!("cannot create {}", path.display()))?;
    crate::package::write(&package, BufWriter::new(file))
        .with_context(|| format!("cannot write {}", path.display()))?;
    println!(
        "package   {}: {} sectors of {} DOF, {} contact nodes",
        path.display(),
        package.manifest.sectors,
        package.dofs.len(),
        package.manifest.contact.len()
    );
    Ok(path)
}

/// Starts the service, plays the user, and stops the service whatever came of it.
async fn with_service(args: &DemoArgs, config: Config, package: &Path) -> anyhow::Result<Ending> {
    let stop_signal = stop_signal()?;
    let (data, workers) = (config.data.clone(), config.worker_threads());
    let app = App::build(config).await?;
    let client = Client::new(format!("http://{}", app.addr()));
    println!("service   http://{}, {workers} workers, data in {}", app.addr(), data.display());
    let stop = CancellationToken::new();
    let mut service = tokio::spawn(app.run_until_stopped(stop.clone()));
    let outcome = tokio::select! {
        outcome = play(args, &client, package) => outcome.map(|()| Ending::Played),
        ended = &mut service => {
            ended??;
            bail!("the service ended before the demo did");
        }
        () = stop_signal => {
            // Otherwise the jobs would go on at the next start, which is right for a service and wrong for a demo.
            client.cancel_unfinished_jobs().await.map(|()| Ending::Stopped)
        }
    };
    stop.cancel();
    service.await??;
    outcome
}

/// What a user does: upload, post, wait, download, look.
async fn play(args: &DemoArgs, client: &Client, package: &Path) -> anyhow::Result<()> {
    // A demo that was killed leaves jobs that the service has resumed by now.
    client.cancel_unfinished_jobs().await?;
    let model = client.upload(package).await?;
    println!("model     {}{}", model.id, if model.new { "" } else { " (known from an earlier run)" });
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
    let draw = |axis| plot::interaction_map(&map, Some(&critical), Some(&campbell), axis);
    save(&out.join("interaction-map.svg"), &draw(VerticalAxis::EngineOrder))?;
    save(&out.join("interaction-map-frequency.svg"), &draw(VerticalAxis::Frequency))?;
    save(&out.join("campbell.svg"), &plot::campbell(&campbell))?;

    print!("\n{}\n{}", report::credentials(&map), report::critical_speeds(&critical));
    print!("\n{}", report::places(out, sweep.link("interaction-map")?));
    Ok(())
}

fn save(path: &Path, text: &str) -> anyhow::Result<()> {
    std::fs::write(path, text).with_context(|| format!("cannot write {}", path.display()))
}
