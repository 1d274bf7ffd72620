//! `rubmap sweep` and `rubmap submit`: post a request, which becomes a job.

use std::path::{Path, PathBuf};

use clap::Args;
use serde_json::{Value, json};

use super::kind::kind;
use super::{find, gate, watch};
use crate::analysis::kinds::sweep::SWEEP;
use crate::cli::client::{Client, ServerArgs, UploadLabels};
use crate::cli::request::{Setting, read};
use crate::cli::stdout::{print, print_json};
use crate::cli::verb::Verb;
use crate::cli::verdict::FailOn;
use crate::kinds::JobKind;

/// Request for a job, its model and its changes.
#[derive(Debug, Args)]
pub(super) struct RequestArgs {
    /// File with the request, in JSON or YAML; - is the input
    request: PathBuf,
    /// Model in place of the request's: its id, the beginning of it, or its name; or a package.zip, which is uploaded first
    #[arg(long)]
    model: Option<String>,
    /// Change a field of the request, such as /speeds/count=80; may be given several times
    #[arg(long = "set", value_name = "FIELD=VALUE", value_parser = Setting::parse)]
    settings: Vec<Setting>,
}

impl RequestArgs {
    /// Body of the request, with its model and its changes.
    pub(super) async fn body(&self, client: &Client, kind: JobKind) -> anyhow::Result<Value> {
        let mut body = read(&self.request, kind.route)?;
        for setting in &self.settings {
            setting.apply(&mut body)?;
        }
        if let Some(model) = &self.model {
            body["model"] = json!(self.model(client, model).await?);
        }
        Ok(body)
    }

    async fn model(&self, client: &Client, called: &str) -> anyhow::Result<String> {
        let path = Path::new(called);
        if path.extension().is_none_or(|ending| ending != "zip") {
            return find::model(client, called).await;
        }
        let (model, _) = client.upload(path, &UploadLabels::default()).await?;
        client.terminal.say(&format!("model     {}", model.id));
        Ok(model.id.clone())
    }
}

/// Request for a sweep, and whether to wait for it.
#[derive(Debug, Args)]
pub(in crate::cli) struct SweepArgs {
    #[command(flatten)]
    request: RequestArgs,
    /// Follow the job to its end; of a sweep also show the verdict and the three worst speeds
    #[arg(long)]
    wait: bool,
    /// End with exit code 3 if the verdict on the sweep is this bad or worse
    #[arg(long, value_enum, value_name = "VERDICT", requires = "wait")]
    fail_on: Option<FailOn>,
    /// Print all that the service says of the job, as JSON [default: its id]
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    server: ServerArgs,
}

/// Request for a job of any kind, and whether to wait for it.
#[derive(Debug, Args)]
pub(in crate::cli) struct SubmitArgs {
    /// Kind of the job
    #[arg(long, value_parser = kind())]
    kind: JobKind,
    #[command(flatten)]
    job: SweepArgs,
}

impl Verb for SweepArgs {
    fn server(&self) -> &ServerArgs {
        &self.server
    }

    fn json(&self) -> bool {
        self.json
    }

    async fn play(&self, client: &Client) -> anyhow::Result<()> {
        self.submit(client, JobKind(&SWEEP)).await
    }
}

impl Verb for SubmitArgs {
    fn server(&self) -> &ServerArgs {
        &self.job.server
    }

    fn json(&self) -> bool {
        self.job.json
    }

    async fn play(&self, client: &Client) -> anyhow::Result<()> {
        self.job.submit(client, self.kind).await
    }
}

impl SweepArgs {
    async fn submit(&self, client: &Client, kind: JobKind) -> anyhow::Result<()> {
        let body = self.request.body(client, kind).await?;
        let mut job = client.post_job(kind.route, &body).await?;
        if !self.json {
            print(&job.id)?;
        }
        if self.wait {
            job = watch::to_the_end(client, &[job.id.clone()]).await?.remove(0);
        }
        if self.json {
            print_json(&job.body)?;
        }
        if self.wait {
            job.check()?;
            gate::verdict(client, &job, self.fail_on).await?;
        }
        Ok(())
    }
}
