//! `rubmap report`: a job of a running service as one page.

use std::path::PathBuf;

use clap::Args;

use super::session::client::Client;
use crate::store::jobs::JobId;

/// Which job, and where it is.
#[derive(Debug, Args)]
pub(super) struct ReportArgs {
    /// Id of a sweep or a modal analysis
    #[arg(value_parser = job)]
    job: JobId,
    /// The service that has it
    #[arg(long, env = "RUBMAP_SERVER", default_value = "http://127.0.0.1:8080")]
    server: String,
    /// Token, if the service wants one
    #[arg(long, env = "RUBMAP_TOKEN", hide_env_values = true)]
    token: Option<String>,
    /// Sensor of the map, counted from 0
    #[arg(long, default_value_t = 0)]
    sensor: u32,
    /// File of the page [default: report-JOB.html]
    #[arg(long)]
    out: Option<PathBuf>,
}

/// Writes the page.
///
/// # Errors
/// A service that does not answer or refuses, a file that cannot be written.
pub(super) fn report(args: ReportArgs) -> anyhow::Result<()> {
    let ReportArgs { job, server, token, sensor, out } = args;
    let out = out.unwrap_or_else(|| PathBuf::from(format!("report-{job}.html")));
    let client = Client::new(server.trim_end_matches('/').to_owned()).with_token(token);
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build()?;
    runtime.block_on(client.save(&format!("/v1/jobs/{job}/report?sensor={sensor}"), &out))?;
    println!("{}", out.display());
    Ok(())
}

fn job(text: &str) -> Result<JobId, String> {
    JobId::parse(text).ok_or_else(|| "expected the id of a job, as in /v1/jobs".to_owned())
}
