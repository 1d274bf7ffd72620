//! Running a command that speaks to a service.

use std::process::ExitCode;

use super::client::{Client, ServerArgs};
use super::ending::{Interrupted, tell};
use super::signals::stop_signal;

/// A command that speaks to a service.
pub(super) trait Verb {
    /// Which service.
    fn server(&self) -> &ServerArgs;

    /// Whether its output is a document for scripts.
    fn json(&self) -> bool {
        false
    }

    /// Does it.
    async fn play(&self, client: &Client) -> anyhow::Result<()>;
}

/// Does what a command says until it is done or a signal comes; returns its code.
///
/// # Errors
/// A runtime that cannot be had.
pub(super) fn run(verb: &impl Verb) -> anyhow::Result<ExitCode> {
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build()?;
    let played = runtime.block_on(async {
        let stop = stop_signal()?;
        let client = verb.server().client()?;
        tokio::select! {
            // First: who waits for a job has more to say when a signal comes.
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
