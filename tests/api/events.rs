//! Jobs followed by server-sent events.

use std::time::{Duration, Instant};

use reqwest::Response;
use rubmap::config::TransportConfig;
use serde_json::{Value, json};
use sqlx::sqlite::SqliteConnectOptions;
use sqlx::{ConnectOptions, Connection};
use tokio::time::timeout;

use super::app::{Api, PATIENCE, TestApp, long_sweep_of, sweep_of};
use super::model;

/// Least time between two events of a job.
const BETWEEN: Duration = Duration::from_millis(300);

/// Stream of events as they come.
struct Events {
    response: Response,
    heard: String,
}

impl Events {
    async fn of(api: &Api, id: &str) -> Self {
        let response = api.request("GET", &format!("/v1/jobs/{id}/events")).send().await.unwrap();
        assert_eq!(response.status(), 200);
        let header = |name| response.headers()[name].to_str().unwrap().to_owned();
        assert_eq!([header("content-type"), header("cache-control")], ["text/event-stream", "no-cache"]);
        Self { response, heard: String::new() }
    }

    /// Reads the data of the next event; `None` at the end of the stream.
    async fn next(&mut self) -> Option<String> {
        loop {
            if let Some((event, rest)) = self.heard.split_once("\n\n") {
                let (event, rest) = (event.to_owned(), rest.to_owned());
                self.heard = rest;
                if event.starts_with(':') {
                    continue;
                }
                let data = event.strip_prefix("event: job\ndata: ").unwrap_or_else(|| panic!("{event}"));
                assert!(!data.contains('\n'));
                return Some(data.to_owned());
            }
            let piece = timeout(PATIENCE, self.response.chunk()).await.expect("nothing comes").unwrap();
            match piece {
                Some(piece) => self.heard.push_str(std::str::from_utf8(&piece).unwrap()),
                None => {
                    assert_eq!(self.heard, "", "broken off within an event");
                    return None;
                }
            }
        }
    }

    /// Waits for the first job that is reported and passes `wanted`.
    async fn until(&mut self, wanted: impl Fn(&Value) -> bool) -> Value {
        loop {
            let job = serde_json::from_str(&self.next().await.expect("the stream ends")).unwrap();
            if wanted(&job) {
                return job;
            }
        }
    }
}

async fn text(api: &Api, id: &str) -> String {
    api.request("GET", &format!("/v1/jobs/{id}")).send().await.unwrap().text().await.unwrap()
}

#[tokio::test]
async fn a_sweep_is_followed_from_its_beginning_to_its_end() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let begin = Instant::now();
    let id = api.sweep(&long_sweep_of(&model, 30)).await;
    let mut follower = Events::of(api, &id).await;
    let mut events = Vec::new();
    while let Some(event) = follower.next().await {
        events.push(event);
    }
    let mut said: Value = serde_json::from_str(&text(api, &id).await).unwrap();
    let fields = said.as_object_mut().unwrap();
    assert!(fields.remove("posted").is_some() && fields.remove("posted_to").is_some());
    let last: Value = serde_json::from_str(events.last().unwrap()).unwrap();
    assert_eq!(last, said, "not what GET says, but for the posted request");
    let most = begin.elapsed().as_secs_f64() / BETWEEN.as_secs_f64() + 1.0;
    assert!(events.len() as f64 <= most, "{} events where {most:.1} are the most", events.len());
    let jobs: Vec<Value> = events.iter().map(|event| serde_json::from_str(event).unwrap()).collect();
    let numbers = |pointer| jobs.iter().map(move |job| job.pointer(pointer).unwrap().as_u64().unwrap());
    assert!(numbers("/progress").is_sorted() && numbers("/speeds/finished").is_sorted());
    assert!(events.windows(2).all(|pair| pair[0] != pair[1]), "an event without a change");
    let told = |wanted: &str| jobs.iter().filter(|job| job["status"] == wanted).count();
    assert!(told("running") >= 2 && told("successful") == 1, "{jobs:?}");

    // A late listener hears how the job ended.
    let mut late = Events::of(api, &id).await;
    assert_eq!(late.next().await.as_ref(), events.last());
    assert_eq!(late.next().await, None);
    assert_eq!(api.delete(&format!("/v1/jobs/{id}")).await.status, 204);
    api.get(&format!("/v1/jobs/{id}/events")).await.problem(404, "job-not-found");
    app.stop().await;
}

