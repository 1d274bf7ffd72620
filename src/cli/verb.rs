//! Runs commands that speak to a service.

use std::process::ExitCode;

use super::client::{Client, ServerArgs};
use super::ending::{Interrupted, tell};
use super::signals::stop_signal;

/// Command that speaks to a service.
pub(super) trait Verb {
    /// Service to which the command speaks.
    fn server(&self) -> &ServerArgs;

    /// Whether the output of the command is a document for scripts.
    fn json(&self) -> bool {
        false
    }

    /// Runs the command.
    async fn play(&self, client: &Client) -> anyhow::Result<()>;
}

/// Runs a command until it is done or a signal comes; returns its exit code.
///
/// # Errors
/// A runtime that cannot be started.
pub(super) fn run(verb: &impl Verb) -> anyhow::Result<ExitCode> {
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build()?;
    let played = runtime.block_on(async {
        let stop = stop_signal()?;
        let client = verb.server().client()?;
        tokio::select! {
            // The command is polled first: one that waits for a job has more to say when a signal comes.
            biased;
            played = verb.play(&client) => played,
            () = stop => Err(Interrupted(String::new()).into()),
        }
    });
    // A file that is just read for an upload is not waited for.
    runtime.shutdown_background();
    Ok(match played {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => tell(&error, verb.json()),
    })
}
