//! Backup of a running service, restore, check; and memory kept within its budget.

use std::io::Read;
use std::path::Path;
use std::process::{Command, Output};

use serde_json::{Value, json};

use super::app::{TestApp, long_sweep_of, sweep_of};
use super::kill::points;
use super::model;
use super::program::Program;

pub(crate) fn rubmap(arguments: &[&str], data: &Path) -> Output {
    Command::new(env!("CARGO_BIN_EXE_rubmap")).args(arguments).arg("--data").arg(data).output().unwrap()
}

pub(crate) fn said(output: &Output) -> String {
    format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr))
}

#[tokio::test]
async fn a_backup_of_a_running_service_is_whole() {
    let folder = tempfile::tempdir().unwrap();
    let (data, copy) = (folder.path().join("data"), folder.path().join("copy"));
    let program = Program::serve(&data);
    let model = program.api.model(model::package(1.0)).await;
    let done = program.api.sweep(&sweep_of(&model)).await;
    program.api.finish(&done).await;
    let running = program.api.sweep(&long_sweep_of(&model, 40)).await;
    program.api.follow(&running, |job| job["speeds"]["finished"].as_u64() >= Some(2)).await;

    let backup = rubmap(&["backup", "--to", copy.to_str().unwrap()], &data);
    assert!(backup.status.success(), "{}", said(&backup));
    let again = rubmap(&["backup", "--to", copy.to_str().unwrap()], &data);
    assert!(!again.status.success() && said(&again).contains("overwrite"), "{}", said(&again));
    for folder in [&data, &copy] {
        let checked = rubmap(&["check"], folder);
        assert!(checked.status.success(), "{}", said(&checked));
        assert!(said(&checked).contains("1 models, 2 jobs"), "{}", said(&checked));
    }
    let before = points(&program.api, &done).await;
    program.kill();

    // The restored service has what was finished, and goes on with what was not.
    let program = Program::serve(&copy);
    assert_eq!(points(&program.api, &done).await, before);
    assert_eq!(program.api.job(&running).await.text("/status"), "running");
    program.terminate();

    // The check finds damage: a package with another content, and a result that does not read.
    std::fs::copy(
        folder.path().join("data/models").join(format!("{model}.zip")),
        folder.path().join("whole"),
    )
    .unwrap();
    std::fs::write(copy.join("models").join(format!("{model}.zip")), model::package(2.0)).unwrap();
    let checked = rubmap(&["check"], &copy);
    assert!(!checked.status.success());
    assert!(said(&checked).contains("another content"), "{}", said(&checked));
    std::fs::remove_file(copy.join("models").join(format!("{model}.zip"))).unwrap();
    assert!(said(&rubmap(&["check"], &copy)).contains(&model));
    for command in [&["check"][..], &["backup", "--to", "elsewhere"]] {
        let refused = rubmap(command, &folder.path().join("nowhere"));
        assert!(!refused.status.success() && said(&refused).contains("no data folder"), "{}", said(&refused));
    }
    let inside = data.join("copy");
    let refused = rubmap(&["backup", "--to", inside.to_str().unwrap()], &data);
    assert!(said(&refused).contains("lost with it") && !inside.exists(), "{}", said(&refused));

    // A folder that has lost its database loses no packages on top.
    let package = copy.join("models").join(format!("{model}.zip"));
    std::fs::rename(folder.path().join("whole"), &package).unwrap();
    std::fs::remove_file(copy.join("rubmap.sqlite")).unwrap();
    let mut serve = Command::new(env!("CARGO_BIN_EXE_rubmap"));
    let refused = serve.args(["serve", "--addr", "127.0.0.1:0", "--data"]).arg(&copy).output().unwrap();
    assert!(
        !refused.status.success() && said(&refused).contains("packages of models (1)"),
        "{}",
        said(&refused)
    );
    assert!(package.exists() && !copy.join("rubmap.sqlite").exists());
}

