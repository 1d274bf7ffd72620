//! Downloads, however large.

use std::io::{IsTerminal, Write};
use std::path::{Path, PathBuf};

use anyhow::{Context, bail};
use reqwest::{Method, Response, header};
use serde::de::DeserializeOwned;
use tempfile::NamedTempFile;

use super::error::ClientError;
use super::http::Client;
use crate::cli::stdout;
use crate::cli::terminal::Bar;

/// Media types that may be shown on a terminal, beside those of text.
const SHOWN: [&str; 2] = ["application/json", "image/svg+xml"];

/// Target of a download.
#[derive(Debug, Clone)]
pub(in crate::cli) enum Target {
    /// Standard output.
    Stdout,
    /// File, which is there when it is whole and not before.
    File(PathBuf),
}

/// Size of a body that was copied.
#[derive(Debug, Clone, Copy, Default)]
pub(in crate::cli) struct Copied {
    pub(in crate::cli) bytes: u64,
    /// Number of ends of lines.
    pub(in crate::cli) lines: u64,
}

impl Client {
    /// Downloads a result to a file, byte by byte as the service gave it, and reads it.
    ///
    /// # Errors
    /// As [`Client::save`], or a result that does not read as expected.
    pub(in crate::cli) async fn download<T: DeserializeOwned>(
        &self,
        path: &str,
        file: &Path,
    ) -> anyhow::Result<T> {
        self.save(path, file).await?;
        let body = std::fs::read(file).with_context(|| format!("cannot read {}", file.display()))?;
        serde_json::from_slice(&body).with_context(|| format!("cannot understand {path}"))
    }

    /// Downloads to a file.
    ///
    /// # Errors
    /// A [`ClientError`], or a file that cannot be written.
    pub(in crate::cli) async fn save(&self, path: &str, file: &Path) -> anyhow::Result<()> {
        let request = || self.request(Method::GET, path);
        self.patiently(|| async { self.write(self.send(request()).await?, file, None).await.map(drop) }).await
    }

    /// Downloads the resource at `path` with `query`; returns its size.
    ///
    /// # Errors
    /// As [`Client::save`]; or binary data that no terminal shows.
    pub(in crate::cli) async fn get_to(
        &self,
        path: &str,
        query: &[(String, String)],
        target: &Target,
    ) -> anyhow::Result<Copied> {
        let request = || self.request(Method::GET, path).query(query);
        match target {
            Target::Stdout => {
                let response = self.patiently(|| async { self.send(request()).await }).await?;
                if std::io::stdout().is_terminal() && !is_text(&response) {
                    bail!("what it would print is no text: give it a file with -o");
                }
                self.copy(response, std::io::stdout(), stdout::failed, None).await
            }
            // A download that broke off begins again.
            Target::File(file) => {
                let attempt = || async {
                    let bar = self.terminal.short_bar("download");
                    self.write(self.send(request()).await?, file, Some(bar)).await
                };
                self.patiently(attempt).await
            }
        }
    }

    async fn write(&self, response: Response, file: &Path, bar: Option<Bar>) -> anyhow::Result<Copied> {
        let failed = || format!("cannot write {}", file.display());
        let refused = |error: std::io::Error| anyhow::Error::new(error).context(failed());
        let (exists, is_file) = match file.metadata() {
            Ok(facts) if facts.is_dir() => bail!("cannot write {}: it is a folder", file.display()),
            Ok(facts) => (true, facts.is_file()),
            Err(_) => (false, true),
        };
        if !is_file {
            // A pipe or a device is written in place: no file could take its place.
            let out = std::fs::OpenOptions::new().write(true).open(file).with_context(failed)?;
            return self.copy(response, out, refused, bar).await;
        }
        // A link stays, and the file to which it leads is replaced.
        let place = if exists { file.canonicalize().with_context(failed)? } else { file.to_owned() };
        let folder = place.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let part = new_file(folder).with_context(failed)?;
        let copied = self.copy(response, part.as_file(), refused, bar).await?;
        part.persist(&place).map_err(|error| refused(error.error))?;
        Ok(copied)
    }

    /// Copies a body; returns its size.
    async fn copy(
        &self,
        mut response: Response,
        mut out: impl Write,
        refused: impl Fn(std::io::Error) -> anyhow::Error,
        mut bar: Option<Bar>,
    ) -> anyhow::Result<Copied> {
        let (mut copied, total) = (Copied::default(), response.content_length());
        loop {
            let piece = response.chunk().await;
            let Some(piece) = piece.map_err(|error| ClientError::unreachable(&self.server, &error))? else {
                out.flush().map_err(&refused)?;
                return Ok(copied);
            };
            out.write_all(&piece).map_err(&refused)?;
            copied.bytes += piece.len() as u64;
            copied.lines += piece.iter().filter(|byte| **byte == b'\n').count() as u64;
            if let Some(bar) = &mut bar {
                bar.show_bytes(copied.bytes, total);
            }
        }
    }
}

/// Makes a temporary file, readable as other files that are made in the folder.
pub(in crate::cli) fn new_file(folder: &Path) -> std::io::Result<NamedTempFile> {
    use std::os::unix::fs::PermissionsExt;
    let mut builder = tempfile::Builder::new();
    builder.prefix(".rubmap-").permissions(std::fs::Permissions::from_mode(0o666)).tempfile_in(folder)
}

fn is_text(response: &Response) -> bool {
    let kind = response.headers().get(header::CONTENT_TYPE).and_then(|kind| kind.to_str().ok());
    let kind = kind.unwrap_or_default().split(';').next().unwrap_or_default();
    kind.starts_with("text/") || SHOWN.contains(&kind)
}
