//! `rubmap watch`: follows jobs to their ends.

use clap::Args;
use futures::future::try_join_all;
use serde_json::{Value, json};

use super::{find, gate};
use crate::cli::client::{Answer, Client, Job, ServerArgs};
use crate::cli::ending::Interrupted;
use crate::cli::progress::follow_any;
use crate::cli::signals::stop_signal;
use crate::cli::stdout::{print, print_json};
use crate::cli::verb::Verb;
use crate::cli::verdict::FailOn;

/// Jobs to follow.
#[derive(Debug, Args)]
pub(in crate::cli) struct WatchArgs {
    /// Jobs: ids, their beginnings, or names
    #[arg(required = true, value_name = "JOB")]
    jobs: Vec<String>,
    /// Print how they ended as JSON, {"jobs": [...]}
    #[arg(long)]
    json: bool,
    /// Show the verdicts on sweeps, and end with exit code 3 if one is this bad or worse
    #[arg(long, value_enum, value_name = "VERDICT")]
    fail_on: Option<FailOn>,
    #[command(flatten)]
    server: ServerArgs,
}

impl Verb for WatchArgs {
    fn server(&self) -> &ServerArgs {
        &self.server
    }

    fn json(&self) -> bool {
        self.json
    }

    async fn play(&self, client: &Client) -> anyhow::Result<()> {
        let ids = find::jobs(client, &self.jobs).await?;
        let jobs = to_the_end(client, &ids).await?;
        if self.json {
            let bodies: Vec<&Value> = jobs.iter().map(|job| &job.body).collect();
            print_json(&json!({"jobs": bodies}))?;
        } else {
            jobs.iter().try_for_each(|job| print(&line(job)))?;
        }
        worst(&jobs)?;
        let mut gated = Ok(());
        if self.fail_on.is_some() {
            // All verdicts are shown, whichever fails.
            for job in &jobs {
                gated = gated.and(gate::verdict(client, job, self.fail_on).await);
            }
        }
        gated
    }
}

/// Follows jobs to their ends, whatever those are. On a signal prints how to go on.
///
/// # Errors
/// [`Interrupted`], or an error in following the jobs.
pub(super) async fn to_the_end(client: &Client, ids: &[String]) -> anyhow::Result<Vec<Answer<Job>>> {
    let stop = stop_signal()?;
    let all = try_join_all(ids.iter().map(|id| follow_one(client, id)));
    tokio::select! {
        jobs = all => jobs,
        () = stop => {
            let ids = ids.join(" ");
            Err(Interrupted(format!("; the service goes on\n  to follow: rubmap watch {ids}\n  to end it: rubmap cancel {ids}")).into())
        }
    }
}

async fn follow_one(client: &Client, id: &str) -> anyhow::Result<Answer<Job>> {
    let job = client.job(id).await?;
    let name = job.name.as_deref().unwrap_or(&job.kind).replace('_', " ");
    follow_any(client, id, &name).await
}

/// Line of a job that has ended: its id, its status, and the verdict on a sweep.
fn line(job: &Job) -> String {
    let verdict = job.verdict.map_or_else(String::new, |verdict| format!("  {verdict}"));
    format!("{}  {}{verdict}", job.id, job.status.as_str())
}

/// Error if a job has failed; if none has, error if one was cancelled.
fn worst(jobs: &[Answer<Job>]) -> anyhow::Result<()> {
    let wrong: Vec<_> = jobs.iter().filter_map(|job| job.check().err()).collect();
    let (failed, cancelled): (Vec<_>, Vec<_>) =
        wrong.into_iter().partition(|error| matches!(error, crate::cli::client::JobError::Failed { .. }));
    match failed.into_iter().chain(cancelled).next() {
        Some(error) => Err(error.into()),
        None => Ok(()),
    }
}