/// Request for a sweep that records as much as it may.
pub(crate) fn wide_sweep_of(model: &str) -> Value {
    let mut request = sweep_of(model);
    request["speeds"] = json!({"values": [400.0, 500.0, 600.0, 700.0], "unit": "rad_s"});
    request["integration"]["revolutions"] = 60.into();
    request["integration"]["window_revolutions"] = 40.into();
    request["max_engine_order"] = 400.into();
    let sensors = (0..64).map(|index| {
        let component = ["radial", "tangential", "axial", "normal"][index % 4];
        json!({"contact_node": index / 4 % 2, "sector": index / 8 % 4, "component": component})
    });
    request["sensors"] = sensors.collect();
    request
}

#[tokio::test]
async fn speeds_take_no_more_memory_than_there_is() {
    let app = TestApp::start_with(|config| config.memory_bytes = Some(64 << 20)).await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let job = api.finish(&api.sweep(&wide_sweep_of(&model)).await).await;
    assert_eq!(job["status"], "failed", "{job}");
    assert_eq!(job["error"]["type"], "urn:rubmap:problem:out-of-memory", "{job}");
    assert_eq!(job["speeds"]["finished"], 0, "{job}");
    // Other jobs are not kept from their memory.
    assert_eq!(api.finish(&api.sweep(&sweep_of(&model)).await).await["status"], "successful");
    app.stop().await;
}

/// Largest number of bytes that the process ever held, from the kernel.
fn peak_bytes(program: &Program) -> u64 {
    let status = std::fs::read_to_string(format!("/proc/{}/status", program.id())).unwrap();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:")).unwrap();
    line.trim().trim_end_matches(" kB").parse::<u64>().unwrap() * 1024
}

#[tokio::test]
async fn large_speeds_and_downloads_stay_within_the_budget() {
    const BUDGET: u64 = 1 << 30;
    let data = tempfile::tempdir().unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_rubmap"));
    command.env("RUBMAP_MEMORY_BYTES", BUDGET.to_string());
    let program = Program::run(command, data.path());
    let api = &program.api;
    let model = api.model(model::package(1.0)).await;
    let request = wide_sweep_of(&model);
    let ids = [api.sweep(&request).await, api.sweep(&request).await];
    for id in &ids {
        assert_eq!(api.finish(id).await["status"], "successful");
    }
    let downloads = (0..8).map(|index| {
        let (api, id) = (api.clone(), ids[index % 2].clone());
        tokio::spawn(async move {
            let path = if index < 4 { format!("spectra/{index}") } else { "interaction-map".to_owned() };
            let mut answer = api.request("GET", &format!("/v1/jobs/{id}/{path}")).send().await.unwrap();
            assert_eq!(answer.status(), 200);
            let mut bytes = 0;
            while let Some(piece) = answer.chunk().await.unwrap() {
                bytes += piece.len();
            }
            bytes
        })
    });
    let mut bytes = 0;
    for download in downloads.collect::<Vec<_>>() {
        bytes += download.await.unwrap();
    }
    assert!(bytes > 50 << 20, "{bytes} bytes are no large answers");
    // The program itself, its caches and what the allocator keeps come on top.
    let peak = peak_bytes(&program);
    assert!(peak < BUDGET + (256 << 20), "{peak} bytes");
}

/// Downloads compressed answers, which browsers and most clients in scripts ask for.
#[tokio::test]
async fn compressed_downloads_are_whole() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let id = api.sweep(&sweep_of(&model)).await;
    api.finish(&id).await;
    for path in ["interaction-map", "spectra/0", "critical-speeds"] {
        let path = format!("/v1/jobs/{id}/{path}");
        let plain = api.request("GET", &path).send().await.unwrap().bytes().await.unwrap();
        let answer = api.request("GET", &path).header("accept-encoding", "gzip").send().await.unwrap();
        assert_eq!(answer.headers()["content-encoding"], "gzip", "{path}");
        let compressed = answer.bytes().await.unwrap();
        let mut expanded = Vec::new();
        flate2::read::GzDecoder::new(&compressed[..]).read_to_end(&mut expanded).unwrap();
        assert_eq!(expanded, plain, "{path}");
    }
    app.stop().await;
}
