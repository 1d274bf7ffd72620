//! `rubmap report`: writes a job of a running service as one page.

use std::path::PathBuf;

use clap::Args;

use super::client::{Client, ServerArgs};
use super::stdout::print;
use super::verb::Verb;
use crate::store::jobs::JobId;

/// Job that is reported, and its service.
#[derive(Debug, Args)]
pub(super) struct ReportArgs {
    /// Id of a sweep or a modal analysis
    #[arg(value_parser = job)]
    job: JobId,
    /// Sensor of the map, counted from 0
    #[arg(long, default_value_t = 0)]
    sensor: u32,
    /// File of the page [default: report-JOB.html]
    #[arg(long)]
    out: Option<PathBuf>,
    #[command(flatten)]
    server: ServerArgs,
}

impl Verb for ReportArgs {
    fn server(&self) -> &ServerArgs {
        &self.server
    }

    async fn play(&self, client: &Client) -> anyhow::Result<()> {
        let Self { job, sensor, .. } = self;
        let out = self.out.clone().unwrap_or_else(|| PathBuf::from(format!("report-{job}.html")));
        client.save(&format!("/v1/jobs/{job}/report?sensor={sensor}"), &out).await?;
        print(&out.display().to_string())
    }
}

fn job(text: &str) -> Result<JobId, String> {
    JobId::parse(text).ok_or_else(|| "expected the id of a job, as in /v1/jobs".to_owned())
}
