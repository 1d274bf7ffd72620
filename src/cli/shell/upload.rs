//! `rubmap upload`: sends a model package to a service.

use std::path::PathBuf;

use clap::Args;
use serde_json::Value;

use crate::cli::client::{Client, ServerArgs, UploadLabels};
use crate::cli::stdout::{print, print_json};
use crate::cli::verb::Verb;

/// Package to upload, and its service.
#[derive(Debug, Args)]
pub(in crate::cli) struct UploadArgs {
    /// Model package, a zip file
    package: PathBuf,
    #[command(flatten)]
    labels: UploadLabels,
    /// Print all that the service says of the model, as JSON [default: its id]
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    server: ServerArgs,
}

impl Verb for UploadArgs {
    fn server(&self) -> &ServerArgs {
        &self.server
    }

    fn json(&self) -> bool {
        self.json
    }

    async fn play(&self, client: &Client) -> anyhow::Result<()> {
        let (model, new) = client.upload(&self.package, &self.labels).await?;
        client.terminal.say(&format!(
            "{}: {} sectors, {} contact nodes{}",
            model.name,
            model.sectors,
            model.contact_nodes,
            if new { "" } else { "; the service had it already" }
        ));
        if !new && self.labels.are_given() {
            client.terminal.say(&format!(
                "the model keeps the name {:?}, its tags and its notes: an upload changes no labels of a known model",
                model.name
            ));
        }
        for warning in model.body["warnings"].as_array().into_iter().flatten().filter_map(Value::as_str) {
            client.terminal.say(&format!("WARNING: {warning}"));
        }
        let stiffening = &model.body["stiffening"];
        if matches!(stiffening["verdict"].as_str(), Some("suspect" | "unsound")) {
            client.terminal.say(&format!("WARNING: {}", stiffening["message"].as_str().unwrap_or_default()));
        }
        if self.json { print_json(&model.body) } else { print(&model.id) }
    }
}
