//! Names, tags and notes of jobs and models.

use reqwest::Method;
use rubmap::tokens::{Scope, new_token};
use serde_json::{Value, json};

use super::app::{Answer, Api, TestApp, modal_analysis_of, sweep_of};
use super::generation::coarse;
use super::model;

async fn patch(api: &Api, path: &str, body: &Value) -> Answer {
    let request = api.request("PATCH", path).header("content-type", "application/merge-patch+json");
    Answer::of(request.body(body.to_string()).send().await.unwrap()).await
}

fn labels(body: &Value) -> Value {
    json!([body["name"], body["tags"], body["notes"]])
}

async fn ids(api: &Api, path: &str, of: &str) -> Vec<String> {
    let answer = api.get(path).await;
    assert_eq!(answer.status, 200, "{}", answer.body);
    answer.body[of].as_array().unwrap().iter().map(|item| item["id"].as_str().unwrap().to_owned()).collect()
}

#[tokio::test]
async fn a_job_is_called_what_its_owner_likes_and_computes_the_same() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let plain = sweep_of(&model);
    let mut request = plain.clone();
    request["name"] = json!("Clearance 0.3, “tight”");
    request["tags"] = json!(["series B", "tight"]);
    request["notes"] = json!("two\nlines");
    assert_eq!(api.post("/v1/sweeps/plan", &request).await.status, 200, "plans take the same body");
    let id = api.sweep(&request).await;
    let unnamed = api.sweep(&plain).await;
    let (job, other) = (api.finish(&id).await, api.finish(&unnamed).await);
    assert_eq!(labels(&job), json!(["Clearance 0.3, “tight”", ["series B", "tight"], "two\nlines"]));
    let called = "springs: 2,865 to 8,594 rpm, clearance 0.3–0.25 mm, 2 lobes of 0.4 mm";
    assert_eq!(labels(&other), json!([called, [], null]));

    // The request is as it was asked for and can be asked for again; the labels are no part of it, nor of what was computed.
    assert_eq!(job["request"], other["request"]);
    assert!(job["request"].get("name").is_none());
    let mut again = job["posted"].clone();
    again["tags"] = json!(["again"]);
    assert_eq!(api.finish(&api.sweep(&again).await).await["request"], job["request"]);
    let map = async |id: &str| {
        let mut map = api.get(&format!("/v1/jobs/{id}/interaction-map")).await.body;
        assert_eq!(map["settings"], job["request"]);
        map["amplitude"].take()
    };
    assert_eq!(map(&id).await, map(&unnamed).await);
    let listed = api.get("/v1/jobs").await.body;
    assert_eq!(labels(&listed["jobs"][2]), labels(&job));
    assert!(listed["jobs"][2].get("request").is_none(), "lists do not");

    // RFC 7396: what is left out stays, null takes away.
    let path = format!("/v1/jobs/{id}");
    let changed = patch(api, &path, &json!({"notes": null, "tags": ["loose"]})).await;
    assert_eq!(changed.status, 200, "{}", changed.body);
    assert_eq!(labels(&changed.body), json!(["Clearance 0.3, “tight”", ["loose"], null]));
    assert_eq!(changed.body["updated_at"], job["updated_at"], "nothing was computed");
    assert_eq!(labels(&patch(api, &path, &json!({})).await.body), labels(&changed.body));
    let as_json = api.request("PATCH", &path).json(&json!({"name": "B", "tags": null})).send().await.unwrap();
    assert_eq!(labels(&Answer::of(as_json).await.body), json!(["B", [], null]));
    assert_eq!(labels(&api.job(&id).await.body), json!(["B", [], null]));
    app.stop().await;
}

