//! Whether the service lives, and whether it can work.

use axum::Json;
use axum::extract::State;
use serde::Serialize;
use utoipa::ToSchema;

use super::AppState;
use super::problem::{Kind, Problem};

/// A sign of life.
#[derive(Debug, Serialize, ToSchema)]
pub(super) struct Health {
    /// Always `ok`.
    #[schema(example = "ok")]
    status: &'static str,
    /// Version of the program.
    version: &'static str,
    /// Memory that reductions may take together, in bytes; absent where nothing is known about it.
    #[serde(skip_serializing_if = "Option::is_none")]
    memory_bytes: Option<u64>,
}

impl Health {
    fn of(state: &AppState) -> Self {
        Self { status: "ok", version: env!("CARGO_PKG_VERSION"), memory_bytes: state.memory_bytes }
    }
}

/// Tell that the process lives.
#[utoipa::path(get, path = "/healthz", operation_id = "get_health", tag = "service",
    responses((status = 200, description = "The process lives.", body = Health)))]
pub(super) async fn get_health(state: State<AppState>) -> Json<Health> {
    Json(Health::of(&state))
}

/// Tell whether the service can work.
#[utoipa::path(get, path = "/readyz", operation_id = "get_readiness", tag = "service",
    responses(
        (status = 200, description = "The database answers.", body = Health),
        (status = 503, description = "The database does not answer.", body = Problem,
            content_type = "application/problem+json"),
    ))]
pub(super) async fn get_readiness(state: State<AppState>) -> Result<Json<Health>, Problem> {
    state.store.ping().await.map_err(|error| {
        tracing::error!(%error, "not ready");
        Problem::new(Kind::Unavailable, "the database does not answer")
    })?;
    Ok(Json(Health::of(&state)))
}
