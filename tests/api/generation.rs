//! Models from parameters of the generator.

use std::process::Command;

use serde_json::{Value, json};

use super::app::{Answer, Api, TestApp, modal_analysis_of};
use super::model::files_in;

/// Parameters of a mesh as coarse as it gets.
pub(crate) fn coarse() -> Value {
    json!({
        "preset": "small",
        "contact_nodes": 3,
        "mesh": {"between_contact_nodes": 1, "blade_height": 2, "blade_thickness": 1, "half_passage": 1, "disk": 1},
    })
}

async fn generation_of(api: &Api, parameters: &Value) -> String {
    let answer = api.post("/v1/models", parameters).await;
    assert_eq!(answer.status, 202, "{}", answer.body);
    assert_eq!(answer.text("/kind"), "model_generation");
    let id = answer.text("/id");
    assert_eq!(answer.location, Some(format!("/v1/jobs/{id}")));
    id
}

/// Package that `rubmap generate` makes.
fn generated_by_command(parameters: &Value) -> Vec<u8> {
    let folder = tempfile::tempdir().unwrap();
    let [file, zip] = ["parameters.json", "impeller.zip"].map(|name| folder.path().join(name));
    std::fs::write(&file, parameters.to_string()).unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_rubmap"));
    let ended =
        command.arg("generate").arg("--parameters").arg(&file).arg("--out").arg(&zip).output().unwrap();
    assert!(ended.status.success(), "{}", String::from_utf8_lossy(&ended.stderr));
    std::fs::read(zip).unwrap()
}

#[tokio::test]
async fn a_generated_model_is_the_one_that_would_be_uploaded() {
    let app = TestApp::start().await;
    let api = &app.api;
    let id = generation_of(api, &coarse()).await;
    let job = api.finish(&id).await;
    assert_eq!((&job["status"], &job["progress"]), (&"successful".into(), &100.into()), "{job}");
    let model = job["model"].as_str().unwrap();
    let link = json!({"href": format!("/v1/models/{model}"), "rel": "model"});
    assert!(job["links"].as_array().unwrap().contains(&link), "{job}");
    assert!(job.get("speeds").is_none(), "{job}");
    let detail = api.get(&format!("/v1/models/{model}")).await.body;
    assert_eq!((&detail["sectors"], &detail["contact_nodes"]), (&10.into(), &3.into()));

    let uploaded = api.upload(generated_by_command(&coarse())).await;
    assert_eq!((uploaded.status.as_u16(), uploaded.text("/id").as_str()), (200, model));
    assert_eq!(uploaded.body["size_bytes"], detail["size_bytes"]);

    // Another generation of the same model finds it there, and it serves like any other.
    let again = api.finish(&generation_of(api, &coarse()).await).await;
    assert_eq!(again["model"], model);
    assert_eq!(files_in(&app.data().join("models")), [format!("{model}.zip")]);
    let analysis = api.post("/v1/modal-analyses", &modal_analysis_of(model)).await.text("/id");
    assert_eq!(api.finish(&analysis).await["status"], "successful");

    api.get(&format!("/v1/jobs/{id}/campbell")).await.problem(409, "wrong-job-kind");
    api.get(&format!("/v1/jobs/{id}/interaction-map")).await.problem(409, "wrong-job-kind");
    let listed = api.get("/v1/jobs?kind=model_generation").await.body;
    assert_eq!(listed["jobs"].as_array().unwrap().len(), 2);
    // The job outlives its model.
    assert_eq!(api.delete(&format!("/v1/models/{model}")).await.status, 204);
    assert_eq!(api.job(&id).await.text("/model"), model);
    app.stop().await;
}

#[tokio::test]
async fn waves_of_a_model_with_gyroscopic_matrix() {
    let app = TestApp::start().await;
    let api = &app.api;
    let mut models = Vec::new();
    for gyroscopic in [false, true] {
        let mut parameters = coarse();
        parameters["gyroscopic"] = gyroscopic.into();
        let job = api.finish(&generation_of(api, &parameters).await).await;
        let model = job["model"].as_str().unwrap().to_owned();
        assert_eq!(api.get(&format!("/v1/models/{model}")).await.body["gyroscopic"], gyroscopic);
        models.push(model);
    }
    let [without, with] = [&models[0], &models[1]].map(|model| {
        let mut request = modal_analysis_of(model);
        request["coriolis"] = true.into();
        request
    });
    assert_eq!(
        api.post("/v1/modal-analyses", &without).await.pointers(422, "invalid-request"),
        ["/coriolis"]
    );
    let analysis = api.post("/v1/modal-analyses", &with).await.text("/id");
    assert_eq!(api.finish(&analysis).await["status"], "successful");
    let campbell = api.get(&format!("/v1/jobs/{analysis}/campbell")).await.body;
    let at =
        |table: &str, nodal_diameter: usize| campbell["waves"][table][6][nodal_diameter][0].as_f64().unwrap();
    for nodal_diameter in 0..=5 {
        let split = at("backward_hz", nodal_diameter) != at("forward_hz", nodal_diameter);
        assert_eq!(split, (1..5).contains(&nodal_diameter), "nodal diameter {nodal_diameter} of 10 sectors");
    }
    app.stop().await;
}

