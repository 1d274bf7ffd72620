//! `rubmap report`: writes a job of a running service as one page.

use std::path::PathBuf;

use clap::Args;

use super::find;
use crate::cli::client::{Client, ServerArgs};
use crate::cli::stdout::print;
use crate::cli::verb::Verb;

/// Job that is reported, and its service.
#[derive(Debug, Args)]
pub(in crate::cli) struct ReportArgs {
    /// Sweep or modal analysis: its id, the beginning of it, or its name
    job: String,
    /// Sensor of the map, counted from 0
    #[arg(long, default_value_t = 0)]
    sensor: u32,
    /// File of the page [default: report-ID.html]
    #[arg(long, short, value_name = "FILE")]
    out: Option<PathBuf>,
    #[command(flatten)]
    server: ServerArgs,
}

impl Verb for ReportArgs {
    fn server(&self) -> &ServerArgs {
        &self.server
    }

    async fn play(&self, client: &Client) -> anyhow::Result<()> {
        let job = find::job(client, &self.job).await?;
        let out = self.out.clone().unwrap_or_else(|| PathBuf::from(format!("report-{job}.html")));
        client.save(&format!("/v1/jobs/{job}/report?sensor={}", self.sensor), &out).await?;
        print(&out.display().to_string())
    }
}
