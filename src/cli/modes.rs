//! `rubmap modes`: frequencies and mode shapes of a package.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Args;
use serde::Deserialize;
use serde_json::json;

use super::client::Client;
use super::field_file::{FieldFileArgs, check};
use super::progress;
use super::session::{Session, upload};
use super::speed::speed;
use crate::cli::stdout::print;

/// Mode that is written, and its package.
#[derive(Debug, Args)]
pub(crate) struct ModesArgs {
    /// Model package
    package: PathBuf,
    /// Speed of rotation, such as 2500 (rad/s) or 24000rpm
    #[arg(long, default_value = "0", value_parser = speed)]
    speed: f64,
    /// Modes per nodal diameter and given speed that the reduction keeps
    #[arg(long, default_value_t = 20, value_parser = clap::value_parser!(u32).range(1..))]
    modes_per_speed: u32,
    /// Nodal diameter of the shape
    #[arg(long, default_value_t = 0)]
    nodal_diameter: u32,
    /// Mode of the shape, from 1 by ascending frequency
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..))]
    mode: u32,
    /// Let the mode travel around the wheel
    #[arg(long)]
    travelling: bool,
    #[command(flatten)]
    file: FieldFileArgs,
    /// File to write the shape to: .vtu, .vtp, .npz, .pvd, .svg or .png [default: none, the frequencies are printed]
    #[arg(long)]
    out: Option<PathBuf>,
}

/// Frequencies of a nodal diameter, as the service lists them.
#[derive(Debug, Deserialize)]
struct Listed {
    nodal_diameter: u32,
    frequencies_hz: Vec<f64>,
}

#[derive(Debug, Deserialize)]
struct List {
    nodal_diameters: Vec<Listed>,
}

/// Reduces the package and writes the shape, or prints the frequencies.
///
/// # Errors
/// A file that cannot be used, or what the service refuses.
pub(super) fn run(args: &ModesArgs) -> anyhow::Result<ExitCode> {
    if let Some(out) = &args.out {
        check(out)?;
    }
    let folder = args.file.folder()?;
    Session::begin(folder.path())?.run(args.file.workers, async |client| play(args, client).await)
}

async fn play(args: &ModesArgs, client: &Client) -> anyhow::Result<()> {
    let model = upload(client, &args.package).await?;
    // The analysis asked for does not matter: it leaves the reduction.
    let body = json!({
        "model": model.id,
        "modes_per_speed": args.modes_per_speed,
        "speeds": {"values": [args.speed], "unit": "rad_s"},
    });
    let job = client.post_job("/v1/modal-analyses", &body).await?;
    progress::follow(client, &job, "reduction").await?;
    let path = format!(
        "/v1/models/{}/modes?modes_per_speed={}&speed_rad_s={}",
        model.id, args.modes_per_speed, args.speed
    );
    let Some(out) = &args.out else {
        let list: List = client.get(&format!("{path}&format=json")).await?;
        print(&format!("\nnatural frequencies in Hz at {:.2} rad/s", args.speed))?;
        for Listed { nodal_diameter, frequencies_hz } in list.nodal_diameters {
            let kept = frequencies_hz.iter().take(args.modes_per_speed as usize);
            let line: String = kept.map(|frequency| format!(" {frequency:11.3}")).collect();
            print(&format!("nodal diameter {nodal_diameter:>2} {line}"))?;
        }
        return Ok(());
    };
    let motion = if args.travelling { "travelling" } else { "standing" };
    let path = format!("{path}&nodal_diameter={}&mode={}&motion={motion}&", args.nodal_diameter, args.mode);
    args.file.save(client, &path, out).await
}
