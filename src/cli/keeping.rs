//! `rubmap backup` and `rubmap check`: copies and checks of a data folder.

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::Context;
use clap::Args;

use crate::cli::stdout::narrate;
use crate::store;

/// Copy a data folder, while a service works on it or not.
#[derive(Debug, Args)]
pub(super) struct BackupArgs {
    /// Data folder to copy
    #[arg(long, env = "RUBMAP_DATA", default_value = "./data")]
    data: PathBuf,
    /// Folder for the copy; must not exist. To restore, start a service on (a copy of) it
    #[arg(long)]
    to: PathBuf,
}

/// Read everything in a data folder and say what is not as it was written.
#[derive(Debug, Args)]
pub(super) struct CheckArgs {
    /// Data folder to check
    #[arg(long, env = "RUBMAP_DATA", default_value = "./data")]
    data: PathBuf,
}

/// Copies a data folder.
pub(super) fn backup(BackupArgs { data, to }: BackupArgs) -> anyhow::Result<()> {
    let copied = runtime()?
        .block_on(store::backup(&data, &to))
        .with_context(|| format!("could not back up {} to {}", data.display(), to.display()))?;
    narrate(&format!("{} models and {} jobs in {}", copied.models, copied.jobs, to.display()))?;
    if copied.dropped > 0 {
        narrate(&format!("{} models were deleted meanwhile and are not in it", copied.dropped))?;
    }
    Ok(())
}

/// Checks a data folder; the exit code says whether all is well.
pub(super) fn check(CheckArgs { data }: CheckArgs) -> anyhow::Result<ExitCode> {
    let found = runtime()?
        .block_on(store::check(&data))
        .with_context(|| format!("could not check {}", data.display()))?;
    narrate(&format!(
        "{} models, {} jobs and {} speeds are as they were written",
        found.models, found.jobs, found.speeds
    ))?;
    for wrong in &found.wrong {
        narrate(wrong)?;
    }
    Ok(if found.wrong.is_empty() { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// Runtime for a command that waits for the store.
pub(super) fn runtime() -> std::io::Result<tokio::runtime::Runtime> {
    tokio::runtime::Builder::new_current_thread().enable_all().build()
}
