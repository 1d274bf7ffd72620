//! Checkpoints of reductions: when they go. The program that is killed shows that they serve.

use rubmap::dynamics::reduction::Checkpoints;
use rubmap::store::Store;
use serde_json::json;

use super::app::{TestApp, modal_analysis_of};
use super::model::{self, files_in};

#[tokio::test]
async fn a_start_removes_what_nobody_will_use() {
    let data = tempfile::tempdir().unwrap();
    let app = TestApp::start_on(data.path()).await;
    let model = app.api.model(model::package(1.0)).await;
    let reduced = app.api.post("/v1/modal-analyses", &modal_analysis_of(&model)).await.text("/id");
    assert_eq!(app.api.finish(&reduced).await["status"], "successful");
    app.stop().await;

    let root = data.path().join("checkpoints");
    let gone = "0".repeat(64);
    let store = Store::open(data.path()).await.unwrap();
    // Checkpoints with 5 modes are wanted; with 3 modes the model is reduced already.
    for (model, modes_per_speed) in [(&model, 5), (&model, 3), (&gone, 5)] {
        store.checkpoints(model, modes_per_speed).save("harmonic-1", vec![7; 1000]);
    }
    store.close().await;
    let wanted = root.join(format!("{model}-5"));
    let parts = files_in(&wanted);
    std::fs::write(wanted.join("0.0.0-1-harmonic-1"), "another version").unwrap();
    std::fs::write(wanted.join("unfinished-x7"), "killed while writing").unwrap();
    let models = data.path().join("models");
    std::fs::write(models.join("upload-y3"), "killed while uploading").unwrap();
    std::fs::write(models.join(format!("{gone}.zip")), "killed before its row").unwrap();

    let app = TestApp::start_on(data.path()).await;
    assert_eq!(files_in(&root), [format!("{model}-5")]);
    assert_eq!(files_in(&wanted), parts);
    assert_eq!(files_in(&models), [format!("{model}.zip")]);
    // The parts of a model go with it.
    assert_eq!(app.api.delete(&format!("/v1/models/{model}")).await.status, 204);
    assert_eq!(files_in(&root), [""; 0]);
    app.stop().await;
}

#[tokio::test]
async fn checkpoints_that_cannot_be_written_do_not_fail_the_job() {
    let data = tempfile::tempdir().unwrap();
    // A file stands where the folder should be.
    std::fs::write(data.path().join("checkpoints"), "").unwrap();
    let app = TestApp::start_on(data.path()).await;
    let model = app.api.model(model::package(1.0)).await;
    let id = app.api.post("/v1/modal-analyses", &modal_analysis_of(&model)).await.text("/id");
    assert_eq!(app.api.finish(&id).await["status"], "successful");
    app.stop().await;
}

#[tokio::test]
async fn a_reduction_beyond_the_memory_is_refused_with_what_to_do() {
    let data = tempfile::tempdir().unwrap();
    let app = TestApp::start_on(data.path()).await;
    let generated = app.api.post("/v1/models", &json!({})).await.text("/id");
    let model = app.api.finish(&generated).await["model"].as_str().unwrap().to_owned();
    app.stop().await;

    let app = TestApp::start_with(|config| {
        config.data = data.path().to_owned();
        config.memory_bytes = Some(1 << 20);
    })
    .await;
    let api = &app.api;
    assert_eq!(api.get("/healthz").await.body["memory_bytes"], 1 << 20);
    let id = api.post("/v1/modal-analyses", &modal_analysis_of(&model)).await.text("/id");
    let job = api.finish(&id).await;
    assert_eq!(job["status"], "failed", "{job}");
    assert_eq!(job["error"]["type"], "urn:rubmap:problem:out-of-memory", "{job}");
    let detail = job["error"]["detail"].as_str().unwrap();
    for words in ["needs about", "may take 0.9 MiB", "fewer modes_per_speed", "--memory-bytes"] {
        assert!(detail.contains(words), "{words:?} is not in {detail:?}");
    }
    assert!(!app.data().join("checkpoints").exists(), "nothing was begun");
    // Others are not affected.
    let small = api.model(model::package(1.0)).await;
    let id = api.post("/v1/modal-analyses", &modal_analysis_of(&small)).await.text("/id");
    assert_eq!(api.finish(&id).await["status"], "successful");
    app.stop().await;
}
