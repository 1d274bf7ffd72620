//! `rubmap cancel`: cancels jobs that shall not be computed to their ends.

use clap::Args;
use serde_json::json;

use super::find;
use crate::cli::client::{Client, ServerArgs};
use crate::cli::stdout::print_json;
use crate::cli::verb::Verb;

/// Jobs to cancel.
#[derive(Debug, Args)]
pub(in crate::cli) struct CancelArgs {
    /// Jobs: ids, their beginnings, or names. Those that have ended stay as they are
    #[arg(required = true, value_name = "JOB")]
    jobs: Vec<String>,
    /// Print the jobs as they are then as JSON, {"jobs": [...]}
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    server: ServerArgs,
}

impl Verb for CancelArgs {
    fn server(&self) -> &ServerArgs {
        &self.server
    }

    fn json(&self) -> bool {
        self.json
    }

    async fn play(&self, client: &Client) -> anyhow::Result<()> {
        let mut bodies = Vec::new();
        for id in find::jobs(client, &self.jobs).await? {
            let job = client.cancel(&id).await?;
            client.terminal.say(&format!("job {id} has ended: {}", job.status.as_str()));
            bodies.push(job.body);
        }
        if self.json { print_json(&json!({"jobs": bodies})) } else { Ok(()) }
    }
}
