//! The service under test, in this process, with words for what tests do to it.

#[cfg(feature = "cluster")]
#[path = "servers.rs"]
pub(crate) mod servers;

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use reqwest::{Client, Response, StatusCode};
use rubmap::app::App;
use rubmap::config::Config;
use serde_json::{Value, json};
use tempfile::TempDir;
use tokio::task::JoinHandle;
use tokio_util::sync::CancellationToken;

/// Longest time to wait: longer than anything here takes on a loaded machine.
pub(crate) const PATIENCE: Duration = Duration::from_secs(300);

/// Running service in this process.
pub(crate) struct TestApp {
    pub(crate) api: Api,
    stop: CancellationToken,
    service: JoinHandle<()>,
    data: PathBuf,
    /// Data folder, removed with the app that made it.
    _folder: Option<TempDir>,
}

impl TestApp {
    pub(crate) async fn start() -> Self {
        Self::start_with(|_| {}).await
    }

    /// Starts a service with settings changed by `change`.
    pub(crate) async fn start_with(change: impl FnOnce(&mut Config)) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let mut config = config(folder.path());
        change(&mut config);
        Self { _folder: Some(folder), ..Self::run(config).await }
    }

    /// Starts a service on a data folder that outlives it.
    pub(crate) async fn start_on(data: &Path) -> Self {
        Self::run(config(data)).await
    }

    #[cfg_attr(not(feature = "cluster"), expect(unused_mut, reason = "there are no servers"))]
    async fn run(mut config: Config) -> Self {
        #[cfg(feature = "cluster")]
        servers::share(&mut config);
        let data = config.data.clone();
        let app = App::build(config).await.unwrap();
        let api = Api::new(&format!("http://{}", app.addr()));
        let stop = CancellationToken::new();
        let service = tokio::spawn(app.run_until_stopped(stop.clone()));
        Self { api, stop, service, data, _folder: None }
    }

    pub(crate) async fn stop(self) {
        self.stop.cancel();
        self.service.await.unwrap();
    }

    pub(crate) fn data(&self) -> &Path {
        &self.data
    }
}

pub(crate) fn config(data: &Path) -> Config {
    Config { workers: Some(2), upload_bytes: 1 << 20, ..Config::local(data) }
}

/// Client of the service.
#[derive(Clone)]
pub(crate) struct Api {
    base: String,
    client: Client,
}

impl Api {
    pub(crate) fn new(base: &str) -> Self {
        Self { base: base.to_owned(), client: Client::new() }
    }

    pub(crate) fn base(&self) -> &str {
        &self.base
    }

    pub(crate) fn request(&self, method: &str, path: &str) -> reqwest::RequestBuilder {
        self.client.request(method.parse().unwrap(), format!("{}{path}", self.base))
    }

    pub(crate) async fn get(&self, path: &str) -> Answer {
        Answer::of(self.request("GET", path).send().await.unwrap()).await
    }

    pub(crate) async fn delete(&self, path: &str) -> Answer {
        Answer::of(self.request("DELETE", path).send().await.unwrap()).await
    }

    pub(crate) async fn post(&self, path: &str, body: &Value) -> Answer {
        Answer::of(self.request("POST", path).json(body).send().await.unwrap()).await
    }

    pub(crate) async fn upload(&self, package: Vec<u8>) -> Answer {
        let request =
            self.request("POST", "/v1/models").header("content-type", "application/zip").body(package);
        Answer::of(request.send().await.unwrap()).await
    }

    /// Uploads a package that must be fine; returns its id.
    pub(crate) async fn model(&self, package: Vec<u8>) -> String {
        let answer = self.upload(package).await;
        assert!(answer.status.is_success(), "{}", answer.body);
        answer.text("/id")
    }

    /// Posts a sweep that must be fine; returns its id.
    pub(crate) async fn sweep(&self, request: &Value) -> String {
        let answer = self.post("/v1/sweeps", request).await;
        assert_eq!(answer.status, 202, "{}", answer.body);
        answer.text("/id")
    }

    pub(crate) async fn job(&self, id: &str) -> Answer {
        let answer = self.get(&format!("/v1/jobs/{id}")).await;
        assert_eq!(answer.status, 200, "{}", answer.body);
        answer
    }

