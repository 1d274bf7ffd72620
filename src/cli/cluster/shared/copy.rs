//! `rubmap copy`: copies a data folder from one machine to a cluster.

use std::path::PathBuf;

use anyhow::Context;
use clap::Args;

use crate::cli::keeping::runtime;
use crate::cli::stdout::narrate;
use crate::cli::terminal::Terminal;
use crate::config::cluster::DatabaseUrl;
use crate::store::cluster::address::Address;
use crate::store::cluster::copy::{self, CopyProgress};

/// Description of what the command does, for its help.
pub(super) const EFFECTS: &str = "\
The folder is only read; no service may run on it. Others may run on the database: they see all rows at once, at the end, and jobs that had not ended
begin there. What is there already is left out, so a copy that broke off is simply started again; where something differs it says what, and copies
no row. The file of tokens and the settings of the service are not in the folder.";

/// Source and targets of a copy.
#[derive(Debug, Args)]
pub(in crate::cli) struct CopyArgs {
    /// Data folder to copy
    #[arg(long, env = "RUBMAP_DATA", default_value = "./data")]
    data: PathBuf,
    /// PostgreSQL database; its tables are brought up to date
    #[arg(long, env = "RUBMAP_DATABASE", hide_env_values = true, value_name = "postgres://USER@HOST/NAME")]
    database: DatabaseUrl,
    /// Object storage: s3://bucket/prefix, or a folder that all processes see
    #[arg(long, env = "RUBMAP_OBJECTS", value_name = "s3://BUCKET/PREFIX")]
    objects: Address,
}

/// Copies a data folder.
pub(super) fn run(CopyArgs { data, database, objects }: CopyArgs) -> anyhow::Result<()> {
    let terminal = Terminal::default();
    let (mut files, mut rows) = (None, None);
    let progress = |progress| match progress {
        CopyProgress::Files(bytes, total) => {
            files.get_or_insert_with(|| terminal.short_bar("files")).show_bytes(bytes, Some(total));
        }
        CopyProgress::Rows(done, total) => {
            let bar = rows.get_or_insert_with(|| terminal.short_bar("rows"));
            bar.show(100 * done / total.max(1), &format!("{done} of {total}"), false);
        }
    };
    let copied = runtime()?
        .block_on(copy::copy(&data, database.expose(), &objects, progress))
        .with_context(|| format!("could not copy {}", data.display()))?;
    narrate(&format!(
        "{} models and {} jobs are there: {} of {} rows and {} of {} files were copied, the others were there",
        copied.models, copied.jobs, copied.new_rows, copied.rows, copied.new_files, copied.files
    ))?;
    Ok(())
}
