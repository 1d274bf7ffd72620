//! Errors of all kinds: the answer is a problem.

use serde_json::json;

use super::app::{Answer, TestApp, sweep_of};
use super::model;

#[tokio::test]
async fn routes_methods_and_ids_that_do_not_exist() {
    let app = TestApp::start().await;
    let api = &app.api;
    api.get("/v2/nothing").await.problem(404, "not-found");
    api.delete("/v1/sweeps").await.problem(405, "method-not-allowed");
    api.get("/v1/models/none").await.problem(404, "model-not-found");
    api.delete("/v1/models/none").await.problem(404, "model-not-found");
    api.get("/v1/jobs/not-an-id").await.problem(404, "job-not-found");
    for path in ["", "/interaction-map", "/critical-speeds", "/campbell", "/spectra/0"] {
        let path = format!("/v1/jobs/0198c5a2-7c1e-7d54-9f3b-2f6d7a6f4b10{path}");
        let answer = api.get(&path).await;
        answer.problem(404, "job-not-found");
        assert_eq!(answer.text("/instance"), path);
    }
    app.stop().await;
}

#[tokio::test]
async fn bodies_that_cannot_be_read() {
    let app = TestApp::start().await;
    let post = |content_type: &'static str, body: String| {
        let request = app.api.request("POST", "/v1/sweeps").header("content-type", content_type).body(body);
        async { Answer::of(request.send().await.unwrap()).await }
    };
    post("text/plain", "{}".into()).await.problem(415, "unsupported-media-type");
    let items = post("application/json", "{\"model\": \n oops}".into()).await.problem(400, "malformed-json");
    assert_eq!((&items[0]["line"], &items[0]["column"]), (&json!(2), &json!(2)));
    post("application/json", " ".repeat(3 << 20)).await.problem(413, "payload-too-large");
    let encoded = app.api.request("POST", "/v1/sweeps").header("content-type", "application/json");
    let encoded =
        Answer::of(encoded.header("content-encoding", "gzip").body("{}").send().await.unwrap()).await;
    assert_eq!(encoded.problem(415, "unsupported-media-type")[0]["parameter"], "Content-Encoding");
    post("application/json; charset=utf-8", "[]".into()).await.problem(422, "invalid-request");

    let upload = app.api.request("POST", "/v1/models").header("content-type", "application/gzip").body("{}");
    Answer::of(upload.send().await.unwrap()).await.problem(415, "unsupported-media-type");
    app.stop().await;
}

#[tokio::test]
async fn fields_that_do_not_exist_or_make_no_sense() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;

    let mut request = sweep_of(&model);
    request["scene"]["casing"]["lobes"]["hight"] = json!(1.0);
    assert_eq!(
        api.post("/v1/sweeps", &request).await.pointers(422, "unknown-field"),
        ["/scene/casing/lobes/hight"]
    );

    let mut request = sweep_of(&model);
    request["speeds"]["unit"] = json!("furlongs");
    assert_eq!(api.post("/v1/sweeps", &request).await.pointers(422, "invalid-request"), ["/speeds/unit"]);

    let mut request = sweep_of(&model);
    let range = |count: u32| json!({"from": 300.0, "to": 400.0, "count": count, "unit": "rad_s"});
    request["speeds"] = json!([range(3), range(0)]);
    assert_eq!(api.post("/v1/sweeps", &request).await.pointers(422, "invalid-request"), ["/speeds/1/count"]);
    request["speeds"] = json!([range(3), {"values": [0.0], "unit": "hz"}]);
    assert_eq!(api.post("/v1/sweeps", &request).await.pointers(422, "invalid-request"), ["/speeds/1"]);

    let mut request = sweep_of(&model);
    request.as_object_mut().unwrap().remove("scene");
    assert_eq!(api.post("/v1/sweeps", &request).await.pointers(422, "invalid-request"), ["/scene"]);

    let request = sweep_of("0000");
    assert_eq!(api.post("/v1/sweeps", &request).await.pointers(422, "invalid-request"), ["/model"]);
    app.stop().await;
}

#[tokio::test]
async fn all_violations_come_at_once() {
    let app = TestApp::start().await;
    let model = app.api.model(model::package(1.0)).await;
    let mut request = sweep_of(&model);
    request["sensors"] = json!([{"contact_node": 7, "component": "radial"}]);
    request["integration"]["window_revolutions"] = json!(99);
    request["scene"]["damping"]["modal_ratio"] = json!(-1.0);
    let pointers = app.api.post("/v1/sweeps", &request).await.pointers(422, "invalid-request");
    for field in ["/sensors/0/contact_node", "/integration/window_revolutions", "/scene/damping/modal_ratio"]
    {
        assert!(pointers.iter().any(|pointer| pointer == field), "{field} is not in {pointers:?}");
    }
    app.stop().await;
}

#[tokio::test]
async fn parameters_that_make_no_sense() {
    let app = TestApp::start().await;
    let api = &app.api;
    for (query, parameter) in [
        ("limit=0", "limit"),
        ("limit=many", "limit"),
        ("status=lost", "status"),
        ("cursor=here", "cursor"),
        ("colour=red", "colour"),
    ] {
        let items = api.get(&format!("/v1/jobs?{query}")).await.problem(400, "invalid-parameter");
        assert_eq!(items[0]["parameter"], parameter, "{query}");
    }
    app.stop().await;
}