#[tokio::test]
async fn a_job_without_a_name_is_called_by_what_it_computes() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let scene = json!({
        "damping": {"modal_ratio": 0.01},
        "casing": {"clearance": {"leading": 0.3, "trailing": 0.2212}, "lobes": {"count": 2, "amplitude": 0.425, "width_rad": 0.35}},
        "contact": {},
    });
    let round = json!({"casing": {"clearance": {"values": [0.25, 0.25]}}, "contact": {}});
    let mut rubbed = round.clone();
    rubbed["friction"] = json!({"coefficient": 0.1});
    rubbed["mistuning"] = json!({"spread": 0.01, "seed": 1});
    let gap = "clearance 0.3–0.221 mm, 2 lobes of 0.425 mm";
    let cases = [
        (
            "sweeps",
            json!({"scene": scene, "speeds": {"values": [24000.0, 12000.0], "unit": "rpm"}}),
            format!("12,000 to 24,000 rpm, {gap}"),
        ),
        (
            "sweeps",
            json!({"scene": round, "speeds": {"values": [200.0], "unit": "hz"}}),
            "12,000 rpm, clearance 0.25 mm".to_owned(),
        ),
        (
            "sweeps",
            json!({"scene": rubbed, "speeds": {"values": [19125.0], "unit": "rpm"}}),
            "19,125 rpm, clearance 0.25 mm, friction, mistuning".to_owned(),
        ),
        (
            "modal-analyses",
            json!({"speeds": {"from": 0.0, "to": 2000.0, "count": 3, "unit": "rad_s"}, "lobes": 2}),
            "modal analysis, 0 to 19,099 rpm".to_owned(),
        ),
        (
            "branches",
            json!({"scene": scene, "speed": {"value": 15000.0, "unit": "rpm"}, "along": {"parameter": "speed", "from": 14000.0, "to": 16000.0}}),
            format!("branches, 14,000 to 16,000 rpm, {gap}"),
        ),
        (
            "branches",
            json!({"scene": scene, "speed": {"value": 15000.0, "unit": "rpm"}, "along": {"parameter": "damping", "from": 0.5, "to": 2.0}}),
            format!("branches, 15,000 rpm, {gap}"),
        ),
        (
            "run-ups",
            json!({"scene": scene, "speed": {"unit": "rpm", "from": 16000.0, "to": 14000.0, "rates": [50000.0]}}),
            format!("run up, 14,000 to 16,000 rpm, {gap}"),
        ),
        (
            "case-studies",
            json!({"scene": scene, "speed": {"value": 15000.0, "unit": "rpm"}}),
            format!("case study, 15,000 rpm, {gap}"),
        ),
        (
            "studies",
            json!({"scene": scene, "speeds": {"values": [15000.0], "unit": "rpm"}}),
            format!("study, 15,000 rpm, {gap}"),
        ),
    ];
    for (route, mut request, name) in cases {
        request["model"] = json!(model);
        let answer = api.post(&format!("/v1/{route}"), &request).await;
        assert_eq!(answer.status, 202, "{route}: {}", answer.body);
        let path = format!("/v1/jobs/{}", answer.text("/id"));
        assert_eq!(api.get(&path).await.body["name"], format!("springs: {name}"), "{route}");
        // An owner who wants none has none.
        assert_eq!(patch(api, &path, &json!({"name": null})).await.body["name"], Value::Null);
    }
    app.stop().await;
}

#[tokio::test]
async fn labels_that_cannot_be_are_refused_where_they_are() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let id = api.post("/v1/modal-analyses", &modal_analysis_of(&model)).await.text("/id");
    let path = format!("/v1/jobs/{id}");
    for (labels, pointers) in [
        (json!({"name": " "}), vec!["/name"]),
        (json!({"name": "n".repeat(201)}), vec!["/name"]),
        (json!({"tags": ["a", "b,c", "a"]}), vec!["/tags/1", "/tags/2"]),
        (json!({"tags": "a"}), vec!["/tags"]),
        (json!({"tags": vec!["a"; 21]}), vec!["/tags"]),
        (json!({"notes": "n".repeat(4001)}), vec!["/notes"]),
        (json!({"notes": 7}), vec!["/notes"]),
    ] {
        assert_eq!(patch(api, &path, &labels).await.pointers(422, "invalid-request"), pointers, "{labels}");
        for route in ["/v1/modal-analyses", "/v1/modal-analyses/plan"] {
            let mut request = modal_analysis_of(&model);
            request.as_object_mut().unwrap().extend(labels.as_object().unwrap().clone());
            assert_eq!(
                api.post(route, &request).await.pointers(422, "invalid-request"),
                pointers,
                "{labels}"
            );
        }
    }
    assert_eq!(patch(api, &path, &json!({"status": "x"})).await.pointers(422, "unknown-field"), ["/status"]);
    let other = api.request("PATCH", &path).header("content-type", "text/plain").body("{}");
    Answer::of(other.send().await.unwrap()).await.problem(415, "unsupported-media-type");
    patch(api, "/v1/jobs/0198c5a2-7c1e-7d54-9f3b-2f6d7a6f4b10", &json!({}))
        .await
        .problem(404, "job-not-found");
    patch(api, "/v1/models/none", &json!({})).await.problem(404, "model-not-found");
    app.stop().await;
}

