//! The command line: one file per command.

mod case;
mod client;
#[cfg_attr(feature = "cluster", path = "cluster/shared/mod.rs")]
#[cfg_attr(not(feature = "cluster"), path = "cluster/alone.rs")]
mod cluster;
mod demo;
mod ending;
mod field_file;
mod fields;
mod fit;
pub mod generate;
mod groups;
mod import;
mod keeping;
mod man;
mod modes;
mod progress;
mod repeat;
mod request;
mod serve;
mod session;
mod shell;
mod signals;
mod size;
mod speed;
mod stdout;
mod study;
mod terminal;
mod token;
mod validate;
mod verb;
mod verdict;

use std::process::ExitCode;

use clap::{CommandFactory, FromArgMatches, Parser, Subcommand};

/// Log level of services where `RUST_LOG` says nothing.
const SERVICE_LOG: &str = "info,apalis_core=warn";

/// At which speeds do the blade tips of a centrifugal impeller interact dangerously with their casing?
#[derive(Debug, Parser)]
#[command(name = "rubmap", version = crate::version::LINE)]
pub struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Send a model package to the service.
    #[command(after_help = ending::CODES)]
    Upload(shell::UploadArgs),
    /// Print a request to start from, in YAML.
    Init(shell::InitArgs),
    /// Say what a request would do and cost.
    #[command(after_help = ending::CODES)]
    Plan(shell::PlanArgs),
    /// Ask for a sweep: contact over a range of speeds.
    #[command(after_help = ending::CODES)]
    Sweep(shell::SweepArgs),
    /// Ask for a job of any kind.
    #[command(after_help = ending::CODES)]
    Submit(shell::SubmitArgs),
    /// Follow jobs to their ends.
    #[command(after_help = ending::CODES)]
    Watch(shell::WatchArgs),
    /// List jobs or models.
    #[command(after_help = ending::CODES)]
    Ls(shell::LsArgs),
    /// Print a job: its state, its verdict and its critical speeds.
    #[command(after_help = ending::CODES)]
    Show(shell::ShowArgs),
    /// Download a result, in any of its forms.
    #[command(after_help = ending::CODES)]
    Get(shell::GetArgs),
    /// Open the service's page in a browser, and print its address.
    #[command(after_help = ending::CODES)]
    Open(shell::OpenArgs),
    /// Cancel jobs; speeds that are finished stay readable.
    #[command(after_help = ending::CODES)]
    Cancel(shell::CancelArgs),
    /// Pause jobs; what is finished stays.
    #[command(after_help = ending::CODES)]
    Pause(shell::PauseArgs),
    /// Continue jobs that were paused.
    #[command(after_help = ending::CODES)]
    Continue(shell::ContinueArgs),
    /// Delete jobs that have ended, or models.
    #[command(after_help = ending::CODES)]
    Rm(shell::RmArgs),
    /// Write the completions of commands for a shell.
    Completions(man::CompletionsArgs),
    /// Write pages for `man`.
    Man(man::ManArgs),
    /// Show the whole way on a generated impeller: upload, sweep, map, critical speeds.
    Demo(demo::DemoArgs),
    /// Show what accuracy costs in time: errors of many settings against a finer one.
    Study(study::StudyArgs),
    /// Show what happens at one speed: motion, forces, energy.
    Case(case::CaseArgs),
    /// Write fields of the whole wheel at one speed, in contact: for ParaView, numpy, or drawn.
    Fields(fields::FieldsArgs),
    /// Print natural frequencies, or write a mode shape: for ParaView, numpy, or drawn.
    Modes(modes::ModesArgs),
    /// Compute the job of an archive again and compare bit by bit.
    Repeat(repeat::RepeatArgs),
    /// Compare computed results with reference solutions: error, limit and verdict of each.
    Validate(validate::ValidateArgs),
    /// Write a job as one page of HTML.
    #[command(after_help = ending::CODES)]
    Report(shell::ReportArgs),
    /// Run the HTTP service.
    Serve(serve::ServeArgs),
    #[command(flatten)]
    Cluster(cluster::Command),
    /// Copy a data folder, while a service works on it or not.
    Backup(keeping::BackupArgs),
    /// Read everything in a data folder and say what is not as it was written.
    Check(keeping::CheckArgs),
    /// Make bearer tokens for a service that is not for everybody.
    #[command(subcommand)]
    Token(token::TokenCommand),
    /// Search for the generated wheel that has given natural frequencies.
    #[command(after_help = fit::CODES)]
    Fit(fit::FitArgs),
    /// Make a model package from a few parameters.
    Generate(generate::GenerateArgs),
    /// Make a model package from the files of a finite-element program.
    #[command(subcommand)]
    Import(import::ImportCommand),
}

impl Cli {
    /// Parses the command line; ends the program where it makes no sense, or asks for help.
    #[must_use]
    pub fn of_arguments() -> Self {
        let matches = groups::grouped(Self::command()).get_matches();
        Self::from_arg_matches(&matches).unwrap_or_else(|error| error.exit())
    }

    /// Log level unless `RUST_LOG` says otherwise: beside a progress bar only errors and warnings.
    #[must_use]
    pub fn default_log(&self) -> &'static str {
        match &self.command {
            Command::Cluster(command) if cluster::is_service(command) => SERVICE_LOG,
            Command::Serve(_) | Command::Generate(_) | Command::Import(_) => SERVICE_LOG,
            _ => "warn",
        }
    }

    /// Runs the command.
    ///
    /// # Errors
    /// The reason why the command could not be done.
    pub fn run(self) -> anyhow::Result<ExitCode> {
        // A reader who stops early has what was wanted, as in `| head`.
        self.dispatch()
            .or_else(|error| if error.is::<stdout::Closed>() { Ok(ExitCode::SUCCESS) } else { Err(error) })
    }

    fn dispatch(self) -> anyhow::Result<ExitCode> {
        match self.command {
            Command::Upload(args) => return verb::run(&args),
            Command::Plan(args) => return verb::run(&args),
            Command::Sweep(args) => return verb::run(&args),
            Command::Submit(args) => return verb::run(&args),
            Command::Watch(args) => return verb::run(&args),
            Command::Ls(args) => return verb::run(&args),
            Command::Show(args) => return verb::run(&args),
            Command::Get(args) => return verb::run(&args),
            Command::Open(args) => return verb::run(&args),
            Command::Cancel(args) => return verb::run(&args),
            Command::Pause(args) => return verb::run(&args),
            Command::Continue(args) => return verb::run(&args),
            Command::Rm(args) => return verb::run(&args),
            Command::Report(args) => return verb::run(&args),
            Command::Demo(args) => return demo::run(&args),
            Command::Study(args) => return study::run(&args),
            Command::Case(args) => return case::run(&args),
            Command::Fields(args) => return fields::run(&args),
            Command::Modes(args) => return modes::run(&args),
            Command::Repeat(args) => return repeat::run(&args),
            Command::Fit(args) => return fit::run(&args),
            Command::Validate(args) => return validate::run(&args),
            Command::Check(args) => return keeping::check(args),
            Command::Serve(args) => serve::run(args)?,
            Command::Cluster(command) => cluster::run(command)?,
            Command::Token(command) => token::token(command)?,
            Command::Backup(args) => keeping::backup(args)?,
            Command::Generate(args) => generate::generate(args)?,
            Command::Import(command) => import::import(command)?,
            Command::Init(args) => shell::init(&args)?,
            Command::Completions(args) => man::completions(&args, Self::command())?,
            Command::Man(args) => man::man(&args, Self::command())?,
        }
        Ok(ExitCode::SUCCESS)
    }
}
