//! One service and three workers over one PostgreSQL and one folder of objects: what they find is what one process finds, bit by bit,
//! whatever happens to them on the way.
//!
//! `RUBMAP_CHAOS_SECONDS` (30) says how long it disturbs, `RUBMAP_CHAOS_SEED` (1) repeats what was drawn.

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
#[path = "../chaos/random.rs"]
mod random;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, Instant};

use serde_json::Value;

use self::app::Api;
use self::catalogue::{KINDS, Kind, result_of};
use self::postgres::Postgres;
use self::program::Program;
use self::random::Random;

/// Workers beside the service.
const WORKERS: usize = 3;

/// Longest wait for the last job once nothing disturbs any more: that of a worker which hangs is taken from it after half a minute.
const LAST: Duration = Duration::from_secs(300);

/// The processes of a cluster, each with a folder of its own.
struct Cluster {
    folder: tempfile::TempDir,
    database: Postgres,
    service: Option<Program>,
    workers: Vec<Option<Program>>,
}

impl Cluster {
    /// None where there is no PostgreSQL.
    fn start() -> Option<Self> {
        let database = Postgres::new()?;
        let folder = tempfile::tempdir().unwrap();
        let mut cluster = Self { folder, database, service: None, workers: Vec::new() };
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
            .env("RUBMAP_DATABASE", self.database.url())
            .env("RUBMAP_OBJECTS", self.path("objects"));
        std::fs::create_dir_all(self.path("objects")).unwrap();
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
        Program::start(command)
    }

    fn api(&self) -> Api {
        self.service.as_ref().unwrap().api.clone()
    }

    /// Something that happens to one of them.
    fn disturb(&mut self, random: &mut Random) -> &'static str {
        let k = random.below(WORKERS as u64) as usize;
        match random.below(5) {
            0 => {
                self.workers[k].take().unwrap().kill();
                self.workers[k] = Some(self.work(k));
                "a worker killed"
            }
            1 => {
                self.workers[k].take().unwrap().terminate();
                self.workers[k] = Some(self.work(k));
                "a worker stopped"
            }
            2 => {
                self.service.take().unwrap().kill();
                self.service = Some(self.serve());
                "the service killed"
            }
            3 => {
                self.database.crash();
                std::thread::sleep(Duration::from_millis(500 * random.below(6)));
                self.database.start();
                "the database crashed"
            }
            _ => {
                let worker = self.workers[k].as_ref().unwrap();
                worker.signal("STOP");
                std::thread::sleep(Duration::from_secs(2));
                worker.signal("CONT");
                "a worker frozen"
            }
        }
    }
}

fn variable(name: &str, default: u64) -> u64 {
    std::env::var(name).ok().map_or(default, |value| value.parse().unwrap())
}

/// What one process finds that nobody disturbs.
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
            tokio::time::sleep(Duration::from_millis(100)).await;
        };
        assert_eq!(job["status"], "successful", "{job}");
        assert_eq!(result_of(&api, kind, &job).await, alone[&kind], "{kind:?} {id}");
    }
}
