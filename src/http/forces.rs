//! Contact over speed and contact node.

use axum::extract::State;
use axum::response::Response;

use super::extract::JobPath;
use super::problem::Problem;
use super::results::{find, sweep};
use super::state::AppState;
use super::stream;
use crate::analysis::result::ForceMap;
use crate::analysis::run;
use crate::tokens::Principal;

/// Memory of a row of the map while it is made, over its contact in full.
const ROW_MEMORY: u64 = 4;

/// Download contact forces and clearance consumption: over speed and contact node, of every node its worst blade.
///
/// While the job runs, the map has the speeds finished so far. `spectra/{index}` has one speed in full: every blade.
#[utoipa::path(get, path = "/v1/jobs/{id}/forces", operation_id = "get_forces", tag = "results",
    params(("id" = String, Path, description = "Id of a sweep.")),
    responses(
        (status = 200, description = "The map.", body = ForceMap),
        (status = 404, description = "There is no such job.", body = Problem,
            content_type = "application/problem+json"),
        (status = 409, description = "The job is not a sweep.", body = Problem,
            content_type = "application/problem+json"),
    ))]
pub(super) async fn get_forces(
    state: State<AppState>,
    whose: Principal,
    JobPath(id): JobPath,
) -> Result<Response, Problem> {
    let job = find(&state, &whose, id).await?;
    let (request, facts) = sweep(&job)?;
    let pairs = u64::from(facts.sectors) * u64::from(facts.contact_nodes);
    let bytes =
        ROW_MEMORY * 8 * (5 * pairs + 8 * u64::from(facts.contact_nodes) * u64::from(job.speeds.total));
    let leave = state.answers.leave(&state.jobs, bytes).await;
    let row = |point: &_, contact: &_| run::force_row(point, contact);
    let map = run::force_map(request, &facts.units, state.store.contacts(id, row).await?);
    Ok(stream::json(leave, move || map))
}
