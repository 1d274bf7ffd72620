//! The command line: one file per command.

mod case;
mod demo;
mod field_file;
mod fields;
pub mod generate;
mod import;
mod keeping;
mod modes;
mod repeat;
mod report;
mod serve;
mod session;
mod signals;
mod speed;
mod study;
mod token;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

use crate::config::Config;

/// At which speeds do the blade tips of a centrifugal impeller interact dangerously with their casing?
#[derive(Debug, Parser)]
#[command(name = "rubmap", version = crate::version::LINE)]
pub struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Show it all on a generated impeller: upload, sweep, map, critical speeds.
    Demo(demo::DemoArgs),
    /// Show what accuracy costs in time: errors of many settings against a finer one.
    Study(study::StudyArgs),
    /// Show what happens at one speed: motion, forces, energy.
    Case(case::CaseArgs),
    /// Write where the whole wheel is at one speed, in contact: for ParaView, numpy, or drawn.
    Fields(fields::FieldsArgs),
    /// Print natural frequencies, or write a mode shape: for ParaView, numpy, or drawn.
    Modes(modes::ModesArgs),
    /// Compute the job of an archive again and compare bit by bit.
    Repeat(repeat::RepeatArgs),
    /// Write a job of a running service as one page of HTML.
    Report(report::ReportArgs),
    /// Run the HTTP service.
    Serve(Config),
    /// Copy a data folder, while a service works on it or not.
    Backup(keeping::BackupArgs),
    /// Read everything in a data folder and say what is not as it was written.
    Check(keeping::CheckArgs),
    /// Make bearer tokens for a service that is not for everybody.
    #[command(subcommand)]
    Token(token::TokenCommand),
    /// Make a model package from a few parameters.
    Generate(generate::GenerateArgs),
    /// Make a model package from the files of a finite-element program.
    #[command(subcommand)]
    Import(import::ImportCommand),
}

impl Cli {
    /// What is logged unless `RUST_LOG` says otherwise: beside a progress bar only what went wrong.
    pub fn default_log(&self) -> &'static str {
        match self.command {
            Command::Demo(_)
            | Command::Study(_)
            | Command::Case(_)
            | Command::Fields(_)
            | Command::Modes(_)
            | Command::Repeat(_)
            | Command::Report(_)
            | Command::Backup(_)
            | Command::Check(_)
            | Command::Token(_) => "warn",
            Command::Serve(_) | Command::Generate(_) | Command::Import(_) => "info,apalis_core=warn",
        }
    }

    /// Does what the command line says.
    pub fn run(self) -> anyhow::Result<ExitCode> {
        match self.command {
            Command::Demo(args) => return demo::run(&args),
            Command::Study(args) => return study::run(&args),
            Command::Case(args) => return case::run(&args),
            Command::Fields(args) => return fields::run(&args),
            Command::Modes(args) => return modes::run(&args),
            Command::Repeat(args) => return repeat::run(&args),
            Command::Check(args) => return keeping::check(args),
            Command::Report(args) => report::report(args)?,
            Command::Serve(config) => serve::run(config)?,
            Command::Token(command) => token::token(command)?,
            Command::Backup(args) => keeping::backup(args)?,
            Command::Generate(args) => generate::generate(args)?,
            Command::Import(command) => import::import(command)?,
        }
        Ok(ExitCode::SUCCESS)
    }
}
