//! `rubmap pause` and `rubmap continue`: pause jobs, and let them go on where they were.

use clap::Args;
use serde_json::json;

use super::find;
use crate::cli::client::{Client, ServerArgs};
use crate::cli::stdout::print_json;
use crate::cli::verb::Verb;

/// Jobs to pause or continue.
#[derive(Debug, Args)]
pub(in crate::cli) struct PauseArgs {
    /// Jobs: ids, their beginnings, or names
    #[arg(required = true, value_name = "JOB")]
    jobs: Vec<String>,
    /// Print the jobs as they are then as JSON, {"jobs": [...]}
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    server: ServerArgs,
}

/// Jobs to continue.
#[derive(Debug, Args)]
pub(in crate::cli) struct ContinueArgs {
    #[command(flatten)]
    of: PauseArgs,
}

impl PauseArgs {
    /// Pauses the jobs, or lets them go on.
    async fn set(&self, client: &Client, paused: bool) -> anyhow::Result<()> {
        let mut bodies = Vec::new();
        for id in find::jobs(client, &self.jobs).await? {
            let job = client.set_paused(&id, paused).await?;
            client.terminal.say(&format!("job {id} is {}", job.status.as_str()));
            bodies.push(job.body);
        }
        if self.json { print_json(&json!({"jobs": bodies})) } else { Ok(()) }
    }
}

impl Verb for PauseArgs {
    fn server(&self) -> &ServerArgs {
        &self.server
    }

    fn json(&self) -> bool {
        self.json
    }

    async fn play(&self, client: &Client) -> anyhow::Result<()> {
        self.set(client, true).await
    }
}

impl Verb for ContinueArgs {
    fn server(&self) -> &ServerArgs {
        self.of.server()
    }

    fn json(&self) -> bool {
        self.of.json()
    }

    async fn play(&self, client: &Client) -> anyhow::Result<()> {
        self.of.set(client, false).await
    }
}
