//! Looks at meshes before models are made of them.

use axum::Json;
use axum::extract::{Request, State};
use serde::Deserialize;
use utoipa::IntoParams;

use super::extract::{Parameters, declared_bytes, expect_media_type};
use super::models::{MESH, MeshBytes};
use super::problem::Problem;
use super::state::AppState;
use crate::from_mesh::{MeshLook, MeshSettings};

/// Settings of the model that may be made of the mesh.
#[derive(Debug, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
pub(super) struct LookQuery {
    /// Settings of the model: a JSON object of the schema `MeshSettings`, each field of which may be left out here.
    settings: Option<String>,
}

/// Look at a mesh before a model is made of it.
///
/// The answer has the skin of the mesh as triangles, its smooth patches and sharp edges, the cyclic faces, the clamp and the contact line as
/// far as they were found, and the estimated cost of making the model. A search that fails does not end the look: `refusals` has its reason.
/// Material and top speed are not needed. Nothing is stored: post the mesh again to `/v1/models`, with patches and edges that you chose in
/// `clamp_at`, `contact_at` and `contact_between` of the settings.
#[utoipa::path(post, path = "/v1/meshes/look", operation_id = "look_at_mesh", tag = "models", params(LookQuery),
    request_body(description = "Mesh of one sector.", content((MeshBytes = "application/octet-stream"))),
    responses(
        (status = 200, description = "The mesh, and what was found in it.", body = MeshLook),
        (status = 400, description = "The settings are not valid, or the upload broke off.", body = Problem,
            content_type = "application/problem+json"),
        (status = 408, description = "The upload stopped coming.", body = Problem,
            content_type = "application/problem+json"),
        (status = 413, description = "The upload is larger than the service allows.", body = Problem,
            content_type = "application/problem+json"),
        (status = 415, description = "The body is not declared as application/octet-stream.", body = Problem,
            content_type = "application/problem+json"),
        (status = 422, description = "The mesh cannot be read: `errors` has its line. Or settings contradict each other.", body = Problem,
            content_type = "application/problem+json"),
    ))]
pub(super) async fn look_at_mesh(
    state: State<AppState>,
    Parameters(query): Parameters<LookQuery>,
    request: Request,
) -> Result<Json<MeshLook>, Problem> {
    expect_media_type(request.headers(), &[MESH])?;
    let importer = &state.importer;
    importer.check_size(declared_bytes(request.headers()))?;
    let settings = MeshSettings::of_look(query.settings.as_deref().unwrap_or("{}").as_bytes())
        .map_err(|error| Problem::parameter("settings", error.to_string()))?;
    let upload = importer.receive(request.into_body().into_data_stream(), |_| ()).await?;
    Ok(Json(importer.look(upload, settings).await??))
}
