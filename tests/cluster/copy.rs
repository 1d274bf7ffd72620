//! `rubmap copy`: the results of a service on one machine are, to the byte, those of the cluster they are copied to.

use std::collections::{BTreeMap, BTreeSet};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use serde_json::{Value, json};
use sqlx::{Connection, Executor, PgConnection};

use super::app::{Api, PATIENCE, long_sweep_of, modal_analysis_of, sweep_of};
use super::model;
use super::postgres::Postgres;
use super::program::Program;

/// Parameters of an impeller with a coarse mesh.
fn coarse() -> Value {
    json!({
        "preset": "small",
        "contact_nodes": 3,
        "mesh": {"between_contact_nodes": 1, "blade_height": 2, "blade_thickness": 1, "half_passage": 1, "disk": 1},
    })
}

async fn ended(api: &Api, path: &str, request: &Value) -> Value {
    let answer = api.post(path, request).await;
    assert_eq!(answer.status, 202, "{}", answer.body);
    api.finish(&answer.text("/id")).await
}

/// Computes a job of every kind and end on one machine. Returns the ids of those that have ended, and of one that has not.
async fn compute(api: &Api) -> (Vec<String>, String) {
    let model = api.model(model::package(1.0)).await;
    let made = ended(api, "/v1/models", &coarse()).await;
    let mut impossible = sweep_of(&model);
    impossible["scene"]["initial"] = json!({"nodal_diameter": 0, "family": 99, "amplitude": 0.01});
    let failed = ended(api, "/v1/sweeps", &impossible).await;
    assert_eq!(failed["status"], "failed", "{failed}");
    let mut rubbing = sweep_of(made["model"].as_str().unwrap());
    rubbing["speeds"] = json!({"from": 1200.0, "to": 1500.0, "count": 2, "unit": "rad_s"});
    rubbing["record"] = json!({"stress": {}});
    let mut case = sweep_of(&model);
    let fields = case.as_object_mut().unwrap();
    fields.remove("speeds");
    fields.insert("speed".to_owned(), json!({"value": 540.0, "unit": "rad_s"}));
    fields.insert("record".to_owned(), json!({"revolutions": [0, 2]}));
    let study = json!({
        "model": model,
        "speeds": {"values": [700.0], "unit": "rad_s"},
        "scene": sweep_of(&model)["scene"],
        "integration": {"revolutions": 12, "ramp_revolutions": 1.0, "window_revolutions": 4},
        "grid": {"modes_per_speed": [2, 3], "schemes": ["exact_modal"], "steps_per_revolution": [400, 800]},
        "max_engine_order": 8,
    });
    let mut jobs = vec![made, failed];
    for (path, request) in [
        ("/v1/sweeps", &sweep_of(&model)),
        ("/v1/sweeps", &rubbing),
        ("/v1/modal-analyses", &modal_analysis_of(&model)),
        ("/v1/case-studies", &case),
        ("/v1/studies", &study),
    ] {
        let job = ended(api, path, request).await;
        assert_eq!(job["status"], "successful", "{job}");
        jobs.push(job);
    }
    let unfinished = api.sweep(&long_sweep_of(&model, 16)).await;
    api.follow(&unfinished, |job| job["speeds"]["finished"].as_u64() >= Some(3)).await;
    (jobs.iter().map(|job| job["id"].as_str().unwrap().to_owned()).collect(), unfinished)
}

/// Reads an answer: its status and body.
async fn bytes(api: &Api, path: &str) -> (u16, Vec<u8>) {
    let answer = api.request("GET", path).send().await.unwrap();
    (answer.status().as_u16(), answer.bytes().await.unwrap().to_vec())
}

/// Reads all that can be read of models and of these jobs.
async fn read(api: &Api, jobs: &[String]) -> BTreeMap<String, (u16, Vec<u8>)> {
    let mut paths: BTreeSet<String> = BTreeSet::from(["/v1/models".to_owned()]);
    for model in api.get("/v1/models").await.body["models"].as_array().unwrap() {
        let model = model["id"].as_str().unwrap();
        paths.extend(["", "/mesh", "/section", "/modes"].map(|what| format!("/v1/models/{model}{what}")));
    }
    for job in jobs {
        let links = api.job(job).await.body["links"].as_array().unwrap().clone();
        paths.extend(links.iter().map(|link| link["href"].as_str().unwrap().to_owned()));
        for what in ["spectra/0", "spectra/1", "spectra/5", "wear/1", "stress", "histories?speed=0"] {
            paths.insert(format!("/v1/jobs/{job}/{what}"));
        }
    }
    let mut found = BTreeMap::new();
    for path in paths {
        let answer = bytes(api, &path).await;
        found.insert(path, answer);
    }
    found
}