#[tokio::test]
async fn all_who_follow_a_job_hear_the_same() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let id = api.sweep(&long_sweep_of(&model, 500)).await;
    let mut first = Events::of(api, &id).await;
    first.until(|job| job["speeds"]["finished"].as_u64() >= Some(1)).await;
    let mut others = Vec::new();
    for _ in 0..3 {
        others.push(Events::of(api, &id).await);
    }
    for other in &mut others {
        // The first event reports at once what is known already.
        other.until(|job| job["speeds"]["finished"].as_u64() >= Some(1)).await;
    }
    // Some listeners leave; a new name and the end reach all others.
    others.pop();
    let named = api.request("PATCH", &format!("/v1/jobs/{id}")).json(&json!({"name": "followed"}));
    assert_eq!(named.send().await.unwrap().status(), 200);
    for follower in [&mut first].into_iter().chain(&mut others) {
        follower.until(|job| job["name"] == "followed").await;
    }
    assert_eq!(api.delete(&format!("/v1/jobs/{id}")).await.text("/status"), "dismissed");
    for follower in [&mut first].into_iter().chain(&mut others) {
        follower.until(|job| job["status"] == "dismissed").await;
        assert_eq!(follower.next().await, None);
    }
    app.stop().await;
}

/// Reports what a job waits for. Nothing of it is in the database, which takes nothing.
#[tokio::test]
async fn what_a_job_waits_for_is_told() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let id = api.sweep(&long_sweep_of(&model, 12)).await;
    let mut follower = Events::of(api, &id).await;
    follower.until(|job| job["speeds"]["finished"].as_u64() >= Some(1)).await;
    let database = SqliteConnectOptions::new().filename(app.data().join("rubmap.sqlite"));
    let mut other = database.connect().await.unwrap();
    sqlx::query("begin exclusive").execute(&mut other).await.unwrap();
    let waits = |job: &Value| job["phase"].as_str().is_some_and(|phase| phase.starts_with("waiting for"));
    follower.until(waits).await;
    sqlx::query("rollback").execute(&mut other).await.unwrap();
    other.close().await.unwrap();
    follower.until(|job| job["status"] == "successful").await;
    app.stop().await;
}

#[tokio::test]
async fn a_stop_is_not_held_up_and_the_job_is_followed_again_afterwards() {
    let data = tempfile::tempdir().unwrap();
    let app = TestApp::start_on(data.path()).await;
    let model = app.api.model(model::package(1.0)).await;
    let id = app.api.sweep(&long_sweep_of(&model, 12)).await;
    let mut follower = Events::of(&app.api, &id).await;
    follower.until(|job| job["speeds"]["finished"].as_u64() >= Some(1)).await;
    let hear = async { while follower.next().await.is_some() {} };
    // A stream that is cut would be an error here.
    tokio::join!(hear, app.stop());

    let app = TestApp::start_on(data.path()).await;
    let mut follower = Events::of(&app.api, &id).await;
    let first = follower.until(|_| true).await;
    assert!(["accepted", "running"].contains(&first["status"].as_str().unwrap()), "{first}");
    assert!(first["speeds"]["finished"].as_u64() >= Some(1), "{first}");
    follower.until(|job| job["status"] == "successful").await;
    app.stop().await;
}

#[tokio::test]
async fn followers_leave_room_for_others() {
    let transport = TransportConfig { connections: 16, ..TransportConfig::default() };
    let app = TestApp::start_with(|config| config.transport = transport).await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let id = api.sweep(&long_sweep_of(&model, 5000)).await;
    let mut followers = Vec::new();
    for _ in 0..16 {
        // Each follower has a connection of its own.
        followers.push(Events::of(&Api::new(api.base()), &id).await);
    }
    let answer = timeout(PATIENCE, Api::new(api.base()).get("/readyz")).await.expect("nobody else is served");
    assert_eq!(answer.status, 200);
    api.delete(&format!("/v1/jobs/{id}")).await;
    let quick = api.sweep(&sweep_of(&model)).await;
    assert_eq!(api.finish(&quick).await["status"], "successful");
    app.stop().await;
}
