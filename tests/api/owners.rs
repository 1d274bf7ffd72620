//! Access of owners: tokens, scopes and limits.

use reqwest::Method;
use rubmap::app::{App, StartError};
use rubmap::tokens::{Scope, new_token};
use serde_json::{Value, json};
use tokio::time::timeout;

use super::app::{Answer, Api, PATIENCE, TestApp, config, long_sweep_of, modal_analysis_of, sweep_of};
use super::generation::coarse;
use super::model;

/// Client with a token.
struct Holder<'a> {
    api: &'a Api,
    token: String,
}

impl Holder<'_> {
    async fn send(&self, method: Method, path: &str, body: Option<&Value>) -> Answer {
        let request = self.api.request(method.as_str(), path).bearer_auth(&self.token);
        let request = match body {
            Some(body) => request.json(body),
            None => request,
        };
        Answer::of(request.send().await.unwrap()).await
    }

    async fn get(&self, path: &str) -> Answer {
        self.send(Method::GET, path, None).await
    }

    async fn post(&self, path: &str, body: &Value) -> Answer {
        self.send(Method::POST, path, Some(body)).await
    }

    async fn delete(&self, path: &str) -> Answer {
        self.send(Method::DELETE, path, None).await
    }

    async fn upload(&self, package: Vec<u8>) -> Answer {
        let request = self.api.request("POST", "/v1/models").bearer_auth(&self.token);
        Answer::of(request.header("content-type", "application/zip").body(package).send().await.unwrap())
            .await
    }

    async fn finish(&self, id: &str) -> Value {
        loop {
            let job = self.get(&format!("/v1/jobs/{id}")).await.body;
            if !["accepted", "running"].contains(&job["status"].as_str().unwrap()) {
                return job;
            }
            tokio::time::sleep(std::time::Duration::from_millis(15)).await;
        }
    }
}

