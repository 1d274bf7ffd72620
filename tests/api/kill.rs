//! The real program, killed in the middle of a sweep.

use std::collections::BTreeMap;
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Child, Command, Stdio};

use rubmap::app::{App, StartError};
use serde_json::Value;

use super::app::{Api, config, long_sweep_of};
use super::model;

/// `rubmap serve` as a child process.
struct Program {
    child: Child,
    api: Api,
}

impl Program {
    fn serve(data: &Path) -> Self {
        let mut child = Command::new(env!("CARGO_BIN_EXE_rubmap"))
            .args(["serve", "--addr", "127.0.0.1:0", "--workers", "2", "--data"])
            .arg(data)
            .env("RUST_LOG", "info")
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let mut log = BufReader::new(child.stderr.take().unwrap());
        let mut line = String::new();
        let base = loop {
            line.clear();
            assert_ne!(log.read_line(&mut line).unwrap(), 0, "the program ended before it listened");
            if let Some(at) = line.find("http://") {
                break line[at..].trim().to_owned();
            }
        };
        // Somebody must go on reading, or the program blocks on its log.
        std::thread::spawn(move || std::io::copy(&mut log, &mut std::io::sink()));
        Self { child, api: Api::new(&base) }
    }

    /// SIGKILL: no handler runs, nothing is flushed.
    fn kill(mut self) {
        self.child.kill().unwrap();
        self.child.wait().unwrap();
    }
}

impl Drop for Program {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// Points by index; each carries its wall time, which no second computation would repeat.
async fn points(api: &Api, id: &str) -> BTreeMap<u64, Value> {
    let map = api.get(&format!("/v1/jobs/{id}/interaction-map")).await.body;
    let points = map["points"].as_array().unwrap();
    points.iter().map(|point| (point["index"].as_u64().unwrap(), point.clone())).collect()
}

#[tokio::test]
async fn a_killed_service_resumes_without_computing_anything_again() {
    let data = tempfile::tempdir().unwrap();
    let program = Program::serve(data.path());
    let model = program.api.model(model::package(1.0)).await;
    let id = program.api.sweep(&long_sweep_of(&model, 16)).await;
    program.api.follow(&id, |job| job["speeds"]["finished"].as_u64() >= Some(3)).await;
    let before = points(&program.api, &id).await;
    program.kill();
    assert!((3..16).contains(&before.len()), "{} speeds were finished", before.len());

    let program = Program::serve(data.path());
    // Queued again at once: apalis alone would take a minute to notice the dead worker.
    let begin = std::time::Instant::now();
    program.api.follow(&id, |job| job["speeds"]["finished"].as_u64() > Some(before.len() as u64)).await;
    assert!(begin.elapsed().as_secs() < 30, "resumed after {:?}", begin.elapsed());
    let job = program.api.finish(&id).await;
    assert_eq!(job["status"], "successful", "{job}");
    let after = points(&program.api, &id).await;
    assert_eq!(after.len(), 16, "no speed is lost");
    for (index, point) in &before {
        assert_eq!(&after[index], point, "speed {index} was computed again");
    }
    assert_eq!(program.api.get(&format!("/v1/jobs/{id}/critical-speeds")).await.status, 200);
}

#[tokio::test]
async fn a_data_folder_has_one_service() {
    let data = tempfile::tempdir().unwrap();
    let program = Program::serve(data.path());
    let refused = App::build(config(data.path())).await.unwrap_err();
    assert!(matches!(refused, StartError::InUse(_)), "{refused}");
    assert!(refused.to_string().contains("in use by another rubmap"));
    // A killed process leaves no lock behind.
    program.kill();
    drop(App::build(config(data.path())).await.unwrap());
}

#[tokio::test]
async fn sigterm_ends_the_service_and_not_its_jobs() {
    let data = tempfile::tempdir().unwrap();
    let mut program = Program::serve(data.path());
    let model = program.api.model(model::package(1.0)).await;
    let id = program.api.sweep(&long_sweep_of(&model, 100)).await;
    program.api.follow(&id, |job| job["speeds"]["finished"].as_u64() >= Some(1)).await;
    let killed = Command::new("kill").arg("-TERM").arg(program.child.id().to_string()).status().unwrap();
    assert!(killed.success());
    assert!(program.child.wait().unwrap().success(), "a service told to stop ends well");

    let program = Program::serve(data.path());
    assert_eq!(program.api.job(&id).await.text("/status"), "running");
}
