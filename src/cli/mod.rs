//! The command line: one file per command.

pub mod generate;
mod serve;

use clap::{Parser, Subcommand};

use crate::config::Config;

/// At which speeds do the blade tips of a centrifugal impeller interact dangerously with their casing?
#[derive(Debug, Parser)]
#[command(name = "rubmap", version)]
pub struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Run the HTTP service.
    Serve(Config),
    /// Make a model package from a few parameters.
    Generate(generate::GenerateArgs),
}

impl Cli {
    /// Does what the command line says.
    pub fn run(self) -> anyhow::Result<()> {
        match self.command {
            Command::Serve(config) => serve::run(config),
            Command::Generate(args) => generate::generate(args),
        }
    }
}
