//! `rubmap show`: prints a job, with its verdict and the table of its critical speeds.

use std::f64::consts::TAU;

use clap::Args;
use serde::Deserialize;

use super::find;
use crate::analysis::kinds::sweep::SWEEP;
use crate::cli::client::{Client, Job, ServerArgs};
use crate::cli::stdout::print;
use crate::cli::verb::Verb;
use crate::cli::verdict;
use crate::dynamics::sector::Units;
use crate::store::status::JobStatus;

/// Job to show.
#[derive(Debug, Args)]
pub(in crate::cli) struct ShowArgs {
    /// Job: its id, the beginning of it, or its name
    job: String,
    #[command(flatten)]
    server: ServerArgs,
}

/// Critical speeds of the wheel, as far as they are shown.
#[derive(Debug, Deserialize)]
struct CriticalSpeeds {
    critical_speeds: Vec<CriticalSpeed>,
    units: Units,
}

/// Critical speed of the wheel, as far as it is shown.
#[derive(Debug, Deserialize)]
struct CriticalSpeed {
    speed_rad_s: f64,
    speed_error_rad_s: f64,
    resolved: bool,
    tip: Tip,
    #[serde(default)]
    peak_force: Option<f64>,
    #[serde(default)]
    utilisation: Option<f64>,
    settling: String,
    #[serde(default)]
    validity: Option<String>,
}

#[derive(Debug, Deserialize)]
struct Tip {
    half_peak_to_peak: f64,
    #[serde(default)]
    over_clearance: Option<f64>,
}

impl Verb for ShowArgs {
    fn server(&self) -> &ServerArgs {
        &self.server
    }

    async fn play(&self, client: &Client) -> anyhow::Result<()> {
        let job = client.job(&find::job(client, &self.job).await?).await?;
        print(&head(&job))?;
        if let Err(error) = job.check()
            && job.status.is_final()
        {
            print(&error.to_string())?;
        }
        if job.kind == SWEEP.name && job.results().contains(&"verdict") {
            print(&format!("\n{}", verdict::read(client, &job.id).await?))?;
        }
        if job.kind == SWEEP.name && job.status == JobStatus::Successful {
            let speeds: CriticalSpeeds =
                client.get(&format!("/v1/jobs/{}/critical-speeds/wheel", job.id)).await?;
            print(&format!("\n{}", table(&speeds)))?;
        }
        print(&format!("\nresults: {}", job.results().join(", ")))
    }
}

/// Lines about the job as a whole.
fn head(job: &Job) -> String {
    let kind = job.kind.replace('_', " ");
    let name = job.name.as_deref().map_or_else(String::new, |name| format!(" {name:?}"));
    // The phase is empty unless the job runs; a job that waits for room on the disk says so in it.
    let state = match job.speeds.total {
        _ if !job.phase.is_empty() => format!(", {}", job.phase),
        0 => String::new(),
        total => format!(", {} of {total} speeds", job.speeds.finished),
    };
    format!("{kind}{name}, {}\n{} at {} %{state}", job.id, job.status.as_str(), job.progress)
}

/// Table of the critical speeds, the most severe first.
fn table(speeds: &CriticalSpeeds) -> String {
    if speeds.critical_speeds.is_empty() {
        return "no critical speeds".to_owned();
    }
    let Units { length, force, .. } = &speeds.units;
    let some = |value: Option<f64>| value.map_or_else(String::new, verdict::number);
    let rpm = |speed_rad_s: f64| format!("{:.0}", speed_rad_s * 60.0 / TAU);
    let mut lines = vec![[
        "critical rpm".to_owned(),
        "± rpm".to_owned(),
        format!("tip motion {length}"),
        "of clearance".to_owned(),
        format!("force {force}"),
        "utilisation".to_owned(),
        "steady state".to_owned(),
        "linear theory".to_owned(),
    ]];
    lines.extend(speeds.critical_speeds.iter().map(|speed| {
        let error = rpm(speed.speed_error_rad_s);
        [
            rpm(speed.speed_rad_s),
            if speed.resolved { error } else { format!("{error} ≥") },
            verdict::number(speed.tip.half_peak_to_peak),
            some(speed.tip.over_clearance),
            some(speed.peak_force),
            some(speed.utilisation),
            speed.settling.replace('_', " "),
            speed.validity.as_deref().unwrap_or_default().replace('_', " "),
        ]
    }));
    let width =
        |column: usize| lines.iter().map(|line| line[column].chars().count()).max().unwrap_or_default();
    let widths: Vec<usize> = (0..8).map(width).collect();
    let padded = |line: &[String; 8]| {
        let cells: Vec<String> =
            line.iter().zip(&widths).map(|(cell, &width)| format!("{cell:>width$}")).collect();
        cells.join("  ")
    };
    let mut text: Vec<String> = lines.iter().map(padded).collect();
    if speeds.critical_speeds.iter().any(|speed| !speed.resolved) {
        text.push("≥: the speeds do not resolve this peak, which may be higher between them, or beyond an end of the range".to_owned());
    }
    text.join("\n")
}
