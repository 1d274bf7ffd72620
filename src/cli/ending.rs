//! Ends of commands that speak to a service: their exit codes and messages.

use std::process::ExitCode;

use super::client::{ClientError, JobError};
use super::stdout::{Closed, print_json};
use crate::analysis::result::VerdictWord;

/// Error of a command that a signal ended.
#[derive(Debug, thiserror::Error)]
#[error("interrupted{0}")]
pub(super) struct Interrupted(pub(super) String);

/// Error of a sweep whose verdict is as bad as `--fail-on` names, or worse.
#[derive(Debug, thiserror::Error)]
#[error("the verdict on job {id} is {verdict}, and --fail-on asks to fail then")]
pub(super) struct Gated {
    /// Id of the job.
    pub(super) id: String,
    /// Verdict on the sweep.
    pub(super) verdict: VerdictWord,
}

/// Exit codes and their meaning, for the help of every command that leaves them.
pub(super) const CODES: &str = "\
Exit codes:
  0    done; with --wait, and of watch: every job is successful
  1    something here: a file that cannot be read or written, a request that is no JSON or YAML
  2    the command line is wrong
  3    the service refuses: what is wrong is said field by field; with --fail-on: the verdict on a sweep is that bad
  4    a job has failed
  5    a job was cancelled
  6    the service cannot be reached, or does not work
  130  interrupted";

/// Exit code of errors on this side: files, requests.
const HERE: u8 = 1;
/// Exit code if the service refuses, and if a verdict is as bad as `--fail-on` names: either way the design does not pass.
const REFUSED: u8 = 3;
/// Exit code if a job has failed.
const FAILED: u8 = 4;
/// Exit code if a job was cancelled.
const CANCELLED: u8 = 5;
/// Exit code if the service cannot be reached, or does not work.
const GAVE_UP: u8 = 6;
/// Exit code if a signal ended the command, as shells say it.
const INTERRUPTED: u8 = 130;

/// Prints why a command did not do what it should, for scripts also as the document of the problem; returns its exit code.
pub(super) fn tell(error: &anyhow::Error, json: bool) -> ExitCode {
    if error.is::<Closed>() {
        // A reader who stops early has what was wanted, as in `| head`.
        return ExitCode::SUCCESS;
    }
    eprintln!("Error: {error:#}");
    if let (true, Some(ClientError::Refused { body, .. })) = (json, error.downcast_ref()) {
        // A failure to print needs no more words: the exit code and the error stream tell the error.
        let _ = print_json(body);
    }
    code(error).into()
}

fn code(error: &anyhow::Error) -> u8 {
    if let Some(error) = error.downcast_ref::<ClientError>() {
        return if error.is_refusal() { REFUSED } else { GAVE_UP };
    }
    match error.downcast_ref() {
        Some(JobError::Failed { .. }) => FAILED,
        Some(JobError::Cancelled(_)) => CANCELLED,
        None if error.is::<Gated>() => REFUSED,
        None if error.is::<Interrupted>() => INTERRUPTED,
        None => HERE,
    }
}