#[tokio::test]
async fn lists_are_filtered_by_labels_and_model_page_by_page() {
    let app = TestApp::start().await;
    let api = &app.api;
    let [soft, stiff] = [api.model(model::package(1.0)).await, api.model(model::package(2.0)).await];
    let (mut all, mut wanted) = (Vec::new(), Vec::new());
    for index in 0..7 {
        let mut request = modal_analysis_of(if index % 2 == 0 { &soft } else { &stiff });
        request["name"] = json!(format!("Run {index} & co"));
        request["tags"] = json!(if index < 5 { vec!["a+b"] } else { vec!["a", "b"] });
        let id = api.post("/v1/modal-analyses", &request).await.text("/id");
        if index % 2 == 0 && index < 5 {
            wanted.insert(0, id.clone());
        }
        all.push(id);
    }
    let mut path = format!("/v1/jobs?limit=1&model={soft}&tag=a%2Bb&name=%26%20CO&kind=modal_analysis");
    let mut found = Vec::new();
    loop {
        let page = api.get(&path).await.body;
        found.extend(
            page["jobs"].as_array().unwrap().iter().map(|job| job["id"].as_str().unwrap().to_owned()),
        );
        let Some(next) = page["next"].as_str() else { break };
        path = next.to_owned();
    }
    assert_eq!(found, wanted);
    for id in &all {
        api.finish(id).await;
    }
    assert_eq!(ids(api, "/v1/jobs?name=run%203", "jobs").await.len(), 1);
    assert_eq!(ids(api, "/v1/jobs?tag=b&status=successful", "jobs").await.len(), 2);
    assert!(ids(api, "/v1/jobs?tag=b&status=failed", "jobs").await.is_empty());
    for nothing in ["tag=a%2C", "name=%25", "model=x", "tag=%22"] {
        assert!(ids(api, &format!("/v1/jobs?{nothing}"), "jobs").await.is_empty(), "{nothing}");
    }
    app.stop().await;
}

#[tokio::test]
async fn a_model_is_called_what_its_owner_likes() {
    let app = TestApp::start().await;
    let api = &app.api;
    let upload = async |query: &str, package: Vec<u8>| {
        let request = api.request("POST", &format!("/v1/models{query}"));
        Answer::of(request.header("content-type", "application/zip").body(package).send().await.unwrap())
            .await
    };
    let own = upload("", model::package(1.0)).await.body["name"].clone();
    let named = upload("?name=Wheel%20B&tags=soft,series%20B&notes=n", model::package(2.0)).await;
    assert_eq!(named.status, 201, "{}", named.body);
    assert_eq!(labels(&named.body), json!(["Wheel B", ["soft", "series B"], "n"]));
    assert_eq!(
        upload("?tags=a,a", model::package(3.0)).await.problem(400, "invalid-parameter")[0]["parameter"],
        "tags"
    );
    assert_eq!(upload("?name=other", model::package(2.0)).await.body["name"], "Wheel B", "it is known");

    let path = format!("/v1/models/{}", named.text("/id"));
    assert_eq!(ids(api, "/v1/models?name=wheel%20b&tag=soft", "models").await, [named.text("/id")]);
    assert!(ids(api, "/v1/models?tag=sof", "models").await.is_empty());
    let own_name = own.as_str().unwrap().replace(' ', "%20");
    assert_eq!(ids(api, &format!("/v1/models?name={own_name}"), "models").await.len(), 1);
    let changed = patch(api, &path, &json!({"name": null, "tags": ["t"]})).await;
    assert_eq!(labels(&changed.body), json!([own, ["t"], "n"]), "{}", changed.body);
    assert!(changed.body["reductions"].is_array());
    assert_eq!(labels(&api.get("/v1/models?limit=1").await.body["models"][0]), labels(&changed.body));

    // A generated model has the labels that its job has when it is made.
    let mut request = coarse();
    request["name"] = json!("Generated");
    assert_eq!(api.post("/v1/models/plan", &request).await.status, 200);
    let in_query = api.post("/v1/models?name=x", &coarse()).await;
    in_query.problem(400, "invalid-parameter");
    let job = api.post("/v1/models", &request).await.text("/id");
    let job = api.finish(&job).await;
    assert_eq!((&job["status"], &job["name"]), (&json!("successful"), &json!("Generated")), "{job}");
    let made = api.get(&format!("/v1/models/{}", job["model"].as_str().unwrap())).await.body;
    assert_eq!(made["name"], "Generated");
    assert_eq!(job["request"]["sectors"], made["sectors"]);
    app.stop().await;
}

