//! Branches: periodic responses over a parameter of their scene.

use axum::extract::State;
use axum::response::Response;
use serde::Deserialize;
use utoipa::IntoParams;

use super::download::{Download, DownloadQuery, lasting};
use super::extract::{JobPath, Parameters, job_not_found};
use super::forms::{Forms, READ_MEMORY};
use super::legs::Legs;
use super::problem::Problem;
use super::results::{check_sensor, find, resolved, swept};
use super::state::AppState;
use crate::analysis::kinds::branches::{BRANCHES, LEGS};
use crate::analysis::resolved::ResolvedBranches;
use crate::analysis::result::{BranchLeg, Branches};
use crate::kinds::JobKind;
use crate::plot;
use crate::tokens::Principal;

/// Parameters of a drawing of branches.
#[derive(Debug, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
pub(super) struct BranchesQuery {
    /// Index, in the request, of the sensor that a drawing shows; default 0.
    #[serde(default)]
    sensor: u32,
    /// Id of a sweep of the same model, whose speeds are dots in a drawing of branches over speed. The sweep's scene may differ.
    #[param(max_length = 64)]
    sweep: Option<String>,
}

/// Download branches of periodic responses.
///
/// A job that is not finished, failed or was dismissed has the points found so far. In csv a line is a point, in the order of the
/// branch; npz has an array for each column of the csv.
#[utoipa::path(get, path = "/v1/jobs/{id}/branches", operation_id = "get_branches", tag = "results",
    params(("id" = String, Path, description = "Id of branches."), BranchesQuery, DownloadQuery),
    responses(
        (status = 200, description = "The branches.", body = Branches),
        (status = 409, description = "The job is of another kind, or has no point yet.", body = Problem,
            content_type = "application/problem+json"),
    ))]
pub(super) async fn get_branches(
    state: State<AppState>,
    whose: Principal,
    JobPath(id): JobPath,
    Parameters(query): Parameters<BranchesQuery>,
    download: Download,
) -> Result<Response, Problem> {
    let job = find(&state, &whose, id).await?;
    let (asked, _) = resolved::<ResolvedBranches>(&job, JobKind(&BRANCHES))?;
    check_sensor(asked.sweep().sensors(), query.sensor)?;
    let marched = swept(&state, &whose, query.sweep.as_deref(), &job).await?;
    let legs = Legs::of(&state, &job, LEGS, "point of a branch").await?;
    let bytes = legs.bytes();
    let read = move || Branches::of(legs.read::<BranchLeg>()?).ok_or_else(|| job_not_found(&id));
    let sensor = query.sensor as usize;
    Forms::drawn_by(move |branches: &Branches| plot::branches(branches, sensor, &marched))
        .answer(&state, download, lasting(&job), READ_MEMORY * bytes, read)
        .await
}
