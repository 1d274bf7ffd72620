//! Faults of the machine that pass (no room on the disk, a lock, no descriptors, a missing file) cost time and no work.

use std::collections::BTreeSet;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Duration;

use rubmap::store::Store;
use rubmap::store::jobs::JobId;
use serde_json::Value;
use sqlx::sqlite::{SqliteConnectOptions, SqliteConnection};
use sqlx::{ConnectOptions, Connection};

use super::app::{TestApp, long_sweep_of, modal_analysis_of, sweep_of};
use super::keeping::wide_sweep_of;
use super::kill::points;
use super::model;
use super::program::Program;
use super::small_disk::SmallDisk;

/// Request for a sweep of one quick speed.
fn quick_sweep_of(model: &str) -> Value {
    let mut request = sweep_of(model);
    request["speeds"] = serde_json::json!({"values": [500.0], "unit": "rad_s"});
    request
}

#[tokio::test]
async fn a_full_disk_loses_nothing_that_was_accepted() {
    let Some(disk) = SmallDisk::mount(24) else { return };
    let program = Program::serve(&disk.data());
    let api = &program.api;
    let model = api.model(model::package(1.0)).await;
    let running = api.sweep(&long_sweep_of(&model, 12)).await;
    api.follow(&running, |job| job["speeds"]["finished"].as_u64() >= Some(2)).await;

    disk.fill();
    let mut accepted = Vec::new();
    let mut refused = 0;
    // Some jobs find room that the database has already; then there is none.
    for _ in 0..400 {
        let response = api.request("POST", "/v1/sweeps").json(&quick_sweep_of(&model)).send().await.unwrap();
        match response.status().as_u16() {
            202 => {
                let id = response.json::<Value>().await.unwrap()["id"].as_str().unwrap().to_owned();
                // Another connection can read it, now and later.
                assert_eq!(api.get(&format!("/v1/jobs/{id}")).await.status, 200);
                accepted.push(id);
            }
            507 => {
                let after: u32 = response.headers()["retry-after"].to_str().unwrap().parse().unwrap();
                assert!(after > 0);
                refused += 1;
                if refused == 5 {
                    break;
                }
            }
            other => panic!("{other}: {}", response.text().await.unwrap()),
        }
    }
    assert_eq!(refused, 5, "the disk did not fill up");
    let upload = api.upload(model::package(1.5)).await;
    upload.problem(507, "disk-full");
    assert!(upload.body["retry_after_s"].as_u64() > Some(0));
    tokio::time::sleep(Duration::from_secs(2)).await;
    for id in accepted.iter().chain([&running]) {
        let status = api.job(id).await.text("/status");
        assert!(["accepted", "running", "successful"].contains(&status.as_str()), "{status} on a full disk");
    }

    // A service that starts on a full disk waits, and ends when it is told to.
    program.kill();
    let mut waiting = Command::new(env!("CARGO_BIN_EXE_rubmap"));
    waiting.args(["serve", "--addr", "127.0.0.1:0", "--data"]).arg(disk.data());
    let mut waiting = waiting.stderr(Stdio::null()).spawn().unwrap();
    tokio::time::sleep(Duration::from_secs(2)).await;
    assert!(waiting.try_wait().unwrap().is_none(), "it gave up");
    Command::new("kill").arg("-TERM").arg(waiting.id().to_string()).status().unwrap();
    assert!(waiting.wait().unwrap().success());

    disk.make_room();
    let program = Program::serve(&disk.data());
    let api = &program.api;
    // Jobs are accepted at the first try: nothing is left of the failures.
    accepted.push(api.sweep(&quick_sweep_of(&model)).await);
    api.model(model::package(1.5)).await;
    for id in accepted.iter().chain([&running]) {
        assert_eq!(api.finish(id).await["status"], "successful");
    }
    let before = points(api, &running).await;
    program.terminate();

    let program = Program::serve(&disk.data());
    for id in &accepted {
        assert_eq!(program.api.job(id).await.text("/status"), "successful");
    }
    assert_eq!(points(&program.api, &running).await, before);
}

