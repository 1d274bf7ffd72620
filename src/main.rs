//! Main of the program: logs, then runs the command of the command line.

use std::env::VarError;
use std::io::IsTerminal;
use std::process::ExitCode;

use anyhow::Context;
use tracing_subscriber::filter::Targets;
use tracing_subscriber::layer::SubscriberExt;
use tracing_subscriber::util::SubscriberInitExt;

/// Allocator that gives back what a computation has freed. The system's allocator keeps it for the thread that had it,
/// and what is kept for all threads together is a multiple of what `--memory-bytes` allows (measured: 1.3 GB where 0.6
/// GB were in use).
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

fn main() -> anyhow::Result<ExitCode> {
    let cli = rubmap::cli::Cli::of_arguments();
    let wanted = match std::env::var("RUST_LOG") {
        Err(error @ VarError::NotUnicode(_)) => return Err(error).context("RUST_LOG"),
        wanted => wanted.unwrap_or_default(),
    };
    let wanted = if wanted.is_empty() { cli.default_log() } else { &wanted };
    // Levels by module; the expressions of `EnvFilter` bring the regex crate, a hundredth of the build, and nobody needs them.
    let filter: Targets = wanted.parse().with_context(|| {
        format!("RUST_LOG is {wanted:?}; it takes levels by module, as in info,rubmap::http=warn")
    })?;
    let lines = tracing_subscriber::fmt::layer().with_writer(std::io::stderr);
    let lines = lines.with_ansi(std::io::stderr().is_terminal());
    tracing_subscriber::registry().with(lines).with(filter).init();
    cli.run()
}
