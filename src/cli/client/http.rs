//! Client of a service: requests and answers.

use std::time::{Duration, Instant};

use backon::{ExponentialBuilder, Retryable};
use reqwest::{Method, RequestBuilder, Response, StatusCode};
use serde::Deserialize;
use serde::de::DeserializeOwned;
use serde_json::Value;
use uuid::Uuid;

use super::answer::Answer;
use super::error::ClientError;
use super::job::Job;
use crate::cli::terminal::Terminal;
use crate::store::status::JobStatus;

/// Time for a connection to be made, after which a server is taken to be away.
const CONNECT: Duration = Duration::from_secs(10);

/// Shortest and longest wait before a request is sent again.
const WAIT: [Duration; 2] = [Duration::from_millis(200), Duration::from_secs(3)];

/// Characters shown at most of an answer that is not understood.
const EXCERPT: usize = 200;

/// Entries asked for at most in one page of a list.
const PAGE: usize = 500;

/// Page of a list.
#[derive(Deserialize)]
struct Page<T> {
    #[serde(alias = "jobs", alias = "models")]
    entries: Vec<T>,
    next: Option<String>,
}

/// Client of one service.
#[derive(Debug)]
pub(in crate::cli) struct Client {
    /// Address of the service, without a slash at its end.
    pub(in crate::cli) server: String,
    http: reqwest::Client,
    token: Option<String>,
    /// Time for which a service that cannot be reached, or asks for patience, is asked again.
    patience: Duration,
    /// Terminal on which progress is reported.
    pub(in crate::cli) terminal: Terminal,
}

impl Client {
    /// Makes a client of the service at an address, without a slash at its end, with a bearer token if there is one.
    ///
    /// # Errors
    /// Settings of the environment (a proxy) that cannot be used.
    pub(in crate::cli) fn new(
        server: String,
        token: Option<String>,
        patience: Duration,
    ) -> anyhow::Result<Self> {
        let http = reqwest::Client::builder().connect_timeout(CONNECT).build()?;
        Ok(Self { server, http, token, patience, terminal: Terminal::default() })
    }

    /// Makes a client of a service in this process, which is asked once and by no proxy.
    ///
    /// # Errors
    /// As [`Client::new`].
    pub(in crate::cli) fn of_own_service(server: String) -> anyhow::Result<Self> {
        let http = reqwest::Client::builder().no_proxy().build()?;
        Ok(Self { server, http, token: None, patience: Duration::ZERO, terminal: Terminal::default() })
    }

    /// Sends GET and reads the answer.
    pub(in crate::cli) async fn get<T: DeserializeOwned>(&self, path: &str) -> anyhow::Result<T> {
        Ok(self.patiently(|| async { self.read(self.request(Method::GET, path)).await }).await?.1)
    }

    /// Sends POST and reads the answer. Sent again, the request does the same: the service repeats its answer to the same key.
    pub(in crate::cli) async fn post<T: DeserializeOwned>(
        &self,
        path: &str,
        body: &Value,
    ) -> anyhow::Result<T> {
        let key = Uuid::now_v7().to_string();
        let request = || self.request(Method::POST, path).header("idempotency-key", &key).json(body);
        Ok(self.patiently(|| async { self.read(request()).await }).await?.1)
    }

    /// Posts a job.
    pub(in crate::cli) async fn post_job(&self, path: &str, body: &Value) -> anyhow::Result<Answer<Job>> {
        self.post(path, body).await
    }

    /// Reads a job: `GET /v1/jobs/{id}`.
    pub(in crate::cli) async fn job(&self, id: &str) -> anyhow::Result<Answer<Job>> {
        self.get(&format!("/v1/jobs/{id}")).await
    }

    /// Cancels a job that has not ended; returns the job as it is then.
    ///
    /// # Errors
    /// [`ClientError`].
    pub(in crate::cli) async fn cancel(&self, id: &str) -> anyhow::Result<Answer<Job>> {
        let path = format!("/v1/jobs/{id}?cancel_only=true");
        self.patiently(|| async { Ok(self.read(self.request(Method::DELETE, &path)).await?.1) }).await
    }

    /// Pauses a job, or lets it go on; returns the job as it is then.
    ///
    /// # Errors
    /// [`ClientError`].
    pub(in crate::cli) async fn set_paused(&self, id: &str, paused: bool) -> anyhow::Result<Answer<Job>> {
        let path = format!("/v1/jobs/{id}/{}", if paused { "pause" } else { "continue" });
        self.patiently(|| async { Ok(self.read(self.request(Method::POST, &path)).await?.1) }).await
    }