/// Makes room on a disk that is full to the last byte: the users of the service may not reach its disk.
#[tokio::test]
async fn room_can_be_made_on_a_full_disk() {
    let Some(disk) = SmallDisk::mount(48) else { return };
    let program = Program::serve(&disk.data());
    let api = &program.api;
    let model = api.model(model::package(1.0)).await;
    let mut request = wide_sweep_of(&model);
    request["max_engine_order"] = 100.into();
    let mut finished = Vec::new();
    for _ in 0..2 {
        let id = api.sweep(&request).await;
        assert_eq!(api.finish(&id).await["status"], "successful");
        finished.push(id);
    }
    let running = api.sweep(&long_sweep_of(&model, 40)).await;
    api.follow(&running, |job| job["speeds"]["finished"].as_u64() >= Some(1)).await;
    disk.fill();
    let post = async || api.post("/v1/sweeps", &quick_sweep_of(&model)).await.status;
    let mut refused = 0;
    for _ in 0..400 {
        refused += usize::from(post().await == 507);
        if refused == 5 {
            break;
        }
    }
    assert_eq!(refused, 5, "the disk did not fill up");
    api.follow(&running, |job| job["phase"].as_str().unwrap().contains("disk")).await;

    for id in &finished {
        assert_eq!(api.delete(&format!("/v1/jobs/{id}")).await.status, 204);
    }
    assert_eq!(api.finish(&running).await["status"], "successful");
    assert_eq!(post().await, 202);
    // The next full disk finds room kept again, and what still computes does not take it.
    let last = api.sweep(&long_sweep_of(&model, 200)).await;
    api.follow(&last, |job| job["speeds"]["finished"].as_u64() >= Some(1)).await;
    disk.fill();
    assert_eq!(api.delete(&format!("/v1/jobs/{running}")).await.status, 204);
    api.follow(&last, |job| job["phase"].as_str().unwrap().contains("disk")).await;
    assert_eq!(api.delete(&format!("/v1/jobs/{last}")).await.text("/status"), "dismissed");
    assert_eq!(api.delete(&format!("/v1/jobs/{last}")).await.status, 204);
}

async fn connect(data: &Path) -> SqliteConnection {
    SqliteConnectOptions::new().filename(data.join("rubmap.sqlite")).connect().await.unwrap()
}

#[tokio::test]
async fn a_locked_database_is_waited_for() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let running = api.sweep(&long_sweep_of(&model, 12)).await;
    api.follow(&running, |job| job["speeds"]["finished"].as_u64() >= Some(1)).await;

    let mut other = connect(app.data()).await;
    sqlx::query("begin exclusive").execute(&mut other).await.unwrap();
    let answer = api.request("POST", "/v1/sweeps").json(&quick_sweep_of(&model)).send().await.unwrap();
    assert_eq!(answer.status(), 503);
    assert!(answer.headers().contains_key("retry-after"));
    // Longer than any statement waits.
    tokio::time::sleep(Duration::from_secs(8)).await;
    assert_eq!(api.job(&running).await.text("/status"), "running");
    sqlx::query("rollback").execute(&mut other).await.unwrap();
    other.close().await.unwrap();

    let quick = api.sweep(&quick_sweep_of(&model)).await;
    for id in [&quick, &running] {
        assert_eq!(api.finish(id).await["status"], "successful");
    }
    app.stop().await;
}

#[tokio::test]
async fn a_package_that_is_absent_for_a_while_is_waited_for() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let package = app.data().join("models").join(format!("{model}.zip"));
    let aside = app.data().join("aside.zip");
    std::fs::rename(&package, &aside).unwrap();
    let id = api.post("/v1/modal-analyses", &modal_analysis_of(&model)).await.text("/id");
    let job =
        api.follow(&id, |job| job["phase"].as_str().is_some_and(|phase| phase.contains("package"))).await;
    assert_eq!(job["status"], "running", "{job}");
    std::fs::rename(&aside, &package).unwrap();
    assert_eq!(api.finish(&id).await["status"], "successful");

    // The package may also be uploaded again.
    std::fs::remove_file(&package).unwrap();
    let mut request = modal_analysis_of(&model);
    request["modes_per_speed"] = 4.into();
    let id = api.post("/v1/modal-analyses", &request).await.text("/id");
    api.follow(&id, |job| job["phase"].as_str().is_some_and(|phase| phase.contains("upload it again"))).await;
    assert_eq!(api.model(model::package(1.0)).await, model);
    assert_eq!(api.finish(&id).await["status"], "successful");
    app.stop().await;
}

