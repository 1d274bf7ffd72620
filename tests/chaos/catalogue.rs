//! Catalogue of requests to the service: a job of every kind, long enough to be disturbed.

use std::time::Duration;

use serde_json::{Value, json};

use super::app::{Api, long_sweep_of, modal_analysis_of, sweep_of};
use super::model;

/// Kind of a job.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Kind {
    Sweep,
    Chain,
    Refined,
    ModalAnalysis,
    Study,
    Generation,
}

pub(crate) const KINDS: [Kind; 6] =
    [Kind::Sweep, Kind::Chain, Kind::Refined, Kind::ModalAnalysis, Kind::Study, Kind::Generation];

/// Number of attempts at a request before it is given up: the service may be down, full, locked.
const ATTEMPTS: u32 = 3;

/// Longest wait for an answer: the service may be stopped in the middle of it.
const PATIENCE: Duration = Duration::from_secs(10);

impl Kind {
    /// Posts a job of this kind, with what it needs; returns its id, if it was accepted. The same key is used for every attempt.
    pub(crate) async fn post(self, api: &Api, key: &str) -> Option<String> {
        if self == Self::Generation {
            return id_of(api, "/v1/models", &json!({"sectors": 7}), key).await;
        }
        let model = upload(api).await?;
        let (path, request) = match self {
            Self::Sweep => ("/v1/sweeps", long_sweep_of(&model, 8)),
            Self::Chain => {
                let mut request = long_sweep_of(&model, 5);
                request["sweep"] = "up".into();
                ("/v1/sweeps", request)
            }
            Self::Refined => {
                let mut request = sweep_of(&model);
                request["refine"] = true.into();
                request["integration"]["revolutions"] = 100.into();
                ("/v1/sweeps", request)
            }
            Self::ModalAnalysis => {
                let mut request = modal_analysis_of(&model);
                request["modes_per_speed"] = 2.into();
                ("/v1/modal-analyses", request)
            }
            Self::Study | Self::Generation => ("/v1/studies", study_of(&model)),
        };
        id_of(api, path, &request, key).await
    }
}

fn study_of(model: &str) -> Value {
    let sweep = sweep_of(model);
    json!({
        "model": model,
        "speeds": {"values": [700.0], "unit": "rad_s"},
        "scene": sweep["scene"],
        "integration": {"revolutions": 12, "ramp_revolutions": 1.0, "window_revolutions": 4},
        "grid": {"modes_per_speed": [2, 3], "schemes": ["exact_modal"], "steps_per_revolution": [400, 800]},
        "max_engine_order": 8,
    })
}

async fn id_of(api: &Api, path: &str, body: &Value, key: &str) -> Option<String> {
    let (status, answer) =
        attempt(|| api.request("POST", path).header("idempotency-key", key).json(body)).await?;
    assert_eq!(status, 202, "{answer}");
    Some(answer["id"].as_str().unwrap().to_owned())
}

/// Uploads the model that all jobs but generations compute from.
async fn upload(api: &Api) -> Option<String> {
    let package = model::package(1.0);
    let request =
        || api.request("POST", "/v1/models").header("content-type", "application/zip").body(package.clone());
    let (_, answer) = attempt(request).await?;
    Some(answer["id"].as_str().unwrap().to_owned())
}

/// Sends a request until an answer is no temporary refusal; returns its status and body.
async fn attempt(request: impl Fn() -> reqwest::RequestBuilder) -> Option<(u16, Value)> {
    for _ in 0..ATTEMPTS {
        if let Ok(response) = request().timeout(PATIENCE).send().await {
            let status = response.status().as_u16();
            if response.status().is_success() {
                // What broke off is asked for again; the key, or the content, makes it the same.
                if let Ok(body) = response.json().await {
                    return Some((status, body));
                }
            } else {
                assert!(
                    [503, 507].contains(&status),
                    "{status}: {}",
                    response.text().await.unwrap_or_default()
                );
            }
        }
        tokio::time::sleep(Duration::from_millis(200)).await;
    }
    None
}

/// Result of a successful job, without times.
pub(crate) async fn result_of(api: &Api, kind: Kind, job: &Value) -> Value {
    let id = job["id"].as_str().unwrap();
    let get = async |path: &str| {
        let mut body = api.get(&format!("/v1/jobs/{id}/{path}")).await.body;
        forget_times(&mut body);
        body
    };
    match kind {
        Kind::Sweep | Kind::Chain | Kind::Refined => json!([
            get("interaction-map").await,
            get("critical-speeds").await,
            get("spectra/0").await,
            get("spectra/3").await,
        ]),
        Kind::ModalAnalysis => get("campbell").await,
        Kind::Study => get("histories").await,
        Kind::Generation => job["model"].clone(),
    }
}

/// Sets to null the fields that another run of the same job would not repeat.
fn forget_times(value: &mut Value) {
    match value {
        Value::Object(fields) => {
            for (name, field) in fields {
                if name.contains("time_s") || ["plan", "spent"].contains(&name.as_str()) {
                    *field = Value::Null;
                } else {
                    forget_times(field);
                }
            }
        }
        Value::Array(items) => items.iter_mut().for_each(forget_times),
        _ => {}
    }
}
