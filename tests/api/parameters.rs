//! Parameters in query and path: a route refuses those it does not know, and answers "not found" where one is no text.

use super::app::{Answer, TestApp};

/// Every route of the contract with its method; path parameters are filled in.
fn routes() -> Vec<(String, String)> {
    let document = serde_json::to_value(rubmap::http::document()).unwrap();
    let mut routes = Vec::new();
    for (path, methods) in document["paths"].as_object().unwrap() {
        for (method, operation) in methods.as_object().unwrap() {
            // What any route may answer, bad parameters among it.
            let refused = &operation["responses"]["default"]["$ref"];
            assert_eq!(refused, "#/components/responses/Refused", "{method} {path}");
            let path = path.replace("{id}", "0198c5a2-7c1e-7d54-9f3b-2f6d7a6f4b10").replace("{index}", "0");
            routes.push((method.to_uppercase(), path));
        }
    }
    routes
}

#[tokio::test]
async fn no_route_ignores_a_parameter() {
    let app = TestApp::start().await;
    let routes = routes();
    assert!(routes.len() > 20, "{routes:?}");
    for (method, path) in routes {
        let request = app.api.request(&method, &format!("{path}?nonsense=1"));
        let items = Answer::of(request.send().await.unwrap()).await.problem(400, "invalid-parameter");
        assert_eq!(items[0]["parameter"], "nonsense", "{method} {path}");
    }
    let head = app.api.request("HEAD", "/healthz?nonsense=1").send().await.unwrap();
    assert_eq!(head.status(), 400);
    app.api.get("/v2/nothing?nonsense=1").await.problem(404, "not-found");
    app.api.delete("/v1/sweeps?nonsense=1").await.problem(405, "method-not-allowed");
    app.stop().await;
}

#[tokio::test]
async fn parameters_are_refused_in_words() {
    let app = TestApp::start().await;
    let job = "/v1/jobs/0198c5a2-7c1e-7d54-9f3b-2f6d7a6f4b10";
    for (path, parameter, detail) in [
        ("/v1/jobs?limit=501", "limit", "expected a whole number from 1 to 500, not \"501\""),
        ("/v1/jobs?limit=2&limit=2", "limit", "this parameter is given twice; give it once"),
        (
            "/v1/jobs?Limit=2",
            "Limit",
            "there is no such parameter; this path takes status, kind, model, name, tag, limit, cursor",
        ),
        ("/readyz?x", "x", "there is no such parameter; this path takes no parameters"),
        (
            &format!("{job}/interaction-map?sensor=-1"),
            "sensor",
            "expected a whole number from 0 to 4294967295, not \"-1\"",
        ),
        (
            &format!("{job}/histories?format=pdf"),
            "format",
            "expected one of json, csv, npz, svg, png, plotly, not \"pdf\"",
        ),
        (
            &format!("{job}/histories?sensor=%FF"),
            "sensor",
            "expected a whole number from 0 to 4294967295, not \"\u{fffd}\"",
        ),
    ] {
        let items = app.api.get(path).await.problem(400, "invalid-parameter");
        assert_eq!(
            (&items[0]["parameter"], &items[0]["detail"]),
            (&parameter.into(), &detail.into()),
            "{path}"
        );
    }
    let name = "n".repeat(5000);
    let answer = app.api.get(&format!("/v1/jobs?{name}=1")).await;
    answer.problem(400, "invalid-parameter");
    assert!(answer.body.to_string().len() < 1000, "{}", answer.body);
    app.stop().await;
}

#[tokio::test]
async fn what_is_no_text_is_not_found() {
    let app = TestApp::start().await;
    let job = "/v1/jobs/0198c5a2-7c1e-7d54-9f3b-2f6d7a6f4b10";
    for (method, path, kind) in [
        ("GET", "/v1/models/%FF", "model-not-found"),
        ("DELETE", "/v1/models/%FF", "model-not-found"),
        ("GET", "/v1/jobs/%FF", "job-not-found"),
        ("DELETE", "/v1/jobs/%FF", "job-not-found"),
        ("GET", "/v1/jobs/%FF/campbell", "job-not-found"),
        ("GET", "/v1/jobs/%FF/interaction-map", "job-not-found"),
        ("GET", "/v1/jobs/%FF/spectra/0", "job-not-found"),
        ("GET", &format!("{job}/spectra/%FF"), "speed-not-found"),
        ("GET", &format!("{job}/wear/%FF"), "speed-not-found"),
        ("GET", "/v1/jobs/%FF/histories", "job-not-found"),
    ] {
        let request = app.api.request(method, path);
        Answer::of(request.send().await.unwrap()).await.problem(404, kind);
    }
    app.stop().await;
}
