//! Finds models and jobs by what people call them.

use serde::Deserialize;

use crate::cli::client::{Client, ClientError};
use crate::store::jobs::JobId;

/// Number of digits of the id of a model.
const MODEL_DIGITS: usize = 64;

/// Candidates that are shown at most.
const SHOWN: usize = 5;

/// Model or job in a list.
#[derive(Debug, Deserialize)]
struct Listed {
    id: String,
    #[serde(default)]
    name: Option<String>,
}

/// Finds the id of a job that is called by its id, the beginning of it, or its name.
pub(super) async fn job(client: &Client, called: &str) -> anyhow::Result<String> {
    if JobId::parse(called).is_some() {
        return Ok(called.to_owned());
    }
    find(client, "jobs", called).await
}

/// Finds the ids of jobs.
pub(super) async fn jobs(client: &Client, called: &[String]) -> anyhow::Result<Vec<String>> {
    let mut ids = Vec::with_capacity(called.len());
    for called in called {
        ids.push(job(client, called).await?);
    }
    Ok(ids)
}

/// Finds the id of a model that is called by its id, the beginning of it, or its name.
pub(super) async fn model(client: &Client, called: &str) -> anyhow::Result<String> {
    if called.len() == MODEL_DIGITS && called.bytes().all(|byte| byte.is_ascii_hexdigit()) {
        return Ok(called.to_owned());
    }
    find(client, "models", called).await
}

async fn find(client: &Client, what: &str, called: &str) -> anyhow::Result<String> {
    let (all, _) = client.list::<Listed>(what, "", usize::MAX).await?;
    let matches = |listed: &Listed| {
        (!called.is_empty() && listed.id.starts_with(called)) || listed.name.as_deref() == Some(called)
    };
    let found: Vec<Listed> = all.into_iter().filter(matches).collect();
    let words = match found.as_slice() {
        [one] => return Ok(one.id.clone()),
        [] => format!("none of the {what} has the name {called:?}, or an id that begins so"),
        several => {
            let ids: Vec<&str> = several.iter().take(SHOWN).map(|listed| listed.id.as_str()).collect();
            let more = several.len().saturating_sub(SHOWN);
            let more = if more > 0 { format!("\n  and {more} more") } else { String::new() };
            format!("{called:?} may be {} of the {what}:\n  {}{more}", several.len(), ids.join("\n  "))
        }
    };
    Err(ClientError::Unfit(words).into())
}
