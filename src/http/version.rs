//! Version of the program.

use axum::Json;
use serde::Serialize;
use utoipa::ToSchema;

use crate::version;

/// Version of the program: what it was built from, and how.
#[derive(Debug, Serialize, ToSchema)]
pub(super) struct Version {
    /// Version of the program.
    #[schema(example = "0.1.0")]
    version: &'static str,
    /// Commit of the program's sources; `unknown` if they came without their history.
    commit: &'static str,
    /// Profile of the build: `release` or `debug`.
    profile: &'static str,
    /// Target triple of the build.
    target: &'static str,
    /// Features of the processor that every part of the program may use; the inner loops choose more of them at run time.
    target_features: Vec<&'static str>,
}

/// Report what the program was built from.
#[utoipa::path(get, path = "/v1/version", operation_id = "get_version", tag = "service",
    responses((status = 200, description = "Version, commit and build.", body = Version)))]
pub(super) async fn get_version() -> Json<Version> {
    Json(Version {
        version: version::VERSION,
        commit: version::COMMIT,
        profile: version::PROFILE,
        target: version::TARGET,
        target_features: version::TARGET_FEATURES.split(',').filter(|feature| !feature.is_empty()).collect(),
    })
}
