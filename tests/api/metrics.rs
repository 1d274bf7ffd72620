//! Metrics for operators: numbers, readiness, versions.

use std::process::Command;

use rubmap::config::TransportConfig;
use sqlx::sqlite::{SqliteConnectOptions, SqliteConnection};
use sqlx::{ConnectOptions, Connection};

use super::app::{Api, PATIENCE, TestApp, sweep_of};
use super::model;

/// Reads all numbers, as Prometheus gets them.
async fn scrape(api: &Api) -> String {
    let answer = api.request("GET", "/metrics").send().await.unwrap();
    assert_eq!(answer.status(), 200);
    assert!(answer.headers()["content-type"].to_str().unwrap().starts_with("application/openmetrics-text"));
    answer.text().await.unwrap()
}

/// Reads the number called `name`, labels included.
pub(crate) async fn number(api: &Api, name: &str) -> f64 {
    find(&scrape(api).await, name)
}

fn find(metrics: &str, name: &str) -> f64 {
    let value = metrics.lines().find_map(|line| line.strip_prefix(name)?.strip_prefix(' '));
    value.unwrap_or_else(|| panic!("no {name} in\n{metrics}")).parse().unwrap()
}

#[tokio::test]
async fn requests_and_work_are_counted() {
    let app = TestApp::start().await;
    let api = &app.api;
    let before = scrape(api).await;
    assert_eq!(find(&before, "rubmap_speeds_finished_total"), 0.0);
    assert_eq!(find(&before, "rubmap_jobs_running"), 0.0);
    assert!(before.ends_with("# EOF\n"));
    let model = api.model(model::package(1.0)).await;
    let id = api.sweep(&sweep_of(&model)).await;
    api.finish(&id).await;
    for path in ["/v1/models/none", "/v1/models/neither", "/v1/nothing/at/all", "/v1/nothing"] {
        assert_eq!(api.get(path).await.status, 404);
    }
    let after = scrape(api).await;
    let requests = |labels: &str| find(&after, &format!("rubmap_http_requests_total{{{labels}}}"));
    assert_eq!(requests(r#"method="POST",route="/v1/sweeps",status="202""#), 1.0);
    assert_eq!(requests(r#"method="GET",route="/v1/models/{id}",status="404""#), 2.0);
    assert_eq!(requests(r#"method="GET",route="none",status="404""#), 2.0);
    let count = r#"rubmap_http_request_duration_seconds_count{method="POST",route="/v1/models"}"#;
    assert_eq!(find(&after, count), 1.0);
    assert_eq!(find(&after, "rubmap_speeds_finished_total"), 6.0);
    let points = api.get(&format!("/v1/jobs/{id}/interaction-map")).await.body;
    let steps = points["points"].as_array().unwrap().iter().map(|point| point["steps"].as_f64().unwrap());
    assert_eq!(find(&after, "rubmap_steps_total"), steps.sum::<f64>());
    for (name, least) in [
        ("rubmap_connections_open", 1.0),
        ("rubmap_connections_limit", 16.0),
        ("rubmap_open_files", 10.0),
        ("rubmap_open_files_limit", 100.0),
        ("rubmap_disk_free_bytes", 1.0),
        ("rubmap_workers", 2.0),
    ] {
        assert!(find(&after, name) >= least, "{name}\n{after}");
    }
    for name in
        ["rubmap_jobs_accepted", "rubmap_jobs_running", "rubmap_speeds_waiting", "rubmap_speeds_running"]
    {
        assert_eq!(find(&after, name), 0.0, "{name}");
    }
    app.stop().await;
}

#[tokio::test]
async fn a_service_that_is_ready_says_why() {
    let app = TestApp::start().await;
    let checks = app.api.get("/readyz").await.body["checks"].clone();
    let names: Vec<_> =
        checks.as_array().unwrap().iter().map(|check| check["name"].as_str().unwrap()).collect();
    assert_eq!(names, ["database", "disk", "files", "workers"]);
    app.stop().await;
}

#[tokio::test]
async fn a_full_disk_is_not_ready() {
    let app = TestApp::start_with(|config| {
        config.transport = TransportConfig { min_free_bytes: u64::MAX, ..TransportConfig::default() };
    })
    .await;
    let errors = app.api.get("/readyz").await.problem(503, "unavailable");
    assert_eq!(errors.len(), 1, "{errors:?}");
    assert!(errors[0]["detail"].as_str().unwrap().starts_with("disk: "), "{errors:?}");
    app.stop().await;
}

#[tokio::test]
async fn a_locked_database_is_alive_and_not_ready() {
    let app = TestApp::start().await;
    let file = SqliteConnectOptions::new().filename(app.data().join("rubmap.sqlite"));
    let mut other: SqliteConnection = file.connect().await.unwrap();
    sqlx::query("begin immediate").execute(&mut other).await.unwrap();
    let errors = app.api.get("/readyz").await.problem(503, "unavailable");
    assert!(errors[0]["detail"].as_str().unwrap().starts_with("database: "), "{errors:?}");
    assert_eq!(app.api.get("/healthz").await.status, 200);
    sqlx::query("rollback").execute(&mut other).await.unwrap();
    other.close().await.unwrap();
    let ready = async { while app.api.get("/readyz").await.status != 200 {} };
    tokio::time::timeout(PATIENCE, ready).await.expect("it stays unready");
    app.stop().await;
}

#[tokio::test]
async fn the_program_says_what_it_was_built_from() {
    let app = TestApp::start().await;
    let version = app.api.get("/v1/version").await.body;
    assert_eq!(version["version"], env!("CARGO_PKG_VERSION"));
    let said = Command::new(env!("CARGO_BIN_EXE_rubmap")).arg("--version").output().unwrap();
    let said = String::from_utf8(said.stdout).unwrap();
    let commit = version["commit"].as_str().unwrap();
    assert!(said.contains(env!("CARGO_PKG_VERSION")) && said.contains(commit), "{said}");
    assert!(said.contains(version["profile"].as_str().unwrap()), "{said}");

    let git = Command::new("git").args(["-C", env!("CARGO_MANIFEST_DIR"), "rev-parse", "HEAD"]).output();
    let in_repository = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join(".git").exists();
    match git {
        Ok(head) if in_repository && head.status.success() => {
            assert_eq!(commit, String::from_utf8(head.stdout).unwrap().trim());
        }
        _ => assert_eq!(commit, std::env::var("RUBMAP_COMMIT").unwrap_or("unknown".to_owned())),
    }
    app.stop().await;
}