#[tokio::test]
async fn bad_parameters_are_refused_at_once() {
    let app = TestApp::start().await;
    let api = &app.api;
    for (parameters, kind, pointer) in [
        (json!({"sectors": 1}), "invalid-request", "/sectors"),
        (json!({"sectors": -1}), "invalid-request", "/sectors"),
        (json!({"outlet_radius": "wide"}), "invalid-request", "/outlet_radius"),
        (json!({"mesh": {"disk": 0}}), "invalid-request", "/mesh/disk"),
        (json!({"mesh": {"disc": 3}}), "unknown-field", "/mesh/disc"),
        (json!({"wings": 2}), "unknown-field", "/wings"),
        (json!({"units": {"length": "mm", "force": "N", "time": "s"}}), "invalid-request", "/units/mass"),
        (json!({"mesh": [1, 1, 1, 1, 1]}), "invalid-request", "/mesh"),
        (json!({"preset": "enormous"}), "invalid-request", "/preset"),
        (json!({"units": ["mm", "N", "s", "t"]}), "invalid-request", "/units"),
        (
            json!({"units": {"length": "m", "force": "N", "time": "s", "mass": "t"}}),
            "invalid-request",
            "/units",
        ),
        (
            json!({"units": {"length": "l".repeat(41), "force": "N", "time": "s", "mass": "t"}}),
            "invalid-request",
            "/units/length",
        ),
    ] {
        // A model whose plan is accepted can be made.
        for path in ["/v1/models", "/v1/models/plan"] {
            let answer = api.post(path, &parameters).await;
            assert_eq!(answer.pointers(422, kind), [pointer], "{path}: {}", answer.body);
        }
    }
    for parameters in [json!({"q".repeat(1 << 16): 1}), json!({"sectors": "q".repeat(1 << 16)})] {
        let answer = api.post("/v1/models", &parameters).await;
        assert_eq!(answer.status, 422);
        assert!(answer.body.to_string().len() < 4096, "{}", answer.body.to_string().len());
    }
    let broken = api.request("POST", "/v1/models").header("content-type", "application/json").body("{");
    Answer::of(broken.send().await.unwrap()).await.problem(400, "malformed-json");
    assert_eq!(api.get("/v1/jobs").await.body["jobs"], json!([]), "no job was made");
    app.stop().await;
}

#[tokio::test]
async fn a_repeated_generation_gets_its_first_answer_again() {
    let app = TestApp::start().await;
    let post = |parameters: Value| {
        let request =
            app.api.request("POST", "/v1/models").header("Idempotency-Key", "wheel").json(&parameters);
        async { Answer::of(request.send().await.unwrap()).await }
    };
    let first = post(coarse()).await;
    assert_eq!(first.status, 202, "{}", first.body);
    assert_eq!(post(coarse()).await.body, first.body);
    post(json!({})).await.problem(422, "idempotency-key-reused");
    assert_eq!(app.api.get("/v1/jobs").await.body["jobs"].as_array().unwrap().len(), 1);
    app.stop().await;
}

#[tokio::test]
async fn a_cancelled_generation_leaves_nothing() {
    let app = TestApp::start().await;
    let api = &app.api;
    // The default mesh takes long enough to be caught in the middle.
    let id = generation_of(api, &json!({})).await;
    api.follow(&id, |job| job["status"] == "running").await;
    assert_eq!(api.delete(&format!("/v1/jobs/{id}")).await.text("/status"), "dismissed");
    // Whatever comes after it on one worker comes when it has stopped.
    let other = api.finish(&generation_of(api, &coarse()).await).await;
    assert_eq!(other["status"], "successful", "{other}");
    let job = api.job(&id).await.body;
    assert!(job["status"] == "dismissed" && job.get("model").is_none(), "{job}");
    app.stop().await;
}

#[tokio::test]
async fn parameters_that_only_the_mesh_shows_to_be_impossible_are_refused() {
    let app = TestApp::start().await;
    let mut parameters = coarse();
    // The blades are thicker than the passage between them.
    parameters["root_thickness"] = json!(200.0);
    parameters["tip_thickness"] = json!(200.0);
    for path in ["/v1/models/plan", "/v1/models"] {
        let refused = app.api.post(path, &parameters).await;
        assert_eq!(refused.pointers(422, "invalid-request").len(), 1, "{path}: {}", refused.body);
        assert!(refused.body["detail"].as_str().unwrap().contains("thickness"), "{path}: {}", refused.body);
    }
    parameters["sectors"] = json!(1_000_000_000_000_000_000u64);
    assert_eq!(app.api.post("/v1/models", &parameters).await.pointers(422, "invalid-request"), ["/sectors"]);
    app.stop().await;
}

#[tokio::test]
async fn a_generation_beyond_the_memory_is_refused_with_what_to_do() {
    let app = TestApp::start_with(|config| config.memory_bytes = Some(1 << 20)).await;
    let job = app.api.finish(&generation_of(&app.api, &coarse()).await).await;
    assert_eq!(job["status"], "failed", "{job}");
    assert_eq!(job["error"]["type"], "urn:rubmap:problem:out-of-memory", "{job}");
    let detail = job["error"]["detail"].as_str().unwrap();
    for words in ["needs about", "may take 0.9 MiB", "coarser mesh", "--memory-bytes"] {
        assert!(detail.contains(words), "{words:?} is not in {detail:?}");
    }
    assert_eq!(files_in(&app.data().join("models")), [""; 0], "nothing was begun");
    app.stop().await;
}

#[tokio::test]
async fn a_generation_that_needs_more_than_a_share_gets_more() {
    // An eighth of it is too little for the default mesh.
    let app = TestApp::start_with(|config| config.memory_bytes = Some(256 << 20)).await;
    let job = app.api.finish(&generation_of(&app.api, &json!({})).await).await;
    assert_eq!(job["status"], "successful", "{job}");
    app.stop().await;
}
