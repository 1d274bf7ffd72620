//! Chaos: disturbances at random moments, against the real program: every job that it accepted ends, and ends as if nothing had happened.
//!
//! `RUBMAP_CHAOS_SECONDS` (30) is the time for which it disturbs, `RUBMAP_CHAOS_SEED` (1) repeats what was drawn; what it meets
//! then is a matter of time all the same.

#[path = "../api/app.rs"]
#[expect(dead_code, reason = "shared with tests that need more of it")]
mod app;
mod catalogue;
mod disturb;
#[path = "../api/model.rs"]
#[expect(dead_code, reason = "shared with tests that need more of it")]
mod model;
#[path = "../api/program.rs"]
#[expect(dead_code, reason = "shared with tests that need more of it")]
mod program;
mod random;
#[path = "../api/small_disk.rs"]
mod small_disk;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, Instant};

use serde_json::Value;

use self::app::Api;
use self::catalogue::{KINDS, Kind, result_of};
use self::disturb::{Disturbances, Tally};
use self::program::Program;
use self::random::Random;
use self::small_disk::SmallDisk;

/// Room for the data folder, in MiB, where a file system of its own can be had: enough for all, if nobody fills it.
const DISK_MIB: u32 = 256;

/// Longest wait for the last job once nothing disturbs any more.
const LAST: Duration = Duration::from_secs(600);

fn variable(name: &str, default: u64) -> u64 {
    std::env::var(name).ok().map_or(default, |value| value.parse().unwrap())
}

#[tokio::test]
async fn whatever_was_accepted_ends_as_if_nothing_had_happened() {
    let (seconds, seed) = (variable("RUBMAP_CHAOS_SECONDS", 30), variable("RUBMAP_CHAOS_SEED", 1));
    println!("{seconds} s, seed {seed}");
    let undisturbed = undisturbed_results().await;

    let disk = SmallDisk::mount(DISK_MIB);
    let folder = tempfile::tempdir().unwrap();
    let data = disk.as_ref().map_or_else(|| folder.path().join("data"), SmallDisk::data);
    let mut random = Random::new(seed);
    let mut disturbances = Disturbances::new(disk.as_ref(), &data);
    // Accepted jobs by the key under which each was posted.
    let mut accepted: BTreeMap<String, (Kind, String)> = BTreeMap::new();
    let begin = Instant::now();
    let mut program = Program::serve(&data);
    let mut posted = 0;
    while begin.elapsed() < Duration::from_secs(seconds) {
        if random.below(3) == 0 {
            let kind = KINDS[random.below(KINDS.len() as u64) as usize];
            let key = format!("job {posted}");
            posted += 1;
            if let Some(id) = kind.post(&program.api, &key).await {
                accepted.insert(key, (kind, id));
            }
        }
        program = disturbances.draw(program, &mut random).await;
    }
    disturbances.end();
    let api = &program.api;
    let ended = Instant::now();
    for (kind, id) in accepted.values() {
        let job = wait_for(api, id, ended).await;
        assert_eq!(job["status"], "successful", "{kind:?}: {job}");
        assert_eq!(result_of(api, *kind, &job).await, undisturbed[kind], "{kind:?} {id}");
    }
    // Jobs whose 202 the client never got have been accepted as well.
    let mut path = Some("/v1/jobs?limit=500".to_owned());
    while let Some(page) = path {
        let page = api.get(&page).await.body;
        for job in page["jobs"].as_array().unwrap() {
            let job = wait_for(api, job["id"].as_str().unwrap(), ended).await;
            assert_eq!(job["status"], "successful", "{job}");
        }
        path = page["next"].as_str().map(ToOwned::to_owned);
    }
    program.terminate();

    let checked =
        Command::new(env!("CARGO_BIN_EXE_rubmap")).args(["check", "--data"]).arg(&data).output().unwrap();
    assert!(checked.status.success(), "{}", String::from_utf8_lossy(&checked.stdout));
    assert_eq!(leftovers(&data), [""; 0].map(PathBuf::from));
    let Tally { kills, terminations, pauses, locks, full_disks, descriptor_lacks, slow_clients } =
        disturbances.tally;
    println!(
        "{kills} kills, {terminations} terminations, {pauses} pauses, {locks} locks, {full_disks} full disks, {descriptor_lacks} \
         lacks of descriptors, {slow_clients} slow clients; {} jobs accepted of {posted} posted, 0 lost",
        accepted.len()
    );
    assert!(accepted.len() > 1 && kills > 0);
}

/// Results of every kind of job, each run alone.
async fn undisturbed_results() -> BTreeMap<Kind, Value> {
    let folder = tempfile::tempdir().unwrap();
    let program = Program::serve(folder.path());
    let mut results = BTreeMap::new();
    for kind in KINDS {
        let id = kind.post(&program.api, &format!("{kind:?}")).await.unwrap();
        let job = wait_for(&program.api, &id, Instant::now()).await;
        assert_eq!(job["status"], "successful", "{kind:?}: {job}");
        results.insert(kind, result_of(&program.api, kind, &job).await);
    }
    program.terminate();
    results
}

async fn wait_for(api: &Api, id: &str, since: Instant) -> Value {
    loop {
        let job = api.job(id).await.body;
        if !["accepted", "running"].contains(&job["status"].as_str().unwrap()) {
            return job;
        }
        assert!(since.elapsed() < LAST, "still waiting: {job}");
        tokio::time::sleep(Duration::from_millis(50)).await;
    }
}

/// Paths of files that nobody will use.
fn leftovers(data: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for folder in ["computing", "checkpoints", "models"] {
        let Ok(entries) = std::fs::read_dir(data.join(folder)) else { continue };
        found.extend(entries.map(|entry| entry.unwrap().path()).filter(|path| {
            let name = path.file_name().unwrap().to_str().unwrap();
            folder != "models" || name.len() != 64 + ".zip".len()
        }));
    }
    found
}
