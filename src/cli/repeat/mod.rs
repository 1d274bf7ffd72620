//! `rubmap repeat`: computes the job of an archive again and compares the results.

mod archive;
mod compare;

use std::fs::File;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context, bail};
use clap::Args;
use serde_json::Value;

use self::archive::Archive;
use self::compare::{Comparison, compare};
use super::client::Client;
use super::progress;
use super::session::{Session, upload};
use crate::analysis::run::{REVISION, vectors};
use crate::cli::stdout::narrate;
use crate::http::archive::manifest::{COMPARED_PACKAGE, PACKAGE, REQUEST};

/// Results at most whose differences are shown.
const SHOWN: usize = 10;

/// Archive to repeat.
#[derive(Debug, Args)]
pub(super) struct RepeatArgs {
    /// Archive of a job: GET /v1/jobs/{id}/archive
    archive: PathBuf,
    /// Threads that compute [default: one per core]
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=1024))]
    workers: Option<u16>,
}

/// Checks an archive, computes its job again in a service of its own, and compares. The exit code says whether all is the same.
///
/// # Errors
/// A file that is no archive, or a job that cannot be computed again.
pub(super) fn run(args: &RepeatArgs) -> anyhow::Result<ExitCode> {
    let archived = Archive::open(&args.archive)?;
    let wrong = archived.wrong()?;
    if !wrong.is_empty() {
        narrate(&format!("{} is not as it was written:", args.archive.display()))?;
        wrong.iter().take(SHOWN).try_for_each(|wrong| narrate(&format!("  {wrong}")))?;
        if wrong.len() > SHOWN {
            narrate(&format!("  and {} more", wrong.len() - SHOWN))?;
        }
        return Ok(ExitCode::FAILURE);
    }
    let job = &archived.manifest.job;
    narrate(&format!(
        "archive   {}: {} {}, as it was written",
        args.archive.display(),
        job.kind.name,
        job.id
    ))?;

    let folder = tempfile::tempdir().context("cannot make a temporary folder")?;
    let repeated = folder.path().join("repeated.zip");
    let mut found = None;
    let session = Session::begin(folder.path())?;
    let code = session.run(args.workers, async |client| {
        repeat(&archived, client, folder.path(), &repeated).await?;
        let comparison = compare(&archived, &Archive::open(&repeated)?)?;
        tell(&archived, &comparison)?;
        found = Some(comparison.different.is_empty());
        Ok(())
    })?;
    Ok(if found == Some(false) { ExitCode::FAILURE } else { code })
}

/// Posts the archived request to a service once more, and downloads an archive of its results.
async fn repeat(archived: &Archive, client: &Client, folder: &Path, to: &Path) -> anyhow::Result<()> {
    let request: Value = archived.json(REQUEST)?;
    let job = &archived.manifest.job;
    if !job.posted_to.is_empty() && job.posted_to != job.kind.route {
        bail!(
            "its request was posted to {}, a sweep that the archive does not have: repeat the sweep, with `record` for the histories",
            job.posted_to
        );
    }
    for (name, field) in [(PACKAGE, "model"), (COMPARED_PACKAGE, "compared_model")] {
        if request[field].is_null() {
            continue;
        }
        let package = folder.join(name);
        let mut file =
            File::create(&package).with_context(|| format!("cannot write {}", package.display()))?;
        archived.extract(name, &mut file)?;
        let model = upload(client, &package).await?;
        if request[field] != model.id.as_str() {
            bail!("the archive's request is about another model than its {name}");
        }
    }
    let job = client.post_job(job.kind.route, &request).await?;
    let job = progress::follow(client, &job, "once more").await?;
    client.save(job.link("archive")?, to).await
}

/// Prints the outcome of a comparison, and what may be behind a difference.
fn tell(archived: &Archive, comparison: &Comparison) -> anyhow::Result<()> {
    let Comparison { same, different } = comparison;
    if different.is_empty() {
        return narrate(&format!("\nidentical: all {same} results to the bit; times are not compared"));
    }
    narrate(&format!("\ndifferent: {} of {} results", different.len(), same + different.len()))?;
    different.iter().take(SHOWN).try_for_each(|words| narrate(&format!("  {words}")))?;
    if different.len() > SHOWN {
        narrate(&format!("  and {} more", different.len() - SHOWN))?;
    }
    let computed = &archived.manifest.computed;
    let (kind, here) = (computed.vectors.as_deref().unwrap_or("an unknown kind"), vectors());
    if computed.revision != REVISION {
        narrate(&format!(
            "The archive is of revision {} of the numerics, this program of {REVISION}: other numbers are expected.",
            computed.revision
        ))?;
    } else if kind != here {
        narrate(&format!(
            "The archive was computed on a processor with vectors of {kind}, this one has {here}: another kind adds up in \
             another order, and last digits may differ, of chaotic responses all."
        ))?;
    } else {
        narrate(&format!("Numerics and kind of vectors ({here}) are the same: this should not be."))?;
    }
    Ok(())
}