#[tokio::test]
async fn what_belongs_to_one_owner_is_not_there_for_another() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("tokens");
    let token = |owner, scope| new_token(&file, owner, scope).unwrap();
    let [alice, reader, bob, admin] = [
        token("alice", Scope::Write),
        token("alice", Scope::Read),
        token("bob", Scope::Write),
        token("ops", Scope::Admin),
    ];
    let app =
        TestApp::start_with(|config| (config.tokens, config.memory_bytes) = (Some(file), Some(8 << 30)))
            .await;
    let api = &app.api;
    let holder = |token| Holder { api, token };
    let [alice, reader, bob, admin] = [alice, reader, bob, admin].map(holder);

    let refused = api.get("/v1/jobs").await;
    refused.problem(401, "unauthorized");
    holder("rubmap_nobody".to_owned()).get("/v1/models").await.problem(401, "unauthorized");
    let two = api.request("GET", "/v1/models").bearer_auth(&alice.token).bearer_auth(&bob.token);
    Answer::of(two.send().await.unwrap()).await.problem(401, "unauthorized");
    let health = api.get("/healthz").await;
    assert_eq!(health.status, 200);
    assert_eq!(health.body["memory_bytes"], Value::Null, "nothing for strangers");
    for path in ["/metrics", "/openapi.json", "/v1/version"] {
        assert_eq!(api.request("GET", path).send().await.unwrap().status(), 401, "{path}");
    }

    let model = alice.upload(model::package(1.0)).await;
    let (model, uploaded) = (model.text("/id"), model.text("/created_at"));
    bob.get(&format!("/v1/models/{model}")).await.problem(404, "model-not-found");
    bob.delete(&format!("/v1/models/{model}")).await.problem(404, "model-not-found");
    assert_eq!(bob.get("/v1/models").await.body["models"].as_array().unwrap().len(), 0);
    for path in ["/v1/sweeps", "/v1/sweeps/plan"] {
        assert_eq!(bob.post(path, &sweep_of(&model)).await.pointers(422, "invalid-request"), ["/model"]);
    }
    let id = alice.post("/v1/modal-analyses", &modal_analysis_of(&model)).await.text("/id");
    for path in [
        "",
        "/events",
        "/campbell",
        "/backbones",
        "/interaction-map",
        "/spectra/0",
        "/critical-speeds",
        "/work-precision",
        "/histories",
        "/archive",
        "/report",
    ] {
        bob.get(&format!("/v1/jobs/{id}{path}")).await.problem(404, "job-not-found");
    }
    bob.delete(&format!("/v1/jobs/{id}")).await.problem(404, "job-not-found");
    assert_eq!(bob.get("/v1/jobs").await.body["jobs"].as_array().unwrap().len(), 0);

    assert_eq!(reader.finish(&id).await["status"], "successful");
    assert_eq!(reader.get(&format!("/v1/jobs/{id}/campbell")).await.status, 200);
    reader.post("/v1/modal-analyses", &modal_analysis_of(&model)).await.problem(403, "forbidden");
    let planned = reader.post("/v1/modal-analyses/plan", &modal_analysis_of(&model)).await;
    assert_eq!(planned.status, 200, "plans store nothing: {}", planned.body);
    // A look at a mesh stores nothing: it is the body that is refused.
    reader.post("/v1/meshes/look", &json!({})).await.problem(415, "unsupported-media-type");
    reader.delete(&format!("/v1/jobs/{id}")).await.problem(403, "forbidden");
    assert_eq!(admin.get("/v1/jobs").await.body["jobs"].as_array().unwrap().len(), 1);

    // Content that both uploaded is there until both have deleted it.
    let theirs = bob.upload(model::package(1.0)).await;
    assert_eq!((theirs.status.as_u16(), theirs.text("/id")), (201, model.clone()));
    assert!(theirs.text("/created_at") > uploaded, "not when alice uploaded it");
    assert_eq!(alice.delete(&format!("/v1/models/{model}")).await.status, 204);
    alice.get(&format!("/v1/models/{model}")).await.problem(404, "model-not-found");
    assert_eq!(bob.get(&format!("/v1/models/{model}")).await.status, 200);
    let again = bob.post("/v1/modal-analyses", &modal_analysis_of(&model)).await.text("/id");
    assert_eq!(bob.finish(&again).await["status"], "successful");
    assert_eq!(admin.delete(&format!("/v1/models/{model}")).await.status, 204);
    bob.get(&format!("/v1/models/{model}")).await.problem(404, "model-not-found");
    app.stop().await;
}

#[tokio::test]
async fn keys_of_one_owner_are_not_those_of_another() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("tokens");
    let tokens = ["alice", "bob"].map(|owner| new_token(&file, owner, Scope::Write).unwrap());
    let app = TestApp::start_with(|config| config.tokens = Some(file)).await;
    let mut ids = Vec::new();
    for token in &tokens {
        let holder = Holder { api: &app.api, token: token.clone() };
        let model = holder.upload(model::package(1.0)).await.text("/id");
        for _ in 0..2 {
            let request = app.api.request("POST", "/v1/sweeps").bearer_auth(token);
            let sent =
                request.header("idempotency-key", "mine").json(&sweep_of(&model)).send().await.unwrap();
            ids.push(Answer::of(sent).await.text("/id"));
        }
    }
    assert_eq!(ids[0], ids[1]);
    assert_eq!(ids[2], ids[3]);
    assert_ne!(ids[0], ids[2]);
    app.stop().await;
}