/// Waits out a lack of descriptors, in a child that has few of them: the limit counts all that are open in a process, those of tests included.
#[tokio::test]
async fn a_lack_of_descriptors_is_waited_out() {
    let data = tempfile::tempdir().unwrap();
    let program = Program::serve(data.path());
    let api = &program.api;
    let model = api.model(model::package(1.0)).await;
    let running = api.sweep(&long_sweep_of(&model, 12)).await;
    api.follow(&running, |job| job["speeds"]["finished"].as_u64() >= Some(1)).await;
    // The limit is the number of those open already: whatever opens a file fails.
    let limit = |number: &str| {
        let pid = program.id().to_string();
        Command::new("prlimit").args(["--pid", &pid, &format!("--nofile={number}:1024")]).status()
    };
    if !limit("8").is_ok_and(|status| status.success()) {
        println!("skipped: prlimit is not here");
        return;
    }
    tokio::time::sleep(Duration::from_secs(3)).await;
    assert!(limit("1024").unwrap().success());
    let another = api.sweep(&quick_sweep_of(&model)).await;
    for id in [&running, &another] {
        assert_eq!(api.finish(id).await["status"], "successful");
    }
}

#[tokio::test]
async fn a_job_of_one_speed_does_not_wait_for_thousands() {
    let app = TestApp::start_with(|config| config.workers = Some(1)).await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let mut request = sweep_of(&model);
    request["speeds"]["count"] = 5000.into();
    let long = api.sweep(&request).await;
    api.follow(&long, |job| job["speeds"]["finished"].as_u64() >= Some(1)).await;
    let quick = api.sweep(&quick_sweep_of(&model)).await;
    assert_eq!(api.finish(&quick).await["status"], "successful");
    let long_job = api.job(&long).await.body;
    assert!(long_job["speeds"]["finished"].as_u64() < Some(4000), "{long_job}");
    api.delete(&format!("/v1/jobs/{long}")).await;
    app.stop().await;
}

#[tokio::test]
async fn sigterm_ends_a_service_with_hundreds_of_jobs_queued() {
    let data = tempfile::tempdir().unwrap();
    let program = Program::serve(data.path());
    let model = program.api.model(model::package(1.0)).await;
    let mut ids = BTreeSet::new();
    for _ in 0..300 {
        ids.insert(program.api.sweep(&long_sweep_of(&model, 2)).await);
    }
    program.terminate();
    let store = Store::open(data.path()).await.unwrap();
    let unfinished: BTreeSet<String> =
        store.unfinished_jobs().await.unwrap().iter().map(|job| job.id.to_string()).collect();
    for id in &ids {
        let status = store.job(JobId::parse(id).unwrap()).await.unwrap().unwrap().status;
        assert!(unfinished.contains(id) || status.as_str() == "successful", "{id} is {status:?}");
    }
    let crashes: u32 = store.unfinished_jobs().await.unwrap().iter().map(|job| job.crashes).sum();
    assert_eq!(crashes, 0, "being told to stop is no crash");
    store.close().await;
}

/// Life of the service: longer than one speed, shorter than it waits before it computes the job under which it was killed.
const LIFE: Duration = Duration::from_millis(400);

#[tokio::test]
async fn kills_fail_neither_what_runs_nor_what_waits_beside_it() {
    let data = tempfile::tempdir().unwrap();
    let program = Program::serve(data.path());
    let model = program.api.model(model::package(1.0)).await;
    let mut long = long_sweep_of(&model, 2);
    // Its speed takes longer than the service lives.
    long["integration"]["revolutions"] = 4000.into();
    let mut ids = vec![program.api.sweep(&long).await];
    for _ in 0..10 {
        ids.push(program.api.sweep(&quick_sweep_of(&model)).await);
    }
    program.kill();
    for _ in 0..20 {
        let program = Program::serve(data.path());
        tokio::time::sleep(LIFE).await;
        program.kill();
    }
    let program = Program::serve(data.path());
    for id in &ids {
        let job = program.api.finish(id).await;
        assert_eq!(job["status"], "successful", "{job}");
    }
    assert_eq!(files(&data.path().join("computing")), 0);
}

fn files(folder: &Path) -> usize {
    std::fs::read_dir(folder).unwrap().count()
}
