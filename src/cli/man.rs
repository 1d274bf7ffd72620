//! `rubmap completions` and `rubmap man`: completions for shells and pages for `man`, from the program itself.

use std::path::PathBuf;

use anyhow::Context;
use clap::{Args, Command};
use clap_complete::Shell;

use super::stdout::failed;

/// Shell for which completions are printed.
#[derive(Debug, Args)]
pub(super) struct CompletionsArgs {
    /// Shell
    #[arg(value_enum)]
    shell: Shell,
}

/// Folder in which pages are written.
#[derive(Debug, Args)]
pub(super) struct ManArgs {
    /// Folder for the pages, one per command; made if missing
    #[arg(long)]
    out: PathBuf,
}

/// Prints the completions of a shell.
///
/// # Errors
/// An output that cannot be written.
pub(super) fn completions(args: &CompletionsArgs, mut program: Command) -> anyhow::Result<()> {
    use std::io::Write;
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut program, "rubmap", &mut script);
    std::io::stdout().write_all(&script).map_err(failed)
}

/// Writes a page per command.
///
/// # Errors
/// A folder that cannot be written to.
pub(super) fn man(args: &ManArgs, program: Command) -> anyhow::Result<()> {
    let folder = args.out.display();
    std::fs::create_dir_all(&args.out).with_context(|| format!("cannot make {folder}"))?;
    clap_mangen::generate_to(program, &args.out).with_context(|| format!("cannot write to {folder}"))
}
