//! Verdicts at the ends of commands that wait for sweeps.

use anyhow::ensure;

use crate::analysis::kinds::sweep::SWEEP;
use crate::cli::client::{Client, Job};
use crate::cli::verdict::{self, FailOn};

/// Shows the verdict on a successful sweep, on the error stream; fails if it is as bad as `fail_on`. Jobs of other kinds have none, and those of
/// services of an earlier version.
///
/// # Errors
/// [`Gated`](crate::cli::ending::Gated); with `fail_on` also a verdict that cannot be read.
pub(super) async fn verdict(client: &Client, job: &Job, fail_on: Option<FailOn>) -> anyhow::Result<()> {
    if job.kind != SWEEP.name {
        return Ok(());
    }
    if !job.results().contains(&"verdict") {
        ensure!(fail_on.is_none(), "the service has no verdicts: it is of an earlier version");
        return Ok(());
    }
    match (verdict::read(client, &job.id).await, fail_on) {
        (Ok(found), _) => {
            client.terminal.say(&found.to_string());
            fail_on.map_or(Ok(()), |fail_on| Ok(fail_on.check(&job.id, &found)?))
        }
        (Err(error), Some(_)) => Err(error),
        (Err(error), None) => {
            // The sweep itself is done, and that is what was asked for.
            client.terminal.say(&format!("the verdict cannot be read: {error:#}"));
            Ok(())
        }
    }
}
