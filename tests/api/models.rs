//! Models: upload, limits, deletion.

use serde_json::json;

use super::app::{TestApp, long_sweep_of};
use super::model::{self, files_in};

#[tokio::test]
async fn the_same_content_is_one_model() {
    let app = TestApp::start().await;
    let api = &app.api;
    let first = api.upload(model::package(1.0)).await;
    assert_eq!(first.status, 201, "{}", first.body);
    let id = first.text("/id");
    assert_eq!(first.location, Some(format!("/v1/models/{id}")));
    assert_eq!(first.body["sectors"], model::SECTORS);
    assert_eq!(first.body["units"]["length"], "mm");

    let again = api.upload(model::package_stored(1.0)).await;
    assert_eq!((again.status.as_u16(), again.text("/id")), (200, id.clone()));
    let other = api.upload(model::package(2.0)).await;
    assert_eq!(other.status, 201);

    let detail = api.get(&format!("/v1/models/{id}")).await.body;
    assert_eq!((&detail["name"], &detail["sectors"]), (&first.body["name"], &first.body["sectors"]));
    assert_eq!(detail["reductions"], serde_json::json!([]));
    assert_eq!(api.get("/v1/models").await.body["models"].as_array().unwrap().len(), 2);
    assert_eq!(api.delete(&format!("/v1/models/{id}")).await.status, 204);
    api.get(&format!("/v1/models/{id}")).await.problem(404, "model-not-found");
    assert_eq!(files_in(&app.data().join("models")), [format!("{}.zip", other.text("/id"))]);
    app.stop().await;
}

#[tokio::test]
async fn the_list_comes_in_pages() {
    let app = TestApp::start().await;
    let api = &app.api;
    let mut models = Vec::new();
    for scale in 1..=5 {
        models.push(api.model(model::package(scale.into())).await);
    }
    let mut path = "/v1/models?limit=2".to_owned();
    let mut listed = Vec::new();
    loop {
        let page = api.get(&path).await.body;
        let ids: Vec<_> =
            page["models"].as_array().unwrap().iter().map(|model| model["id"].clone()).collect();
        // A page may go on after a model that is gone.
        api.delete(&format!("/v1/models/{}", ids.last().unwrap().as_str().unwrap())).await;
        listed.push(ids);
        match page["next"].as_str() {
            Some(next) => path = next.to_owned(),
            None => break,
        }
    }
    assert_eq!(listed.iter().map(Vec::len).collect::<Vec<_>>(), [2, 2, 1]);
    models.reverse();
    assert_eq!(listed.concat(), models);
    for (query, parameter) in [("limit=501", "limit"), ("cursor=here", "cursor"), ("page=2", "page")] {
        let items = api.get(&format!("/v1/models?{query}")).await.problem(400, "invalid-parameter");
        assert_eq!(items[0]["parameter"], parameter, "{query}");
    }
    app.stop().await;
}

#[tokio::test]
async fn a_model_is_there_after_a_restart() {
    let data = tempfile::tempdir().unwrap();
    let app = TestApp::start_on(data.path()).await;
    let id = app.api.model(model::package(1.0)).await;
    app.stop().await;
    let app = TestApp::start_on(data.path()).await;
    assert_eq!(app.api.get(&format!("/v1/models/{id}")).await.status, 200);
    assert_eq!(app.api.upload(model::package(1.0)).await.status, 200);
    app.stop().await;
}

#[tokio::test]
async fn a_model_in_use_stays() {
    let app = TestApp::start().await;
    let api = &app.api;
    let id = api.model(model::package(1.0)).await;
    let job = api.sweep(&long_sweep_of(&id, 100)).await;
    api.delete(&format!("/v1/models/{id}")).await.problem(409, "model-in-use");
    api.delete(&format!("/v1/jobs/{job}")).await;
    assert_eq!(api.delete(&format!("/v1/models/{id}")).await.status, 204);
    // The job is readable without its model.
    assert_eq!(api.get(&format!("/v1/jobs/{job}/interaction-map")).await.status, 200);
    app.stop().await;
}

#[tokio::test]
async fn bad_packages_name_file_and_field() {
    let app = TestApp::start().await;
    let api = &app.api;
    api.upload(b"certainly not a zip file".to_vec()).await.problem(422, "invalid-package");

    let missing = model::spoilt_package(|manifest| manifest["mass"] = json!("missing.mtx"));
    let answer = api.upload(missing).await;
    answer.problem(422, "invalid-package");
    assert!(answer.text("/detail").contains("missing.mtx"), "{}", answer.body);

    let unsorted = model::spoilt_package(|manifest| manifest["speeds_rad_s"] = json!([5.0]));
    let items = api.upload(unsorted).await.problem(422, "invalid-package");
    assert_eq!(items[0]["file"], "sector.json");
    assert!(items[0]["pointer"].as_str().unwrap().starts_with("/speeds_rad_s"), "{items:?}");

    // No file is left.
    assert_eq!(files_in(&app.data().join("models")), [""; 0]);
    app.stop().await;
}

#[tokio::test]
async fn uploads_over_the_limit_are_refused() {
    let app = TestApp::start_with(|config| config.upload_bytes = 1000).await;
    let api = &app.api;
    // The length is declared beforehand.
    api.upload(vec![0; 1001]).await.problem(413, "payload-too-large");
    // The length is found out on the way: a stream has none.
    let pieces = futures::stream::iter((0..20).map(|_| Ok::<_, std::io::Error>(vec![0_u8; 100])));
    let request = api
        .request("POST", "/v1/models")
        .header("content-type", "application/zip")
        .body(reqwest::Body::wrap_stream(pieces));
    super::app::Answer::of(request.send().await.unwrap()).await.problem(413, "payload-too-large");
    assert_eq!(files_in(&app.data().join("models")), [""; 0]);
    app.stop().await;
}

#[tokio::test]
async fn packages_that_expand_beyond_the_limit_are_refused() {
    let app = TestApp::start_with(|config| config.expanded_bytes = Some(200)).await;
    app.api.upload(model::package(1.0)).await.problem(422, "invalid-package");
    app.stop().await;
}
