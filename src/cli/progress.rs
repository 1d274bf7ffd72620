//! Progress of a job on the terminal.

use super::client::{Answer, Client, Job};

/// Follows a job to its end and shows its progress; an error if it was not successful.
pub(super) async fn follow(client: &Client, job: &Job, name: &str) -> anyhow::Result<Answer<Job>> {
    let job = follow_any(client, &job.id, name).await?;
    job.check()?;
    Ok(job)
}

/// Follows a job to its end, whatever that is, and shows its progress.
pub(super) async fn follow_any(client: &Client, id: &str, name: &str) -> anyhow::Result<Answer<Job>> {
    let mut bar = client.terminal.bar(name);
    client.follow(id, |job| bar.show(job.progress, &words(job), job.status.is_final())).await
}

/// Words for the progress of a job: its phase; its status if it waits, was paused or was not successful, and counts of its speeds at the end.
fn words(job: &Job) -> String {
    use crate::store::status::JobStatus::{Accepted, Dismissed, Failed, Paused, Running, Successful};

    match job.status {
        Accepted => "waiting".to_owned(),
        Paused => "paused".to_owned(),
        Failed => "failed".to_owned(),
        Dismissed => "cancelled".to_owned(),
        Running if !job.phase.is_empty() => job.phase.clone(),
        Successful if job.speeds.total == 0 => "done".to_owned(),
        Running if job.speeds.total == 0 => String::new(),
        Running | Successful => format!("{} of {} speeds", job.speeds.finished, job.speeds.total),
    }
}
