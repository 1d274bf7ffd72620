//! `rubmap ls`: lists the jobs or models of a service.

use clap::{Args, ValueEnum};
use serde_json::{Value, json};

use super::find;
use super::kind::kind;
use crate::analysis::result::VerdictWord;
use crate::cli::client::{Answer, Client, Job, Model, ServerArgs};
use crate::cli::size::size;
use crate::cli::stdout::{print, print_json};
use crate::cli::verb::Verb;
use crate::kinds::JobKind;
use crate::store::status::JobStatus;

/// Jobs or models to list.
#[derive(Debug, Args)]
pub(in crate::cli) struct LsArgs {
    /// Models in place of jobs
    #[arg(long, conflicts_with_all = ["status", "kind", "model"])]
    models: bool,
    /// Only jobs with this status
    #[arg(long, value_enum)]
    status: Option<Status>,
    /// Only jobs of this kind
    #[arg(long, value_parser = kind())]
    kind: Option<JobKind>,
    /// Only jobs of this model: its id, the beginning of it, or its name
    #[arg(long)]
    model: Option<String>,
    /// Only entries with this in their name
    #[arg(long)]
    name: Option<String>,
    /// Only entries with this tag
    #[arg(long)]
    tag: Option<String>,
    /// Number of entries at most, the newest first
    #[arg(long, default_value_t = 50, value_parser = clap::value_parser!(u32).range(1..))]
    limit: u32,
    /// Print all that the service says of them as JSON, {"jobs": [...]} or {"models": [...]}
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    server: ServerArgs,
}

/// Status of a job.
#[derive(Debug, Clone, Copy, ValueEnum)]
enum Status {
    /// Waiting for its turn
    Accepted,
    /// Being computed
    Running,
    /// Paused until it is continued
    Paused,
    /// Finished
    Successful,
    /// Could not be computed
    Failed,
    /// Cancelled
    Dismissed,
}

impl From<Status> for JobStatus {
    fn from(status: Status) -> Self {
        match status {
            Status::Accepted => Self::Accepted,
            Status::Running => Self::Running,
            Status::Paused => Self::Paused,
            Status::Successful => Self::Successful,
            Status::Failed => Self::Failed,
            Status::Dismissed => Self::Dismissed,
        }
    }
}

impl Verb for LsArgs {
    fn server(&self) -> &ServerArgs {
        &self.server
    }

    fn json(&self) -> bool {
        self.json
    }

    async fn play(&self, client: &Client) -> anyhow::Result<()> {
        let what = if self.models { "models" } else { "jobs" };
        let model = match &self.model {
            Some(called) => Some(find::model(client, called).await?),
            None => None,
        };
        let filters = [
            ("status", self.status.map(|status| JobStatus::from(status).as_str())),
            ("kind", self.kind.map(|kind| kind.0.name)),
            ("model", model.as_deref()),
            ("name", self.name.as_deref()),
            ("tag", self.tag.as_deref()),
        ];
        let filters: Vec<_> = filters.into_iter().filter(|(_, value)| value.is_some()).collect();
        let query = serde_urlencoded::to_string(&filters)?;
        let query = if query.is_empty() { query } else { query + "&" };
        let most = self.limit as usize;
        let more = if self.models {
            let (models, more) = client.list::<Answer<Model>>(what, &query, most).await?;
            self.show(what, models.iter().map(|model| (model_line(model), &model.body)))?;
            more
        } else {
            let (jobs, more) = client.list::<Answer<Job>>(what, &query, most).await?;
            self.show(what, jobs.iter().map(|job| (job_line(job), &job.body)))?;
            more
        };
        if more {
            client.terminal.say(&format!("there are more {what} than {most}: --limit shows them"));
        }
        Ok(())
    }
}

impl LsArgs {
    fn show<'a>(&self, what: &str, entries: impl Iterator<Item = (String, &'a Value)>) -> anyhow::Result<()> {
        if self.json {
            let bodies: Vec<&Value> = entries.map(|(_, body)| body).collect();
            return print_json(&json!({what: bodies}));
        }
        for (line, _) in entries {
            print(line.trim_end())?;
        }
        Ok(())
    }
}

fn job_line(job: &Job) -> String {
    let (kind, status) = (job.kind.replace('_', "-"), job.status.as_str());
    let name = job.name.as_deref().unwrap_or_default();
    let verdict = job.verdict.map_or("", VerdictWord::as_str);
    let (progress, created) = (job.progress, minute(&job.created_at));
    // A job that waits for room on the disk says so in its phase.
    let phase = &job.phase;
    format!("{}  {kind:<16} {status:<10} {progress:>3} %  {verdict:<9}  {created}  {name}  {phase}", job.id)
}

fn model_line(model: &Model) -> String {
    let Model { id, name, sectors, size_bytes, created_at, .. } = model;
    format!("{id}  {sectors:>3} sectors  {:>8}  {}  {name}", size(*size_bytes), minute(created_at))
}

/// Time to the minute.
fn minute(time: &str) -> String {
    time.get(..16).unwrap_or(time).replace('T', " ")
}
