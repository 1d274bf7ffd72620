//! Cluster of one service and three workers, with clocks a minute apart, over one PostgreSQL and one S3 server: its results are those of one process,
//! bit by bit, whatever happens to them on the way.
//!
//! `RUBMAP_CHAOS_SECONDS` (30) is the time for which it disturbs, `RUBMAP_CHAOS_SEED` (1) repeats what was drawn.

#[path = "../api/app.rs"]
#[expect(dead_code, reason = "shared with tests that need more of it")]
mod app;
#[path = "../chaos/catalogue.rs"]
mod catalogue;
mod copy;
#[path = "../api/model.rs"]
#[expect(dead_code, reason = "shared with tests that need more of it")]
mod model;
mod postgres;
#[path = "../api/program.rs"]
#[expect(dead_code, reason = "shared with tests that need more of it")]
mod program;
mod proxy;
#[path = "../chaos/random.rs"]
mod random;
#[expect(dead_code, reason = "shared with tests that need more of it")]
mod s3;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, Instant};

use serde_json::Value;

use self::app::Api;
use self::catalogue::{KINDS, Kind, result_of};
use self::postgres::Postgres;
use self::program::Program;
use self::proxy::Proxy;
use self::random::Random;
use self::s3::S3;

/// Number of workers beside the service.
const WORKERS: usize = 3;

/// Longest wait for the last job once nothing disturbs any more: that of a worker which hangs is taken from it after half a minute.
const LAST: Duration = Duration::from_secs(300);

/// Time after which a worker that hangs goes on: by then others have its tasks.
const HANGS: Duration = Duration::from_secs(45);

/// Path of the library that tells a program another time, where Debian has it.
const FAKETIME: &str = "/usr/lib/x86_64-linux-gnu/faketime/libfaketime.so.1";

/// Errors of the clocks of the workers, in seconds.
const CLOCKS: [&str; WORKERS] = ["+60", "-60", "+0"];

/// Processes of a cluster, each with a folder of its own.
struct Cluster {
    folder: tempfile::TempDir,
    database: Postgres,
    to_database: Proxy,
    /// Object storage and the way to it; `None` where the objects are in a folder.
    storage: Option<(S3, Proxy)>,
    service: Option<Program>,
    workers: Vec<Option<Program>>,
    /// Worker that hangs, and since when.
    hangs: Option<(usize, Instant)>,
}

impl Cluster {
    /// Starts a cluster; `None` where there is no PostgreSQL.
    fn start() -> Option<Self> {
        let database = Postgres::new()?;
        let to_database = Proxy::to(database.port);
        let storage = S3::new().map(|server| {
            let proxy = Proxy::to(server.port);
            (server, proxy)
        });
        if !Path::new(FAKETIME).exists() {
            eprintln!("all clocks are right: {FAKETIME} is not there");
        }
        let folder = tempfile::tempdir().unwrap();
        std::fs::create_dir(folder.path().join("objects")).unwrap();
        let mut cluster =
            Self { folder, database, to_database, storage, service: None, workers: Vec::new(), hangs: None };
        cluster.service = Some(cluster.serve());
        cluster.workers = (0..WORKERS).map(|k| Some(cluster.work(k))).collect();
        Some(cluster)
    }

    fn command(&self, role: &str, folder: &str) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_rubmap"));
        command
            .arg(role)
            .arg("--data")
            .arg(self.path(folder))
            .env("RUBMAP_DATABASE", self.database.url_by(self.to_database.port()));
        match &self.storage {
            Some((_, proxy)) => command.envs(storage_at(proxy.port())),
            None => command.env("RUBMAP_OBJECTS", self.path("objects")),
        };
        command
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn serve(&self) -> Program {
        let mut command = self.command("serve", "service");
        command.args(["--workers", "0"]);
        Program::start(command)
    }

    fn work(&self, k: usize) -> Program {
        let mut command = self.command("worker", &format!("worker-{k}"));
        command.args(["--workers", "1"]);
        if Path::new(FAKETIME).exists() {
            command
                .env("LD_PRELOAD", FAKETIME)
                .env("FAKETIME", CLOCKS[k])
                .env("FAKETIME_DONT_FAKE_MONOTONIC", "1");
        }
        Program::start(command)
    }

    fn api(&self) -> Api {
        self.service.as_ref().unwrap().api.clone()
    }

