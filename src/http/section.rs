//! Sections of a model's sector.

use axum::extract::State;
use axum::response::Response;
use serde::Deserialize;
use utoipa::{IntoParams, ToSchema};

use super::download::{Download, DownloadQuery};
use super::extract::{ModelPath, Parameters};
use super::forms::Forms;

use super::models::model_not_found;
use super::problem::Problem;
use super::results::find;
use super::state::AppState;
use crate::analysis::result::{ContactPlace, NodeKind, SectorGeometry, SectorNode};
use crate::analysis::run::{self, ModelFacts};
use crate::jobs;
use crate::package::{Face, Limits, PlacedNode, SectorNodes, read_mesh, read_places};
use crate::plot::{self, Drawing, SectionView};
use crate::solid::silhouette::silhouette;
use crate::store::jobs::JobId;
use crate::tokens::Principal;

/// Section to download, and its drawing.
#[derive(Debug, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
pub(super) struct SectionQuery {
    /// Direction from which a drawing shows the sector; default `meridional`.
    #[param(inline)]
    view: Option<ViewWord>,
    /// Id of a sweep or another job of this model, whose casing is shown with its clearance.
    #[param(max_length = 36)]
    sweep: Option<String>,
}

/// Direction from which a drawing shows a sector.
#[derive(Debug, Clone, Copy, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub(super) enum ViewWord {
    /// View across the axis: all nodes turned into one plane, with the contact line and the casing.
    Meridional,
    /// View along the axis: the cyclic faces and the clamped nodes.
    Cyclic,
    /// View along the axis of the whole wheel: all tips in the casing, whose distance is exaggerated.
    Around,
}

/// Download the positions of a model's nodes, or a section through its sector.
///
/// In csv a line is a node; in npz positions are `[node][r, θ, z]`.
#[utoipa::path(get, path = "/v1/models/{id}/section", operation_id = "get_section", tag = "models",
    params(("id" = String, Path, description = "Id of the model."), SectionQuery, DownloadQuery),
    responses(
        (status = 200, description = "The sector.", body = SectorGeometry),
    ))]
pub(super) async fn get_section(
    state: State<AppState>,
    whose: Principal,
    ModelPath(id): ModelPath,
    Parameters(query): Parameters<SectionQuery>,
    download: Download,
) -> Result<Response, Problem> {
    let model = state.store.model(&id, whose.only()).await?.ok_or_else(|| model_not_found(&id))?;
    let request = match &query.sweep {
        None => None,
        Some(of) => {
            let unknown = || Problem::parameter("sweep", "there is no such job of this model");
            let job = find(&state, &whose, JobId::parse(of).ok_or_else(unknown)?)
                .await
                .map_err(|problem| if problem.status == 404 { unknown() } else { problem })?;
            let request = job.request.scene().filter(|request| request.model() == id);
            Some(request.cloned().ok_or_else(unknown)?)
        }
    };
    let draw: fn(&SectorGeometry) -> Drawing<'static> = match query.view {
        Some(ViewWord::Cyclic) => |geometry| plot::section(geometry, SectionView::Cyclic),
        Some(ViewWord::Meridional) | None => |geometry| plot::section(geometry, SectionView::Meridional),
        Some(ViewWord::Around) => plot::around,
    };
    let path = state.store.package(&id).await?;
    let bytes = jobs::sector_memory(model.facts.own_dofs);
    Forms::drawn_by(move |geometry: &SectorGeometry| draw(geometry))
        .answer(&state, download, Some(format!("model {id}")), bytes, move || {
            let places = read_places(&path, &Limits::default()).map_err(Box::new)?;
            let positions: Vec<[f64; 3]> =
                places.contact.iter().map(|(number, _)| places.nodes[*number].position).collect();
            let normals: Vec<[f64; 3]> = places.contact.iter().map(|(_, normal)| *normal).collect();
            let clearances = request.as_ref().and_then(|request| run::clearances(request, &positions));
            let heights = request.and_then(|request| run::heights(&request, &positions, &normals));
            let mesh = read_mesh(&path, &Limits::default()).map_err(Box::new)?;
            let [silhouette, disk] = mesh.as_ref().map(silhouette).unwrap_or_default();
            Ok(SectorGeometry {
                silhouette,
                disk,
                ..geometry(&model.facts, &places, clearances.as_deref(), heights)
            })
        })
        .await
}

fn geometry(
    facts: &ModelFacts,
    places: &SectorNodes,
    clearances: Option<&[f64]>,
    heights: Option<Vec<Vec<f64>>>,
) -> SectorGeometry {
    let mut heights = heights.unwrap_or_default();
    heights.resize(places.contact.len(), Vec::new());
    let contact = places.contact.iter().zip(heights).enumerate();
    let contact = contact.map(|(k, ((number, normal), heights))| ContactPlace {
        id: places.nodes[*number].id,
        position: places.nodes[*number].position,
        normal: *normal,
        clearance: clearances.and_then(|clearances| clearances.get(k).copied()),
        heights,
    });
    let kind = |place: &PlacedNode| match place.face {
        _ if place.held => NodeKind::Clamped,
        Some(Face::Low) => NodeKind::Low,
        Some(Face::High) => NodeKind::High,
        None => NodeKind::Internal,
    };
    let node = |place: &PlacedNode| SectorNode { id: place.id, kind: kind(place), position: place.position };
    let mut nodes: Vec<SectorNode> = places.nodes.iter().map(node).collect();
    for (number, _) in &places.contact {
        nodes[*number].kind = NodeKind::Contact;
    }
    SectorGeometry {
        name: facts.name.clone(),
        sectors: facts.sectors,
        units: facts.units.clone(),
        nodes,
        contact: contact.collect(),
        silhouette: Vec::new(),
        disk: Vec::new(),
    }
}
