//! Report of a job as one page.

use std::process::Command;

use rubmap::tokens::{Scope, new_token};
use serde_json::json;

use super::app::{Api, TestApp, long_sweep_of, modal_analysis_of, sweep_of};
use super::generation::coarse;
use super::model;
use super::studies::study_of;

async fn page(api: &Api, path: &str) -> String {
    let response = api.request("GET", path).send().await.unwrap();
    assert_eq!(response.status(), 200, "{path}");
    assert_eq!(response.headers()["content-type"], "text/html; charset=utf-8");
    let policy = response.headers()["content-security-policy"].to_str().unwrap();
    assert!(policy.contains("default-src 'none'"), "{policy}");
    response.text().await.unwrap()
}

#[tokio::test]
async fn a_report_has_what_was_asked_and_found() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let mut request = sweep_of(&model);
    request["name"] = json!("<b>Bold</b> clearance");
    request["tags"] = json!(["<i>"]);
    let sweep = api.sweep(&request).await;
    api.finish(&sweep).await;
    let alone = page(api, &format!("/v1/jobs/{sweep}/report")).await;
    assert_eq!(alone.matches("<svg").count(), 4, "level, map and contact: there is no modal analysis yet");
    assert!(
        alone.contains("&lt;b&gt;Bold&lt;/b&gt; clearance")
            && !alone.contains("<b>Bold")
            && !alone.contains("<i>")
    );
    assert!(alone.contains("6 of 6") && alone.contains(&model) && alone.contains(&sweep));

    let modal = api.post("/v1/modal-analyses", &modal_analysis_of(&model)).await.text("/id");
    let job = api.finish(&modal).await;
    assert!(job["links"].to_string().contains(&format!("/v1/jobs/{modal}/report")));
    let both = page(api, &format!("/v1/jobs/{sweep}/report?sensor=1")).await;
    assert_eq!(both.matches("<svg").count(), 5);
    assert!(both.contains(&format!("of modal analysis {modal}")));
    // The report has what the table of critical speeds has.
    for sensor in 0..2 {
        let table = api.get(&format!("/v1/jobs/{sweep}/critical-speeds?sensor={sensor}")).await.body;
        for peak in table["critical_speeds"].as_array().unwrap() {
            let rpm = peak["speed_rad_s"].as_f64().unwrap() * 30.0 / std::f64::consts::PI;
            assert!(both.contains(&format!("<td>{rpm:.0}</td>")), "{rpm}");
        }
    }
    assert!(page(api, &format!("/v1/jobs/{modal}/report")).await.contains("springs: modal analysis"));

    api.get(&format!("/v1/jobs/{sweep}/report?sensor=2")).await.problem(400, "invalid-parameter");
    let study = api.post("/v1/studies", &study_of(&model)).await.text("/id");
    let generation = api.post("/v1/models", &coarse()).await.text("/id");
    for other in [&study, &generation] {
        api.finish(other).await;
        api.get(&format!("/v1/jobs/{other}/report")).await.problem(409, "wrong-job-kind");
    }
    // Cancelled before a speed is finished.
    let mut long = long_sweep_of(&model, 100);
    long["integration"]["revolutions"] = json!(5_000);
    let long = api.sweep(&long).await;
    api.get(&format!("/v1/jobs/{long}/report")).await.problem(409, "result-not-ready");
    api.delete(&format!("/v1/jobs/{long}")).await;
    api.get(&format!("/v1/jobs/{long}/report")).await.problem(409, "result-unavailable");
    app.stop().await;
}

/// Verdict and report are those of the finished speeds alike.
#[tokio::test]
async fn a_cancelled_sweep_has_the_report_of_its_finished_speeds() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let id = api.sweep(&long_sweep_of(&model, 100)).await;
    api.follow(&id, |job| job["speeds"]["finished"].as_u64() > Some(0)).await;
    api.delete(&format!("/v1/jobs/{id}")).await;
    let job = api.get(&format!("/v1/jobs/{id}")).await.body;
    let finished = job["speeds"]["finished"].as_u64().unwrap();
    let page = page(api, &format!("/v1/jobs/{id}/report")).await;
    assert!(page.contains(&format!("<h1>Unfinished (cancelled after {finished} of 100 speeds): ")));
    let sentence = api.get(&format!("/v1/jobs/{id}/verdict")).await.text("/sentence");
    let (word, reasons) = sentence.split_once(": ").unwrap();
    assert!(word == "Undecided" && page.contains(reasons), "{sentence}");
    app.stop().await;
}

/// Runs the program in a thread of its own: the service runs in this one.
async fn program(arguments: Vec<String>, token: Option<String>) -> (bool, String) {
    tokio::task::spawn_blocking(move || {
        let mut command = Command::new(env!("CARGO_BIN_EXE_rubmap"));
        command.arg("report").args(arguments);
        if let Some(token) = token {
            command.env("RUBMAP_TOKEN", token);
        }
        let output = command.output().unwrap();
        let words = String::from_utf8([output.stdout, output.stderr].concat()).unwrap();
        (output.status.success(), words)
    })
    .await
    .unwrap()
}

#[tokio::test]
async fn the_program_writes_the_page_of_a_service_with_tokens() {
    let folder = tempfile::tempdir().unwrap();
    let tokens = folder.path().join("tokens");
    let token = new_token(&tokens, "alice", Scope::Write).unwrap();
    let app = TestApp::start_with(|config| config.tokens = Some(tokens)).await;
    let upload = app.api.request("POST", "/v1/models").bearer_auth(&token);
    let upload = upload.header("content-type", "application/zip").body(model::package(1.0));
    let model: serde_json::Value = upload.send().await.unwrap().json().await.unwrap();
    let request = modal_analysis_of(model["id"].as_str().unwrap());
    let post = app.api.request("POST", "/v1/modal-analyses").bearer_auth(&token).json(&request);
    let job: serde_json::Value = post.send().await.unwrap().json().await.unwrap();
    let id = job["id"].as_str().unwrap().to_owned();
    let out = folder.path().join("page.html");
    let arguments = |job: &str| {
        let out = out.to_str().unwrap().to_owned();
        vec![job.to_owned(), "--server".to_owned(), app.api.base().to_owned(), "--out".to_owned(), out]
    };
    loop {
        let (done, words) = program(arguments(&id), Some(token.clone())).await;
        if done {
            break;
        }
        assert!(words.contains("409"), "{words}");
        assert!(!out.exists(), "nothing is written of a refusal");
    }
    assert!(std::fs::read_to_string(&out).unwrap().starts_with("<!DOCTYPE html>"));
    let (done, words) = program(arguments(&id), None).await;
    assert!(!done && words.contains("401"), "{words}");
    let (done, words) = program(arguments("none"), Some(token)).await;
    assert!(!done && words.contains("none of the jobs"), "{words}");
    app.stop().await;
}
