//! What the demo may be told.

use std::path::PathBuf;

use clap::Args;

/// What the demo computes and where it leaves its results.
#[derive(Debug, Args)]
pub(in crate::cli) struct DemoArgs {
    /// Folder for package, results and drawings; made if missing. A second run writes its results over the first's
    /// and reuses the model and its reduction, which stay in the folder `data` in it.
    #[arg(long, default_value = "./rubmap-demo")]
    pub(super) out: PathBuf,
    /// Threads that compute [default: one per core]
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(super) workers: Option<u16>,
    /// Model package of your own in place of the generated impeller: the same for it, over speeds and in a casing that are chosen
    /// from the package, said, and left in the folder as sweep-request.json
    #[arg(long)]
    pub(super) package: Option<PathBuf>,
    /// JSON file with the body of POST /v1/sweeps for the package, whose `model` may be left out, such as an edited sweep-request.json
    #[arg(long, requires = "package", conflicts_with_all = ["speeds", "revolutions"])]
    pub(super) request: Option<PathBuf>,
    /// Speeds of the sweep, evenly spaced from 12,000 to 36,000 rpm, or over the range chosen for a package
    #[arg(long, default_value_t = 120, value_parser = clap::value_parser!(u32).range(2..=10_000))]
    pub(super) speeds: u32,
    /// Revolutions simulated at each speed; the last two fifths make the spectra
    #[arg(long, default_value_t = 50, value_parser = clap::value_parser!(u32).range(5..=10_000))]
    pub(super) revolutions: u32,
    /// Show what accuracy costs in time, too: the convergence study that `rubmap study` makes
    #[arg(long, conflicts_with = "package")]
    pub(super) full: bool,
}
