//! Contact forces and clearance consumption over speed and contact node.

use axum::extract::State;
use axum::response::Response;
use serde::Deserialize;
use tokio::runtime::Handle;
use utoipa::{IntoParams, ToSchema};

use super::download::{Download, DownloadQuery, lasting};
use super::extract::{JobPath, Parameters};
use super::forms::Forms;
use super::problem::Problem;
use super::results::{find, sweep};
use super::state::AppState;
use crate::analysis::result::ForceMap;
use crate::analysis::run;
use crate::plot::{self, ForceQuantity};
use crate::tokens::Principal;

/// Ratio of memory to stored numbers: of a row of the map while it is made, over its contact in full; and of the whole map.
const ROW_MEMORY: u64 = 4;

/// Parameters of a drawing of contact.
#[derive(Debug, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
pub(super) struct ForcesQuery {
    /// Quantity that a drawing shows; default `peak`.
    #[param(inline)]
    quantity: Option<Drawn>,
}

/// Quantity that a drawing shows over speed and contact node.
#[derive(Debug, Clone, Copy, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
enum Drawn {
    /// Largest force.
    Peak,
    /// Impulse per revolution.
    Impulse,
    /// Share of time in contact.
    Share,
    /// Clearance consumption.
    Consumption,
}

/// Download contact forces and clearance consumption over speed and contact node, at every node those of its worst blade.
///
/// While the job runs, the map has the speeds finished so far. `spectra/{index}` has one speed in full, with every blade.
#[utoipa::path(get, path = "/v1/jobs/{id}/forces", operation_id = "get_forces", tag = "results",
    params(("id" = String, Path, description = "Id of a sweep."), ForcesQuery, DownloadQuery),
    responses(
        (status = 200, description = "The map.", body = ForceMap),
        (status = 409, description = "The job is not a sweep.", body = Problem,
            content_type = "application/problem+json"),
    ))]
pub(super) async fn get_forces(
    state: State<AppState>,
    whose: Principal,
    JobPath(id): JobPath,
    Parameters(query): Parameters<ForcesQuery>,
    download: Download,
) -> Result<Response, Problem> {
    let job = find(&state, &whose, id).await?;
    let (_, facts) = sweep(&job)?;
    let (sectors, nodes) = (u64::from(facts.sectors), u64::from(facts.contact_nodes));
    let bytes = ROW_MEMORY * 8 * (5 * sectors * nodes + 8 * nodes * u64::from(job.speeds.total));
    let quantity = match query.quantity.unwrap_or(Drawn::Peak) {
        Drawn::Peak => ForceQuantity::Peak,
        Drawn::Impulse => ForceQuantity::Impulse,
        Drawn::Share => ForceQuantity::Share,
        Drawn::Consumption => ForceQuantity::Consumption,
    };
    let (store, runtime, lasting) = (state.store.clone(), Handle::current(), lasting(&job));
    let read = move || {
        let (request, facts) = sweep(&job)?;
        let row = |point: &_, contact: &_| run::force_row(point, contact);
        Ok(run::force_map(request, &facts.units, runtime.block_on(store.contacts(id, row))?))
    };
    Forms::drawn_by(move |map: &ForceMap| plot::force_map(map, quantity))
        .answer(&state, download, lasting, bytes, read)
        .await
}