    /// Sends DELETE.
    pub(in crate::cli) async fn delete(&self, path: &str) -> anyhow::Result<()> {
        self.patiently(|| async { self.send(self.request(Method::DELETE, path)).await.map(drop) }).await
    }

    /// Lists the first entries, `most` at most, of a list that comes in pages, and tells whether there are more. `query` ends with &
    /// if it is not empty.
    pub(in crate::cli) async fn list<T: DeserializeOwned>(
        &self,
        what: &str,
        query: &str,
        most: usize,
    ) -> anyhow::Result<(Vec<T>, bool)> {
        let mut path = format!("/v1/{what}?{query}limit={}", most.clamp(1, PAGE));
        let mut found = Vec::new();
        loop {
            let page: Page<T> = self.get(&path).await?;
            found.extend(page.entries);
            let more = page.next.is_some() || found.len() > most;
            match page.next {
                Some(next) if found.len() < most => path = next,
                _ => {
                    found.truncate(most);
                    return Ok((found, more));
                }
            }
        }
    }

    /// Cancels every job that has not ended.
    pub(in crate::cli) async fn cancel_unfinished_jobs(&self) -> anyhow::Result<()> {
        for status in [JobStatus::Accepted, JobStatus::Running, JobStatus::Paused] {
            let query = format!("status={}&", status.as_str());
            for job in self.list::<Job>("jobs", &query, usize::MAX).await?.0 {
                self.cancel(&job.id).await?;
            }
        }
        Ok(())
    }

    /// Begins a request, with the token.
    pub(super) fn request(&self, method: Method, path: &str) -> RequestBuilder {
        let request = self.http.request(method, format!("{}{path}", self.server));
        match &self.token {
            Some(token) => request.bearer_auth(token),
            None => request,
        }
    }

    /// Repeats `attempt` while the service cannot be reached or asks for patience, and says so once.
    pub(super) async fn patiently<T, F: Future<Output = anyhow::Result<T>>>(
        &self,
        attempt: impl FnMut() -> F,
    ) -> anyhow::Result<T> {
        let begin = Instant::now();
        let waits =
            ExponentialBuilder::default().with_min_delay(WAIT[0]).with_max_delay(WAIT[1]).without_max_times();
        let mut told = false;
        attempt
            .retry(waits)
            .when(|error| error.downcast_ref().is_some_and(ClientError::may_pass))
            .adjust(|error, wait| {
                let wanted = error.downcast_ref().and_then(ClientError::retry_after).or(wait)?;
                (begin.elapsed() + wanted <= self.patience).then_some(wanted)
            })
            .notify(|error, _| {
                if !std::mem::replace(&mut told, true) {
                    self.terminal.say(&format!("{error}; asking again for {} s", self.patience.as_secs()));
                }
            })
            .await
    }

    /// Sends a request; returns its status and its answer.
    pub(super) async fn read<T: DeserializeOwned>(
        &self,
        request: RequestBuilder,
    ) -> anyhow::Result<(StatusCode, T)> {
        let response = self.send(request).await?;
        let (url, status) = (response.url().to_string(), response.status());
        let body = response.bytes().await.map_err(|error| ClientError::unreachable(&self.server, &error))?;
        match serde_json::from_slice(&body) {
            Ok(answer) => Ok((status, answer)),
            Err(error) => Err(ClientError::Strange { url, status, cause: error.to_string() }.into()),
        }
    }

    /// Sends a request once; returns its response.
    ///
    /// # Errors
    /// [`ClientError`]: no response, or one that reports a problem.
    pub(super) async fn send(&self, request: RequestBuilder) -> anyhow::Result<Response> {
        let response = match request.send().await {
            Ok(response) => response,
            // The request cannot be one: its address or token has characters that none may have.
            Err(error) if error.is_builder() => return Err(error.into()),
            Err(error) => return Err(ClientError::unreachable(&self.server, &error).into()),
        };
        if response.status().is_success() {
            return Ok(response);
        }
        Err(self.refusal(response).await.into())
    }

    async fn refusal(&self, response: Response) -> ClientError {
        let (url, status) = (response.url().clone(), response.status());
        let text = match response.text().await {
            Ok(text) => text,
            Err(error) => return ClientError::unreachable(&self.server, &error),
        };
        let body: Value = serde_json::from_str(&text).unwrap_or_default();
        match Deserialize::deserialize(&body) {
            Ok(problem) => ClientError::Refused { path: url.path().to_owned(), status, problem, body },
            Err(_) => {
                let cause = text.trim().chars().take(EXCERPT).collect();
                ClientError::Strange { url: url.to_string(), status, cause }
            }
        }
    }
}