#[tokio::test]
async fn labels_are_part_of_what_an_idempotency_key_stands_for() {
    let app = TestApp::start().await;
    let api = &app.api;
    let model = api.model(model::package(1.0)).await;
    let post = async |name: &str| {
        let mut request = sweep_of(&model);
        request["name"] = name.into();
        let request = api.request("POST", "/v1/sweeps").header("Idempotency-Key", "k").json(&request);
        Answer::of(request.send().await.unwrap()).await
    };
    let first = post("a").await;
    patch(api, &first.location.clone().unwrap(), &json!({"name": "later"})).await;
    assert_eq!(post("a").await.body, first.body);
    post("b").await.problem(422, "idempotency-key-reused");
    let upload = async |query: &str| {
        let request = api.request("POST", &format!("/v1/models{query}")).header("Idempotency-Key", "m");
        let request = request.header("content-type", "application/zip").body(model::package(4.0));
        Answer::of(request.send().await.unwrap()).await
    };
    assert_eq!(
        (upload("?name=a").await.status, upload("?name=a").await.status),
        (201.try_into().unwrap(), 201.try_into().unwrap())
    );
    upload("?name=b").await.problem(422, "idempotency-key-reused");
    app.stop().await;
}

#[tokio::test]
async fn nobody_labels_what_is_not_theirs() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("tokens");
    let token = |owner, scope| new_token(&file, owner, scope).unwrap();
    let (alice, reader) = (token("alice", Scope::Write), token("alice", Scope::Read));
    let bob = token("bob", Scope::Write);
    let app = TestApp::start_with(|config| config.tokens = Some(file)).await;
    let send = async |token: &str, method: Method, path: &str, body: Value| {
        let request = app.api.request(method.as_str(), path).bearer_auth(token);
        let request = if body.is_null() { request } else { request.json(&body) };
        Answer::of(request.send().await.unwrap()).await
    };
    let mut models = Vec::new();
    for token in [&alice, &bob] {
        let request = app.api.request("POST", "/v1/models").bearer_auth(token);
        let request = request.header("content-type", "application/zip").body(model::package(1.0));
        models.push(Answer::of(request.send().await.unwrap()).await.text("/id"));
    }
    let model = format!("/v1/models/{}", models[0]);
    let job = send(&alice, Method::POST, "/v1/modal-analyses", modal_analysis_of(&models[0])).await;
    let job = format!("/v1/jobs/{}", job.text("/id"));
    for path in [&model, &job] {
        let refused = send(&reader, Method::PATCH, path, json!({"name": "r"})).await;
        refused.problem(403, "forbidden");
        assert_eq!(send(&alice, Method::PATCH, path, json!({"name": "hers"})).await.status, 200);
    }
    send(&bob, Method::PATCH, &job, json!({"name": "his"})).await.problem(404, "job-not-found");
    assert!(
        send(&bob, Method::GET, "/v1/jobs?name=hers", Value::Null).await.body["jobs"]
            .as_array()
            .unwrap()
            .is_empty()
    );
    // Each owner gives the same content a name of their own.
    assert_ne!(send(&bob, Method::GET, &model, Value::Null).await.body["name"], "hers");
    send(&bob, Method::PATCH, &model, json!({"name": "his"})).await;
    assert_eq!(send(&alice, Method::GET, &model, Value::Null).await.body["name"], "hers");
    assert_eq!(
        send(&bob, Method::GET, "/v1/models?name=HIS", Value::Null).await.body["models"]
            .as_array()
            .unwrap()
            .len(),
        1
    );
    app.stop().await;
}
