//! Contract of the service: it is a file, and the service does what the file says.

use super::app::TestApp;

#[test]
fn the_committed_contract_is_the_generated_one() {
    let generated = rubmap::http::document().to_yaml().unwrap();
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/openapi.yaml");
    if std::env::var_os("RUBMAP_UPDATE_OPENAPI").is_some() {
        std::fs::write(path, &generated).unwrap();
    }
    let committed = std::fs::read_to_string(path).unwrap_or_default();
    assert!(
        committed == generated,
        "openapi.yaml is out of date; run `RUBMAP_UPDATE_OPENAPI=1 cargo test --release --test api openapi`"
    );
}

#[tokio::test]
async fn the_service_serves_its_contract_and_its_health() {
    let app = TestApp::start().await;
    let contract = app.api.get("/openapi.json").await.body;
    assert_eq!(contract["openapi"], "3.1.0");
    assert_eq!(contract, serde_json::to_value(rubmap::http::document()).unwrap());
    for operation in
        contract["paths"].as_object().unwrap().values().flat_map(|path| path.as_object().unwrap())
    {
        assert!(
            operation.1["operationId"].is_string() && operation.1["summary"].is_string(),
            "{operation:?}"
        );
    }
    assert_eq!(app.api.get("/healthz").await.body["status"], "ok");
    assert_eq!(app.api.get("/readyz").await.body["status"], "ok");
    app.stop().await;
}
