//! Output stream: results, and reports of commands on their work.

use std::io::{ErrorKind, Write};

use serde_json::Value;

/// Error of an output whose reader has gone: nobody wants more of it.
#[derive(Debug, thiserror::Error)]
#[error("nobody reads the output any more")]
pub(super) struct Closed;

/// Writes a line.
///
/// # Errors
/// [`Closed`], or an output that cannot be written.
pub(super) fn print(line: &str) -> anyhow::Result<()> {
    let mut out = std::io::stdout().lock();
    match writeln!(out, "{line}").and_then(|()| out.flush()) {
        Ok(()) => Ok(()),
        Err(error) => Err(failed(error)),
    }
}

/// Writes the report of a command on its work, which ends with a new line; the work goes on where nobody reads it.
///
/// # Errors
/// An output that cannot be written.
pub(super) fn narrate(text: &str) -> anyhow::Result<()> {
    let written = print(text.strip_suffix('\n').unwrap_or(text));
    written.or_else(|error| if error.is::<Closed>() { Ok(()) } else { Err(error) })
}

/// Writes a document for scripts.
///
/// # Errors
/// As [`print`].
pub(super) fn print_json(document: &Value) -> anyhow::Result<()> {
    print(&format!("{document:#}"))
}

/// Error of an output that cannot be written.
pub(super) fn failed(error: std::io::Error) -> anyhow::Error {
    match error.kind() {
        ErrorKind::BrokenPipe => Closed.into(),
        _ => anyhow::Error::new(error).context("cannot write the output"),
    }
}
