//! `rubmap migrate`: brings the tables of a shared database up to date, by the account that owns them.

use anyhow::Context;
use clap::Args;

use crate::cli::keeping::runtime;
use crate::cli::stdout::narrate;
use crate::config::cluster::DatabaseUrl;
use crate::store;

/// Database to bring up to date.
#[derive(Debug, Args)]
pub(in crate::cli) struct MigrateArgs {
    /// PostgreSQL database, by the account that owns its tables
    #[arg(long, env = "RUBMAP_DATABASE", hide_env_values = true, value_name = "postgres://OWNER@HOST/NAME")]
    database: DatabaseUrl,
}

/// Brings the tables of the database up to date.
pub(super) fn run(MigrateArgs { database }: MigrateArgs) -> anyhow::Result<()> {
    let upgrades = runtime()?
        .block_on(store::migrate(database.expose()))
        .context("could not bring the tables up to date")?;
    for store::Upgrade { part, steps, version } in upgrades {
        match steps {
            0 => narrate(&format!("the tables of {part} were up to date: version {version}"))?,
            1 => narrate(&format!(
                "the tables of {part} were brought up to date in 1 step: version {version}"
            ))?,
            _ => narrate(&format!(
                "the tables of {part} were brought up to date in {steps} steps: version {version}"
            ))?,
        }
    }
    Ok(())
}
