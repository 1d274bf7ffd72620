//! The user's side of the HTTP contract: nothing that curl could not do.

use std::path::Path;

use crate::store::status::JobStatus;
use anyhow::{Context, bail};
use reqwest::{Method, RequestBuilder, Response, StatusCode};
use serde::Deserialize;
use serde::de::DeserializeOwned;
use serde_json::Value;
use tokio::io::AsyncWriteExt;

/// A client of one service.
#[derive(Debug)]
pub(in crate::cli) struct Client {
    base: String,
    http: reqwest::Client,
    token: Option<String>,
}

/// An uploaded model.
#[derive(Debug)]
pub(in crate::cli) struct Model {
    pub(in crate::cli) id: String,
    /// Whether the service saw it for the first time.
    pub(in crate::cli) new: bool,
}

/// A job as the service shows it.
#[derive(Debug, Deserialize)]
pub(in crate::cli) struct Job {
    pub(in crate::cli) id: String,
    pub(in crate::cli) status: JobStatus,
    #[serde(default)]
    pub(in crate::cli) progress: u64,
    #[serde(default)]
    pub(in crate::cli) phase: String,
    #[serde(default)]
    pub(in crate::cli) speeds: SpeedCounts,
    error: Option<Problem>,
    links: Vec<Link>,
}

/// Speeds of a job.
#[derive(Debug, Default, Deserialize)]
pub(in crate::cli) struct SpeedCounts {
    pub(in crate::cli) total: u32,
    pub(in crate::cli) finished: u32,
}

/// What went wrong (RFC 9457), as far as it is shown.
#[derive(Debug, Deserialize)]
struct Problem {
    title: String,
    detail: String,
    #[serde(default)]
    errors: Vec<ProblemItem>,
}

#[derive(Debug, Deserialize)]
struct ProblemItem {
    pointer: Option<String>,
    parameter: Option<String>,
    file: Option<String>,
    detail: String,
}

#[derive(Debug, Deserialize)]
struct Link {
    rel: String,
    href: String,
}

impl Job {
    /// Path of a result.
    pub(in crate::cli) fn link(&self, rel: &str) -> anyhow::Result<&str> {
        let link = self.links.iter().find(|link| link.rel == rel);
        link.map(|link| link.href.as_str()).with_context(|| format!("job {} links to no {rel}", self.id))
    }

    /// The job, if it ended well.
    pub(in crate::cli) fn successful(self) -> anyhow::Result<Self> {
        match (self.status, &self.error) {
            (JobStatus::Successful, _) => Ok(self),
            (_, Some(problem)) => bail!("job {}: {}", self.id, words(problem)),
            (status, None) => bail!("job {} is {}", self.id, status.as_str()),
        }
    }
}

impl Client {
    pub(in crate::cli) fn new(base: String) -> Self {
        Self { base, http: reqwest::Client::new(), token: None }
    }

    /// With a bearer token, if there is one.
    pub(in crate::cli) fn with_token(self, token: Option<String>) -> Self {
        Self { token, ..self }
    }

    /// `POST /v1/models`.
    pub(in crate::cli) async fn upload(&self, package: &Path) -> anyhow::Result<Model> {
        #[derive(Deserialize)]
        struct Body {
            id: String,
        }
        let content =
            tokio::fs::read(package).await.with_context(|| format!("cannot read {}", package.display()))?;
        let request = self.request(Method::POST, "/v1/models").header("content-type", "application/zip");
        let response = send(request.body(content)).await?;
        let new = response.status() == StatusCode::CREATED;
        let Body { id } = response.json().await?;
        Ok(Model { id, new })
    }

    /// Posts a job.
    pub(in crate::cli) async fn post_job(&self, path: &str, request: &Value) -> anyhow::Result<Job> {
        self.post(path, request).await
    }

    /// The answer to a POST.
    pub(in crate::cli) async fn post<T: DeserializeOwned>(
        &self,
        path: &str,
        request: &Value,
    ) -> anyhow::Result<T> {
        Ok(send(self.request(Method::POST, path).json(request)).await?.json().await?)
    }

    /// The answer to a GET.
    pub(in crate::cli) async fn get<T: DeserializeOwned>(&self, path: &str) -> anyhow::Result<T> {
        Ok(send(self.request(Method::GET, path)).await?.json().await?)
    }

    /// `GET /v1/jobs/{id}`.
    pub(in crate::cli) async fn job(&self, id: &str) -> anyhow::Result<Job> {
        self.get(&format!("/v1/jobs/{id}")).await
    }

    /// Downloads a result to a file, byte by byte as the service gave it, and reads it.
    pub(in crate::cli) async fn download<T: DeserializeOwned>(
        &self,
        path: &str,
        file: &Path,
    ) -> anyhow::Result<T> {
        let body = send(self.request(Method::GET, path)).await?.bytes().await?;
        tokio::fs::write(file, &body).await.with_context(|| format!("cannot write {}", file.display()))?;
        serde_json::from_slice(&body).with_context(|| format!("cannot understand {path}"))
    }

    /// Saves a download of any size in a file.
    pub(in crate::cli) async fn save(&self, path: &str, file: &Path) -> anyhow::Result<()> {
        let mut response = send(self.request(Method::GET, path)).await?;
        let failed = || format!("cannot write {}", file.display());
        let mut out = tokio::fs::File::create(file).await.with_context(failed)?;
        while let Some(piece) = response.chunk().await? {
            out.write_all(&piece).await.with_context(failed)?;
        }
        out.flush().await.with_context(failed)
    }

    /// Cancels every job that has not ended.
    pub(in crate::cli) async fn cancel_unfinished_jobs(&self) -> anyhow::Result<()> {
        #[derive(Deserialize)]
        struct Page {
            jobs: Vec<Job>,
        }
        for status in [JobStatus::Accepted, JobStatus::Running] {
            let path = format!("/v1/jobs?limit=500&status={}", status.as_str());
            let page: Page = self.get(&path).await?;
            for job in page.jobs {
                let response = self.request(Method::DELETE, &format!("/v1/jobs/{}", job.id)).send().await?;
                // Between list and cancellation it may have ended by itself.
                if response.status() != StatusCode::CONFLICT {
                    accept(response).await?;
                }
            }
        }
        Ok(())
    }

    fn request(&self, method: Method, path: &str) -> RequestBuilder {
        let request = self.http.request(method, format!("{}{path}", self.base));
        match &self.token {
            Some(token) => request.bearer_auth(token),
            None => request,
        }
    }
}

async fn send(request: RequestBuilder) -> anyhow::Result<Response> {
    accept(request.send().await?).await
}

/// The response, or the problem it reports.
async fn accept(response: Response) -> anyhow::Result<Response> {
    let status = response.status();
    if status.is_success() {
        return Ok(response);
    }
    let path = response.url().path().to_owned();
    let body = response.text().await?;
    match serde_json::from_str(&body) {
        Ok(problem) => bail!("{path}: {status}: {}", words(&problem)),
        Err(_) => bail!("{path}: {status}: {body}"),
    }
}

/// A problem in one text: what it is about, and all its items as a list; where it has none, its detail.
fn words(problem: &Problem) -> String {
    let items = problem.errors.iter().map(|item| {
        // What is said of a file begins with its place.
        let place = item.pointer.as_deref().or(item.parameter.as_deref()).filter(|_| item.file.is_none());
        format!("\n  {}{}", place.map(|place| format!("{place}: ")).unwrap_or_default(), item.detail)
    });
    if problem.errors.is_empty() {
        return problem.detail.clone();
    }
    format!("{}{}", problem.title, items.collect::<String>())
}
