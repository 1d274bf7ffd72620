//! `rubmap migrate`: the tables of a shared database, brought up to date by the account that owns them.

use anyhow::Context;
use clap::Args;

use super::keeping::runtime;
use crate::config::DatabaseUrl;
use crate::store;

/// What accounts need, for the help.
pub(super) const ACCOUNTS: &str = "\
The account that runs this owns the tables. It needs the right to create in the database (a schema, the extension hstore) and in its schema
public; the owner of the database has both. An account SERVICE for `serve` and `worker` needs no more than this, which the owner grants:

  grant usage on schema public, apalis to SERVICE;
  grant select, insert, update, delete on all tables in schema public, apalis to SERVICE;
  revoke insert, update, delete on public._sqlx_migrations, apalis._sqlx_migrations from SERVICE;
  alter default privileges in schema public, apalis grant select, insert, update, delete on tables to SERVICE;

The last line is about tables of later versions.";

/// A database.
#[derive(Debug, Args)]
pub(super) struct MigrateArgs {
    /// PostgreSQL database, by the account that owns its tables
    #[arg(long, env = "RUBMAP_DATABASE", hide_env_values = true, value_name = "postgres://OWNER@HOST/NAME")]
    database: DatabaseUrl,
}

/// Brings its tables up to date.
pub(super) fn run(MigrateArgs { database }: MigrateArgs) -> anyhow::Result<()> {
    let upgrades = runtime()?
        .block_on(store::migrate(database.expose()))
        .context("could not bring the tables up to date")?;
    for store::Upgrade { part, steps, version } in upgrades {
        match steps {
            0 => println!("the tables of {part} were up to date: version {version}"),
            1 => println!("the tables of {part} were brought up to date in 1 step: version {version}"),
            _ => println!("the tables of {part} were brought up to date in {steps} steps: version {version}"),
        }
    }
    Ok(())
}