#[tokio::test]
async fn limits_are_said_with_when_to_try_again() {
    let app = TestApp::start_with(|config| {
        (config.owner_speeds, config.owner_models) = (Some(10), Some(1));
    })
    .await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    assert_eq!(api.upload(model::package_stored(1.0)).await.status, 200, "it is the same");
    api.upload(model::package(2.0)).await.problem(429, "limit-reached");
    let mut request = sweep_of(&model);
    request["speeds"]["count"] = 11.into();
    let refused = api.request("POST", "/v1/sweeps").json(&request).send().await.unwrap();
    assert!(!refused.headers().contains_key("retry-after"), "no waiting helps");
    let refused = Answer::of(refused).await;
    assert_eq!(refused.pointers(422, "invalid-request"), ["/speeds"]);
    assert!(refused.text("/detail").contains("more than the 10"), "{}", refused.body);
    let long = api.sweep(&long_sweep_of(&model, 9)).await;
    request["speeds"]["count"] = 10.into();
    let refused = api.request("POST", "/v1/sweeps").json(&request).send().await.unwrap();
    assert_eq!(refused.status(), 429);
    assert!(refused.headers().contains_key("retry-after"));
    api.delete(&format!("/v1/jobs/{long}")).await;
    request["speeds"]["count"] = 10.into();
    let id = api.sweep(&request).await;
    assert_eq!(api.finish(&id).await["status"], "successful");
    assert_eq!(api.finish(&api.sweep(&request).await).await["status"], "successful", "those have ended");
    app.stop().await;
}

#[tokio::test]
async fn a_package_counts_before_it_is_there() {
    let package = model::package(1.0);
    let bytes = package.len() as u64;
    let app = TestApp::start_with(|config| config.owner_bytes = Some(bytes)).await;
    let api = &app.api;
    api.model(package).await;
    api.upload(model::package(2.0)).await.problem(429, "limit-reached");
    app.stop().await;

    let app = TestApp::start_with(|config| config.owner_bytes = Some(bytes - 1)).await;
    app.api.upload(model::package(1.0)).await.problem(429, "limit-reached");
    app.stop().await;
}

#[tokio::test]
async fn models_that_are_being_generated_count() {
    let app = TestApp::start_with(|config| config.owner_models = Some(1)).await;
    let api = &app.api;
    let generation = api.post("/v1/models", &coarse()).await;
    assert_eq!(generation.status, 202, "{}", generation.body);
    let again = api.post("/v1/models", &json!({"preset": "small"})).await;
    again.problem(429, "limit-reached");
    api.upload(model::package(1.0)).await.problem(429, "limit-reached");
    assert_eq!(api.finish(&generation.text("/id")).await["status"], "successful");
    api.post("/v1/models", &coarse()).await.problem(429, "limit-reached");
    app.stop().await;
}

#[tokio::test]
async fn nobody_serves_the_world_by_accident() {
    let folder = tempfile::tempdir().unwrap();
    let mut config = config(folder.path());
    config.addr = "0.0.0.0:0".parse().unwrap();
    let refused = App::build(config.clone()).await.unwrap_err();
    assert!(matches!(refused, StartError::Exposed(_)), "{refused}");
    assert!(refused.to_string().contains("--tokens") && refused.to_string().contains("--open"));
    config.open = true;
    drop(App::build(config).await.unwrap());
}

/// Streams end when their token is taken out of the file: a follower hears no more of the job.
#[tokio::test]
async fn a_withdrawn_token_ends_its_streams() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("tokens");
    let token = new_token(&file, "alice", Scope::Write).unwrap();
    let app = TestApp::start_with(|config| config.tokens = Some(file.clone())).await;
    let alice = Holder { api: &app.api, token };
    let model = alice.upload(model::package(1.0)).await.text("/id");
    let id = alice.post("/v1/sweeps", &long_sweep_of(&model, 500)).await.text("/id");
    let request = app.api.request("GET", &format!("/v1/jobs/{id}/events")).bearer_auth(&alice.token);
    let mut stream = request.send().await.unwrap();
    assert!(stream.chunk().await.unwrap().is_some());
    std::fs::write(&file, "# nobody\n").unwrap();
    while timeout(PATIENCE, stream.chunk()).await.expect("the stream goes on").unwrap().is_some() {}
    app.stop().await;
}
