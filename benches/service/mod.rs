//! Service for one benchmark alone, with one model, asked over HTTP.

use std::time::Duration;

use anyhow::{Context, bail};
use reqwest::{Client, RequestBuilder};
use rubmap::app::App;
use rubmap::config::Config;
use rubmap::impeller::{ImpellerParameters, generate};
use serde_json::Value;
use tempfile::TempDir;
use tokio::task::JoinHandle;
use tokio_util::sync::CancellationToken;

/// Time between two looks at a job: at most a hundredth of the times to be measured, and next to nothing of the machine.
const POLLED: Duration = Duration::from_millis(5);

pub(crate) struct Service {
    client: Client,
    base: String,
    /// Id of the only model.
    pub(crate) model: Value,
    stop: CancellationToken,
    running: JoinHandle<()>,
    _folder: TempDir,
}

impl Service {
    /// Starts the service with so many workers and uploads the impeller.
    pub(crate) async fn start(workers: u16, impeller: &ImpellerParameters) -> anyhow::Result<Self> {
        let folder = tempfile::tempdir()?;
        let config = Config { workers: Some(workers), upload_bytes: 1 << 30, ..Config::local(folder.path()) };
        let app = App::build(config).await?;
        let (base, stop) = (format!("http://{}/v1", app.addr()), CancellationToken::new());
        let running = tokio::spawn(app.run_until_stopped(stop.clone()));
        let mut package = std::io::Cursor::new(Vec::new());
        rubmap::package::write(&generate(impeller)?, &mut package)?;
        let mut service =
            Self { client: Client::new(), base, model: Value::Null, stop, running, _folder: folder };
        let fill =
            |post: RequestBuilder| post.header("content-type", "application/zip").body(package.into_inner());
        service.model = service.send("models", fill).await?["id"].clone();
        Ok(service)
    }

    pub(crate) async fn stop(self) -> anyhow::Result<()> {
        self.stop.cancel();
        Ok(self.running.await?)
    }

    async fn send(
        &self,
        path: &str,
        fill: impl FnOnce(RequestBuilder) -> RequestBuilder,
    ) -> anyhow::Result<Value> {
        Ok(fill(self.client.post(format!("{}/{path}", self.base))).send().await?.json().await?)
    }

    /// Posts a request and returns the answer.
    pub(crate) async fn post(&self, path: &str, request: &Value) -> anyhow::Result<Value> {
        self.send(path, |post| post.json(request)).await
    }

    pub(crate) async fn get(&self, path: &str) -> anyhow::Result<Value> {
        Ok(self.client.get(format!("{}/{path}", self.base)).send().await?.json().await?)
    }

    /// Posts a job and waits for it; returns its path when it is done.
    pub(crate) async fn done(&self, kind: &str, request: &Value) -> anyhow::Result<String> {
        let posted = self.post(kind, request).await?;
        let path = format!("jobs/{}", posted["id"].as_str().context(posted.to_string())?);
        loop {
            let job = self.get(&path).await?;
            match job["status"].as_str() {
                Some("accepted" | "running") => tokio::time::sleep(POLLED).await,
                Some("successful") => return Ok(path),
                _ => bail!("{job}"),
            }
        }
    }

    /// Points of the map of the sweep at `path`.
    pub(crate) async fn points(&self, path: &str) -> anyhow::Result<Vec<Value>> {
        let map = self.get(&format!("{path}/interaction-map")).await?;
        Ok(map["points"].as_array().context("no points")?.clone())
    }
}