    /// Disturbs one of the processes; returns what was done.
    fn disturb(&mut self, random: &mut Random) -> &'static str {
        self.wake();
        let k = match random.below(WORKERS as u64) as usize {
            k if self.hangs.is_some_and(|(hangs, _)| hangs == k) => (k + 1) % WORKERS,
            k => k,
        };
        let time = Duration::from_millis(500 * (1 + random.below(8)));
        match (random.below(10), &self.storage) {
            (0, _) => {
                self.workers[k].take().unwrap().kill();
                self.workers[k] = Some(self.work(k));
                "a worker killed"
            }
            (1, _) => {
                self.workers[k].take().unwrap().terminate();
                self.workers[k] = Some(self.work(k));
                "a worker stopped"
            }
            (2, _) => {
                self.service.take().unwrap().kill();
                self.service = Some(self.serve());
                "the service killed"
            }
            (3, _) => {
                self.database.crash();
                std::thread::sleep(time);
                self.database.start();
                "the database crashed"
            }
            (4, _) => {
                let worker = self.workers[k].as_ref().unwrap();
                worker.signal("STOP");
                std::thread::sleep(time);
                worker.signal("CONT");
                "a worker frozen"
            }
            (5, _) if self.hangs.is_none() => {
                self.workers[k].as_ref().unwrap().signal("STOP");
                self.hangs = Some((k, Instant::now()));
                "a worker hung"
            }
            (6, Some((_, proxy))) => {
                proxy.freeze(time);
                "the storage silent"
            }
            (7, Some((_, proxy))) => {
                proxy.cut(time);
                "the storage cut off"
            }
            (8, _) => {
                self.to_database.cut(time);
                "the database cut off"
            }
            _ => {
                self.to_database.freeze(time);
                "the database silent"
            }
        }
    }

    /// Lets the worker that hangs go on, when it has hung for long enough.
    fn wake(&mut self) {
        if let Some((k, _)) = self.hangs.take_if(|(_, since)| since.elapsed() > HANGS) {
            self.workers[k].as_ref().unwrap().signal("CONT");
        }
    }
}

/// Environment of a process that finds the bucket of the test by way of a port.
fn storage_at(port: u16) -> [(&'static str, String); 6] {
    [
        ("RUBMAP_OBJECTS", format!("s3://{}/rubmap", S3::BUCKET)),
        ("AWS_ENDPOINT", format!("http://127.0.0.1:{port}")),
        ("AWS_ALLOW_HTTP", "true".to_owned()),
        ("AWS_REGION", "us-east-1".to_owned()),
        ("AWS_ACCESS_KEY_ID", "test".to_owned()),
        ("AWS_SECRET_ACCESS_KEY", "test".to_owned()),
    ]
}

fn variable(name: &str, default: u64) -> u64 {
    std::env::var(name).ok().map_or(default, |value| value.parse().unwrap())
}

/// Results of one process that nobody disturbs.
async fn found_by_one(folder: &Path) -> BTreeMap<Kind, Value> {
    let one = Program::serve(folder);
    let mut found = BTreeMap::new();
    for kind in KINDS {
        let id = kind.post(&one.api, &format!("{kind:?}")).await.unwrap();
        let job = one.api.finish(&id).await;
        assert_eq!(job["status"], "successful", "{job}");
        found.insert(kind, result_of(&one.api, kind, &job).await);
    }
    found
}

#[tokio::test]
async fn whatever_happens_all_that_was_accepted_is_found_and_found_once() {
    let Some(mut cluster) = Cluster::start() else { return };
    let alone = found_by_one(&cluster.path("alone")).await;
    let (seconds, seed) = (variable("RUBMAP_CHAOS_SECONDS", 30), variable("RUBMAP_CHAOS_SEED", 1));
    println!("{seconds} s, seed {seed}");
    let mut random = Random::new(seed);
    let mut accepted: Vec<(Kind, String)> = Vec::new();
    let mut tally: BTreeMap<&str, u32> = BTreeMap::new();
    let begin = Instant::now();
    for round in 0.. {
        for kind in KINDS {
            if let Some(id) = kind.post(&cluster.api(), &format!("{kind:?} {round}")).await {
                accepted.push((kind, id));
            }
        }
        if begin.elapsed().as_secs() >= seconds {
            break;
        }
        tokio::time::sleep(Duration::from_millis(300 + random.below(1500))).await;
        *tally.entry(cluster.disturb(&mut random)).or_default() += 1;
    }
    println!("{} jobs; {tally:?}", accepted.len());
    let api = cluster.api();
    let begin = Instant::now();
    for (kind, id) in accepted {
        let job = loop {
            let job = api.job(&id).await.body;
            if !["accepted", "running"].contains(&job["status"].as_str().unwrap()) {
                break job;
            }
            assert!(begin.elapsed() < LAST, "still waiting: {job}");
            cluster.wake();
            tokio::time::sleep(Duration::from_millis(100)).await;
        };
        assert_eq!(job["status"], "successful", "{job}");
        assert_eq!(result_of(&api, kind, &job).await, alone[&kind], "{kind:?} {id}");
    }
}
