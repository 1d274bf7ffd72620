//! Uploads of packages, however large.

use std::path::Path;
use std::sync::{Arc, Mutex};

use anyhow::{Context, bail};
use clap::Args;
use futures::TryStreamExt;
use reqwest::{Body, Method, StatusCode};
use tokio_util::io::ReaderStream;
use uuid::Uuid;

use super::answer::Answer;
use super::http::Client;
use super::job::Model;

/// Bytes that are read at once.
const PIECE: usize = 1 << 18;

/// Name, tags and notes for a model.
#[derive(Debug, Default, Args)]
pub(in crate::cli) struct UploadLabels {
    /// Name of the model [default: that of the package]
    #[arg(long)]
    name: Option<String>,
    /// Word to group by; may be given several times
    #[arg(long = "tag", value_name = "TAG")]
    tags: Vec<String>,
    /// Anything worth remembering
    #[arg(long)]
    notes: Option<String>,
}

impl UploadLabels {
    /// Whether any label is given.
    pub(in crate::cli) fn are_given(&self) -> bool {
        !self.query().is_empty()
    }

    fn query(&self) -> Vec<(&'static str, String)> {
        let tags = Some(self.tags.join(",")).filter(|tags| !tags.is_empty());
        let labels = [("name", self.name.clone()), ("tags", tags), ("notes", self.notes.clone())];
        labels.into_iter().filter_map(|(label, value)| Some((label, value?))).collect()
    }
}

impl Client {
    /// Uploads a package by `POST /v1/models`, piece by piece, so that it takes no memory. Returns the model, and whether it is new to the service.
    ///
    /// # Errors
    /// A file that cannot be read, or a [`ClientError`](super::ClientError).
    pub(in crate::cli) async fn upload(
        &self,
        package: &Path,
        labels: &UploadLabels,
    ) -> anyhow::Result<(Answer<Model>, bool)> {
        let key = Uuid::now_v7().to_string();
        let query = labels.query();
        let bar = Arc::new(Mutex::new(self.terminal.short_bar("upload")));
        let answer = self.patiently(|| async {
            let file = tokio::fs::File::open(package).await;
            let file = file.with_context(|| format!("cannot read {}", package.display()))?;
            let facts = file.metadata().await?;
            if facts.is_dir() {
                bail!("{} is a folder; a package is a zip file of what is in it", package.display());
            }
            let total = facts.len();
            let (mut sent, bar) = (0, Arc::clone(&bar));
            let pieces = ReaderStream::with_capacity(file, PIECE).inspect_ok(move |piece| {
                sent += piece.len() as u64;
                if let Ok(mut bar) = bar.lock() {
                    bar.show_bytes(sent, Some(total));
                }
            });
            let request = self.request(Method::POST, "/v1/models").query(&query);
            let request = request.header("content-type", "application/zip").header("idempotency-key", &key);
            self.read(request.header("content-length", total).body(Body::wrap_stream(pieces))).await
        });
        let (status, model) = answer.await?;
        Ok((model, status == StatusCode::CREATED))
    }
}