    /// Follows a job until `enough`.
    pub(crate) async fn follow(&self, id: &str, enough: impl Fn(&Value) -> bool) -> Value {
        let begin = Instant::now();
        let mut progress = 0;
        loop {
            let job = self.job(id).await.body;
            let now = job["progress"].as_u64().unwrap();
            assert!(now >= progress, "progress fell from {progress} to {now}");
            progress = now;
            if enough(&job) {
                return job;
            }
            assert!(begin.elapsed() < PATIENCE, "still waiting: {job}");
            tokio::time::sleep(Duration::from_millis(15)).await;
        }
    }

    /// Follows a job to its end.
    pub(crate) async fn finish(&self, id: &str) -> Value {
        self.follow(id, |job| !["accepted", "running"].contains(&job["status"].as_str().unwrap())).await
    }
}

/// Answer of the service.
pub(crate) struct Answer {
    pub(crate) status: StatusCode,
    pub(crate) location: Option<String>,
    pub(crate) media_type: String,
    /// Body in JSON; null if there is none.
    pub(crate) body: Value,
}

impl Answer {
    pub(crate) async fn of(response: Response) -> Self {
        let header = |name| {
            response
                .headers()
                .get(name)
                .map(|value: &_| String::from_utf8_lossy(value.as_bytes()).into_owned())
        };
        let (status, location) = (response.status(), header("location"));
        let media_type = header("content-type").unwrap_or_default();
        let body = response.bytes().await.unwrap();
        let body = if body.is_empty() { Value::Null } else { serde_json::from_slice(&body).unwrap() };
        Self { status, location, media_type, body }
    }

    pub(crate) fn text(&self, pointer: &str) -> String {
        self.body
            .pointer(pointer)
            .and_then(Value::as_str)
            .unwrap_or_else(|| panic!("{}", self.body))
            .to_owned()
    }

    /// Asserts that this is a problem of `kind` with `status`; returns its items.
    #[track_caller]
    pub(crate) fn problem(&self, status: u16, kind: &str) -> Vec<Value> {
        assert_eq!(self.status, status, "{}", self.body);
        assert_eq!(self.media_type, "application/problem+json");
        assert_eq!(self.body["type"], format!("urn:rubmap:problem:{kind}"), "{}", self.body);
        assert_eq!(self.body["status"], status);
        assert!(self.body["title"].is_string() && self.body["detail"].is_string());
        assert!(self.body["instance"].as_str().unwrap().starts_with('/'));
        self.body["errors"].as_array().cloned().unwrap_or_default()
    }

    /// Asserts that this is a problem of `kind` with `status`, like [`Answer::problem`]; returns the pointers of its items.
    #[track_caller]
    pub(crate) fn pointers(&self, status: u16, kind: &str) -> Vec<String> {
        let items = self.problem(status, kind);
        items.iter().map(|item| item["pointer"].as_str().unwrap().to_owned()).collect()
    }
}

/// Request for a short sweep with contact.
pub(crate) fn sweep_of(model: &str) -> Value {
    json!({
        "model": model,
        "modes_per_speed": 3,
        "speeds": {"from": 300.0, "to": 900.0, "count": 6, "unit": "rad_s"},
        "scene": {
            "damping": {"modal_ratio": 0.02},
            "casing": {
                "clearance": {"leading": 0.30, "trailing": 0.25},
                "lobes": {"count": 2, "amplitude": 0.4, "width_rad": 0.35},
            },
            "contact": {},
        },
        "integration": {"steps_per_revolution": "auto", "revolutions": 12, "ramp_revolutions": 1.0,
            "window_revolutions": 4},
        "max_engine_order": 8,
    })
}

/// Request for a sweep whose speeds take so long that a test can do something meanwhile.
pub(crate) fn long_sweep_of(model: &str, speeds: u32) -> Value {
    let mut request = sweep_of(model);
    request["speeds"]["count"] = speeds.into();
    request["integration"]["revolutions"] = 500.into();
    request
}

pub(crate) fn modal_analysis_of(model: &str) -> Value {
    json!({
        "model": model,
        "modes_per_speed": 3,
        "families": 2,
        "superharmonics": [1, 2, 3],
        "lobes": 2,
        "speeds": {"from": 0.0, "to": 900.0, "count": 7, "unit": "rad_s"},
    })
}