/// Move of a folder to a cluster that is made of it.
struct Move {
    folder: tempfile::TempDir,
    database: Postgres,
}

impl Move {
    fn command(&self, arguments: &[&str], data: &str) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_rubmap"));
        command
            .args(arguments)
            .arg("--data")
            .arg(self.folder.path().join(data))
            .env("RUBMAP_DATABASE", self.database.url())
            .env("RUBMAP_OBJECTS", self.folder.path().join("objects"));
        command
    }

    fn copy(&self) -> Child {
        let mut command = self.command(&["copy"], "alone");
        command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap()
    }

    /// Copies the folder; returns the output of the copy, which must end well.
    fn copied(&self) -> String {
        let output = self.copy().wait_with_output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8(output.stdout).unwrap()
    }

    /// Kills a copy that has brought all files and some rows.
    async fn copy_killed(&self) {
        let mut reader = PgConnection::connect(&self.database.url()).await.unwrap();
        let mut locker = PgConnection::connect(&self.database.url()).await.unwrap();
        locker.execute("begin; lock table speed_results in access exclusive mode").await.unwrap();
        let mut copy = self.copy();
        let begin = Instant::now();
        while sqlx::query("select 1 from pg_locks where not granted")
            .fetch_optional(&mut reader)
            .await
            .unwrap()
            .is_none()
        {
            assert!(begin.elapsed() < PATIENCE, "it does not come to the results");
            tokio::time::sleep(Duration::from_millis(20)).await;
        }
        copy.kill().unwrap();
        copy.wait().unwrap();
        locker.execute("rollback").await.unwrap();
        let jobs: i64 = sqlx::query_scalar("select count(*) from jobs").fetch_one(&mut reader).await.unwrap();
        assert_eq!(jobs, 0, "rows come together");
    }
}

#[tokio::test]
async fn a_copied_folder_is_read_to_the_byte_and_gone_on_with() {
    let Some(database) = Postgres::new() else { return };
    let there = Move { folder: tempfile::tempdir().unwrap(), database };
    std::fs::create_dir(there.folder.path().join("objects")).unwrap();
    let alone = Program::serve(&there.folder.path().join("alone"));
    let (jobs, unfinished) = compute(&alone.api).await;
    let found = read(&alone.api, &jobs).await;
    assert!(found.values().filter(|(status, _)| *status == 200).count() > 30, "{:?}", found.keys());
    let refused = there.copy().wait_with_output().unwrap();
    let said = String::from_utf8_lossy(&refused.stderr).into_owned();
    assert!(!refused.status.success() && said.contains("a service has the data folder"), "{said}");
    alone.kill();

    let mut migrate = Command::new(env!("CARGO_BIN_EXE_rubmap"));
    migrate.args(["migrate", "--database", &there.database.url()]).stdout(Stdio::null());
    assert!(migrate.status().unwrap().success());
    there.copy_killed().await;
    let said = there.copied();
    assert!(said.starts_with("2 models and 8 jobs are there"), "{said}");
    assert!(said.contains(" and 0 of "), "files came with the copy that was killed: {said}");
    let said = there.copied();
    assert!(said.contains(": 0 of ") && said.contains(" and 0 of "), "{said}");

    let service = Program::start(there.command(&["serve", "--workers", "0"], "service"));
    for (path, expected) in &found {
        let answer = bytes(&service.api, path).await;
        assert!(answer == *expected, "{path}: {} instead of {}", answer.0, expected.0);
    }
    let job = service.api.job(&unfinished).await.body;
    assert_eq!(job["status"], "accepted", "{job}");
    let before = points(&service.api, &unfinished).await;
    assert!(before.len() >= 3);
    let worker = Program::start(there.command(&["worker", "--workers", "2"], "worker"));
    let job = service.api.finish(&unfinished).await;
    assert_eq!(job["status"], "successful", "{job}");
    let after = points(&service.api, &unfinished).await;
    assert_eq!(after.len(), 16);
    for (index, point) in before {
        assert_eq!(after[&index], point, "computed again");
    }
    worker.terminate();
    service.terminate();
}

/// Reads the points of a sweep by index; each carries its wall time, which no second computation would repeat.
async fn points(api: &Api, id: &str) -> BTreeMap<u64, Value> {
    let map = api.get(&format!("/v1/jobs/{id}/interaction-map")).await.body;
    let points = map["points"].as_array().unwrap();
    points.iter().map(|point| (point["index"].as_u64().unwrap(), point.clone())).collect()
}
