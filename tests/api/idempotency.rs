//! Idempotency keys: a POST repeated with its key does nothing twice.

use serde_json::Value;

use super::app::{Answer, Api, TestApp, sweep_of};
use super::model;

async fn post(api: &Api, key: &str, body: &Value) -> Answer {
    let request = api.request("POST", "/v1/sweeps").header("Idempotency-Key", key).json(body);
    Answer::of(request.send().await.unwrap()).await
}

#[tokio::test]
async fn a_repeated_post_gets_its_first_answer_again() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let request = sweep_of(&model);
    let first = post(api, "one", &request).await;
    assert_eq!(first.status, 202, "{}", first.body);
    // The request is repeated at once, and after the job has ended.
    for _ in 0..2 {
        let again = post(api, "one", &request).await;
        assert_eq!(
            (again.status, &again.location, &again.body),
            (first.status, &first.location, &first.body)
        );
        api.finish(&first.text("/id")).await;
    }
    let mut other = request.clone();
    other["max_engine_order"] = 7.into();
    post(api, "one", &other).await.problem(422, "idempotency-key-reused");
    assert_ne!(post(api, "two", &request).await.text("/id"), first.text("/id"));
    assert_eq!(api.get("/v1/jobs").await.body["jobs"].as_array().unwrap().len(), 2);
    post(api, "", &request).await.problem(400, "invalid-parameter");

    // A repeated request does not report a deleted job as accepted.
    assert_eq!(api.delete(&format!("/v1/jobs/{}", first.text("/id"))).await.status, 204);
    let anew = post(api, "one", &request).await;
    assert_eq!(anew.status, 202, "{}", anew.body);
    assert_eq!(api.finish(&anew.text("/id")).await["status"], "successful");
    app.stop().await;
}

#[tokio::test]
async fn many_at_the_same_moment_start_one_job() {
    let app = TestApp::start().await;
    let model = app.api.model(model::package(1.0)).await;
    let request = sweep_of(&model);
    let posts = (0..8).map(|_| post(&app.api, "burst", &request));
    let ids: Vec<_> =
        futures::future::join_all(posts).await.iter().map(|answer| answer.text("/id")).collect();
    assert!(ids.iter().all(|id| id == &ids[0]), "{ids:?}");
    app.stop().await;
}

#[tokio::test]
async fn a_repeated_upload_gets_its_first_answer_again() {
    let app = TestApp::start().await;
    let upload = |package: Vec<u8>| {
        let request = app
            .api
            .request("POST", "/v1/models")
            .header("Idempotency-Key", "model")
            .header("content-type", "application/zip")
            .body(package);
        async { Answer::of(request.send().await.unwrap()).await }
    };
    let first = upload(model::package(1.0)).await;
    let again = upload(model::package(1.0)).await;
    assert_eq!((first.status.as_u16(), again.status.as_u16()), (201, 201));
    assert_eq!(first.body, again.body);
    upload(model::package(3.0)).await.problem(422, "idempotency-key-reused");
    app.stop().await;
}
