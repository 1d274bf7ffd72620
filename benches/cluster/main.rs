//! Cost of sharing work, and how far it goes: `cargo bench --features cluster --bench cluster [-- PART …]`, with the parts `speeds`,
//! `workers`, `claims`, `stored`. One service, workers and a PostgreSQL server of its own on this machine; skipped where there is no
//! PostgreSQL. Run it on an otherwise idle machine of two processors or more.

#[path = "../../tests/api/app.rs"]
#[expect(dead_code, reason = "shared with tests that need more of it")]
mod app;
mod claims;
#[path = "../../tests/api/model.rs"]
#[expect(dead_code, reason = "shared with tests that need more of it")]
mod model;
#[path = "../../tests/cluster/postgres.rs"]
mod postgres;
#[path = "../../tests/api/program.rs"]
#[expect(dead_code, reason = "shared with tests that need more of it")]
mod program;
mod stored;

use std::path::Path;
use std::process::Command;
use std::time::{Duration, Instant};

use serde_json::{Value, json};

use self::app::Api;
use self::postgres::Postgres;
use self::program::Program;

/// Longest time for a sweep.
const PATIENCE: Duration = Duration::from_secs(600);

/// Time between two looks at a job; each takes some of the time of the two processors.
const BETWEEN_LOOKS: Duration = Duration::from_millis(50);

/// Number of times that each measurement is made, by turns with the one that it is compared with; the fastest counts.
const TIMES: usize = 3;

#[tokio::main]
async fn main() {
    let asked: Vec<String> = std::env::args().skip(1).filter(|argument| !argument.starts_with('-')).collect();
    let wanted = |part: &str| asked.is_empty() || asked.iter().any(|asked| asked == part);
    let Some(database) = Postgres::new() else { return };
    if wanted("speeds") {
        overhead(&database).await;
    }
    if wanted("workers") {
        two_over_one(&database).await;
    }
    if wanted("claims") {
        claims::measure(&database.url()).await;
    }
    if wanted("stored") {
        stored::measure(&database).await;
    }
}

/// Cluster of one service that computes nothing, and so many workers with one thread each.
struct Cluster {
    service: Program,
    _workers: Vec<Program>,
    _folder: tempfile::TempDir,
}

impl Cluster {
    fn start(database: &Postgres, workers: usize) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let start = |role: &str, name: &str, threads: &str| {
            let mut command = Command::new(env!("CARGO_BIN_EXE_rubmap"));
            command.arg(role).arg("--data").arg(folder.path().join(name)).args(["--workers", threads]);
            command
                .env("RUBMAP_DATABASE", database.url())
                .env("RUBMAP_OBJECTS", folder.path().join("objects"));
            std::fs::create_dir_all(folder.path().join("objects")).unwrap();
            Program::start(command)
        };
        let service = start("serve", "service", "0");
        let workers = (0..workers).map(|k| start("worker", &format!("worker-{k}"), "1")).collect();
        Self { service, _workers: workers, _folder: folder }
    }
}

/// Starts one process with so many threads.
fn alone(folder: &Path, threads: usize) -> Program {
    let mut command = Command::new(env!("CARGO_BIN_EXE_rubmap"));
    command.args(["serve", "--workers", &threads.to_string(), "--data"]).arg(folder);
    Program::start(command)
}

/// Request for a sweep of so many speeds, each of so many revolutions.
fn sweep(model: &str, speeds: u32, revolutions: u32) -> Value {
    let mut request = app::sweep_of(model);
    request["speeds"]["count"] = json!(speeds);
    request["integration"]["revolutions"] = json!(revolutions);
    request
}

/// Time from the post of a sweep to its end, s: the fastest of some.
async fn time(api: &Api, speeds: u32, revolutions: u32) -> f64 {
    let model = api.model(model::package(1.0)).await;
    let begin = Instant::now();
    let id = api.sweep(&sweep(&model, speeds, revolutions)).await;
    loop {
        let job = api.job(&id).await.body;
        match job["status"].as_str() {
            Some("accepted" | "running") => tokio::time::sleep(BETWEEN_LOOKS).await,
            Some("successful") => break,
            _ => panic!("{job}"),
        }
        assert!(begin.elapsed() < PATIENCE, "{job}");
    }
    begin.elapsed().as_secs_f64()
}

/// Measures the time of a speed beyond its computation, with and without a database that is shared.
async fn overhead(database: &Postgres) {
    const SPEEDS: u32 = 400;
    const REVOLUTIONS: u32 = 12;
    let (folder, cluster) = (tempfile::tempdir().unwrap(), Cluster::start(database, 1));
    let one = alone(folder.path(), 1);
    let (mut own, mut shared) = (f64::INFINITY, f64::INFINITY);
    for round in 0..=TIMES {
        let (here, there) = (
            time(&one.api, SPEEDS, REVOLUTIONS).await,
            time(&cluster.service.api, SPEEDS, REVOLUTIONS).await,
        );
        // The first round reduces the wheel and starts what has to be started.
        if round > 0 {
            (own, shared) = (own.min(here), shared.min(there));
        }
    }
    let each = |seconds: f64| 1e3 * seconds / f64::from(SPEEDS);
    println!(
        "speeds: {SPEEDS} of {REVOLUTIONS} revolutions on one thread: {:.2} ms each alone, {:.2} ms each shared: {:.2} ms more",
        each(own),
        each(shared),
        each(shared - own)
    );
}

/// Measures how much faster two workers are than one, beside two threads of one process, which show what the machine allows.
async fn two_over_one(database: &Postgres) {
    const SPEEDS: u32 = 160;
    const REVOLUTIONS: u32 = 300;
    let mut shared = [f64::INFINITY; 2];
    let mut own = [f64::INFINITY; 2];
    for _ in 0..TIMES {
        for (count, (shared, own)) in (1..).zip(shared.iter_mut().zip(&mut own)) {
            let cluster = Cluster::start(database, count);
            time(&cluster.service.api, 4, 12).await;
            *shared = shared.min(time(&cluster.service.api, SPEEDS, REVOLUTIONS).await);
            drop(cluster);
            let folder = tempfile::tempdir().unwrap();
            let process = alone(folder.path(), count);
            time(&process.api, 4, 12).await;
            *own = own.min(time(&process.api, SPEEDS, REVOLUTIONS).await);
        }
    }
    for (what, [one, two]) in [("worker", shared), ("thread of one process", own)] {
        println!("workers: {SPEEDS} speeds: one {what} {one:.2} s, two {two:.2} s, ratio {:.2}", one / two);
    }
}
