//! Stub of a service that behaves as a test wants.

use std::sync::{Arc, Mutex};

use axum::Router;
use axum::extract::Request;
use axum::response::{IntoResponse, Response};
use serde_json::{Value, json};

/// Service whose answers are a function of the request and of how many requests came before it.
pub(crate) struct Stub {
    pub(crate) address: String,
    /// Method and path of every request, with its idempotency key.
    asked: Arc<Mutex<Vec<(String, String)>>>,
    /// Runtime of the service, which ends with the stub.
    _runtime: tokio::runtime::Runtime,
}

impl Stub {
    pub(crate) fn start<F, R>(answer: F) -> Self
    where
        F: Fn(usize, Request) -> R + Clone + Send + Sync + 'static,
        R: Future<Output = Response> + Send,
    {
        let runtime =
            tokio::runtime::Builder::new_multi_thread().worker_threads(1).enable_all().build().unwrap();
        let listener = runtime.block_on(tokio::net::TcpListener::bind("127.0.0.1:0")).unwrap();
        let address = listener.local_addr().unwrap().to_string();
        let asked = Arc::<Mutex<Vec<_>>>::default();
        let noted = Arc::clone(&asked);
        let handler = move |request: Request| {
            let key = request.headers().get("idempotency-key").map(|key| key.to_str().unwrap().to_owned());
            let what = format!("{} {}", request.method(), request.uri().path());
            let before = {
                let mut noted = noted.lock().unwrap();
                noted.push((what, key.unwrap_or_default()));
                noted.len() - 1
            };
            answer(before, request)
        };
        runtime.spawn(async { axum::serve(listener, Router::new().fallback(handler)).await });
        Self { address, asked, _runtime: runtime }
    }

    pub(crate) fn asked(&self) -> Vec<(String, String)> {
        self.asked.lock().unwrap().clone()
    }
}

/// Id of the one job of a stub.
pub(crate) const JOB: &str = "0198c5a2-7c1e-7d54-9f3b-2f6d7a6f4b10";

/// Body of the stub's job in a state.
pub(crate) fn job(status: &str, progress: u64) -> Value {
    json!({
        "id": JOB, "kind": "sweep", "status": status, "progress": progress, "links": [],
        "speeds": {"total": 10, "finished": progress / 10}, "a field of later versions": 1,
    })
}

/// Response that reports a problem.
pub(crate) fn problem(status: u16, kind: &str, retry_after_s: Option<u32>) -> Response {
    let mut body = json!({"type": format!("urn:rubmap:problem:{kind}"), "title": "No", "status": status, "detail": "not now"});
    if let Some(seconds) = retry_after_s {
        body["retry_after_s"] = seconds.into();
    }
    (axum::http::StatusCode::from_u16(status).unwrap(), axum::Json(body)).into_response()
}
