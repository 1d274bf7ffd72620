//! Mesh of a model.

use axum::extract::State;
use axum::response::Response;
use serde::Deserialize;
use utoipa::IntoParams;

use super::download::{Download, DownloadQuery, Next};
use super::extract::{ModelPath, Parameters};
use super::field;
use super::form::Form;
use super::models::model_not_found;
use super::problem::Problem;
use super::state::AppState;
use crate::analysis::fields::Field;
use crate::export::fields::FieldFile;
use crate::jobs;
use crate::tokens::Principal;

/// Part of a mesh to download.
#[derive(Debug, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
pub(super) struct MeshQuery {
    /// Index of the one sector to download, from 0; default all sectors.
    sector: Option<u32>,
}

/// Download the mesh of the whole wheel or one sector, as it was uploaded.
///
/// `vtu` has all elements, `vtp` the skin, `npz` arrays. Every point has the number of its `node`, its `sector`, and in `contact`
/// its position in the contact line, from 1; other points have 0. A package without a mesh gives points only.
#[utoipa::path(get, path = "/v1/models/{id}/mesh", operation_id = "get_mesh", tag = "models",
    params(("id" = String, Path, description = "Id of the model."), MeshQuery, DownloadQuery),
    responses(
        (status = 200, description = "The mesh."),
    ))]
pub(super) async fn get_mesh(
    state: State<AppState>,
    whose: Principal,
    ModelPath(id): ModelPath,
    Parameters(query): Parameters<MeshQuery>,
    download: Download,
) -> Result<Response, Problem> {
    let model = state.store.model(&id, whose.only()).await?.ok_or_else(|| model_not_found(&id))?;
    let part = field::part(query.sector, &model.facts)?;
    let answer = match download.begin(&state, Some(format!("model {id}")), &Form::MESH)? {
        Next::Done(response) => return Ok(response),
        Next::Make(answer) => answer,
    };
    let path = state.store.package(&id).await?;
    let bytes = jobs::sector_memory(model.facts.own_dofs);
    field::written(&state, answer, bytes, move || {
        let sector = jobs::field_sector(&path, model.facts.sectors as usize).map_err(Box::new)?;
        Ok(FieldFile { sector, field: Field::of_mesh(model.facts.name), part })
    })
    .await
}
