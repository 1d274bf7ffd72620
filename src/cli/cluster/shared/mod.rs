//! Commands of a program with the feature `cluster`: about what several processes share.

mod copy;
mod migrate;
mod worker;

use clap::Subcommand;

/// Command about what several processes share.
#[derive(Debug, Subcommand)]
pub(super) enum Command {
    /// Compute what services on the same PostgreSQL database are asked for.
    Worker(worker::WorkerArgs),
    /// Bring the tables of a PostgreSQL database up to date, and end.
    #[command(after_help = crate::store::ACCOUNTS)]
    Migrate(migrate::MigrateArgs),
    /// Copy a data folder into the database and the object storage of a cluster.
    #[command(after_help = copy::EFFECTS)]
    Copy(copy::CopyArgs),
}

/// Runs the command.
pub(super) fn run(command: Command) -> anyhow::Result<()> {
    match command {
        Command::Worker(args) => worker::run(args),
        Command::Migrate(args) => migrate::run(args),
        Command::Copy(args) => copy::run(args),
    }
}

/// Whether the command runs until a signal ends it.
pub(super) fn is_service(command: &Command) -> bool {
    matches!(command, Command::Worker(_))
}
