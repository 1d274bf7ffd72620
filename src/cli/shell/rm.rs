//! `rubmap rm`: deletes jobs or models that nobody needs any more.

use clap::Args;
use serde_json::json;

use super::find;
use crate::cli::client::{Client, ClientError, ServerArgs};
use crate::cli::stdout::print_json;
use crate::cli::verb::Verb;

/// Jobs or models to delete.
#[derive(Debug, Args)]
pub(in crate::cli) struct RmArgs {
    /// Jobs that have ended, deleted with their results: ids, their beginnings, or names
    #[arg(required = true, value_name = "JOB")]
    called: Vec<String>,
    /// Delete models in place of jobs, with their packages and reductions
    #[arg(long)]
    models: bool,
    /// Print the ids of the deleted jobs or models as JSON, {"deleted": [...]}
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    server: ServerArgs,
}

impl Verb for RmArgs {
    fn server(&self) -> &ServerArgs {
        &self.server
    }

    fn json(&self) -> bool {
        self.json
    }

    async fn play(&self, client: &Client) -> anyhow::Result<()> {
        let mut ids = Vec::new();
        for called in &self.called {
            ids.push(if self.models {
                find::model(client, called).await?
            } else {
                find::job(client, called).await?
            });
        }
        let what = if self.models { "models" } else { "jobs" };
        for id in &ids {
            if !self.models {
                check_ended(client, id).await?;
            }
            client.delete(&format!("/v1/{what}/{id}")).await?;
        }
        if self.json { print_json(&json!({"deleted": ids})) } else { Ok(()) }
    }
}

/// Refuses a job that is still being computed: DELETE would cancel it.
async fn check_ended(client: &Client, id: &str) -> anyhow::Result<()> {
    let job = client.job(id).await?;
    if job.status.is_final() {
        return Ok(());
    }
    let words = format!("job {id} is {}: rubmap cancel {id}", job.status.as_str());
    Err(ClientError::Unfit(words).into())
}
