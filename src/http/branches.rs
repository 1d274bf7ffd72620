//! Branches: periodic responses over a parameter of their scene.

use axum::Json;
use axum::extract::State;
use axum::response::Response;
use serde::Deserialize;
use utoipa::IntoParams;

use super::download::{Download, DownloadQuery, lasting};
use super::extract::{JobPath, JsonBody, Parameters, job_not_found};
use super::forms::{Forms, READ_MEMORY};
use super::idempotency::IdempotencyKey;
use super::labels::Labelled;
use super::legs::Legs;
use super::problem::Problem;
use super::results::{check_sensor, find, swept, wrong_kind};
use super::state::AppState;
use super::submit;
use crate::analysis::request::BranchesRequest;
use crate::analysis::result::{BranchLeg, Branches, BranchesPlan};
use crate::jobs::Submission;
use crate::plot;
use crate::store::Followed;
use crate::store::jobs::{JobKind, JobRequest};
use crate::tokens::Principal;

type BranchesBody = Labelled<BranchesRequest>;

/// Follow the periodic response of a scene while its speed, clearance, lobes or damping change.
///
/// The branch is followed around folds, through stable and unstable responses, with Floquet multipliers at every point.
/// Bifurcations are located to a millionth, maxima of amplitudes as accurately as the time step permits, and branches of doubled
/// period are followed as well. `GET /v1/jobs/{id}/branches` has the points found so far, also while the job runs.
#[utoipa::path(post, path = "/v1/branches", operation_id = "create_branches", tag = "jobs",
    params(("Idempotency-Key" = Option<String>, Header,
        description = "Repeating the request with this key repeats its answer and starts nothing.")),
    request_body(content = BranchesBody, example = json!({
        "model": "9f86d081884c7d659a2feaa0c55ad015a3bf4f1b2b0b822cd15d6c15b0f00a08",
        "speed": {"value": 24000.0, "unit": "rpm"},
        "along": {"parameter": "speed", "from": 20000.0, "to": 28000.0},
        "scene": {
            "centrifugal_stiffening": true,
            "damping": {"modal_ratio": 0.005},
            "casing": {
                "clearance": {"leading": 0.30, "trailing": 0.22},
                "lobes": {"count": 2, "amplitude": 0.425, "width_rad": 0.35}
            },
            "contact": {}
        }
    })))]
pub(super) async fn create_branches(
    state: State<AppState>,
    whose: Principal,
    key: IdempotencyKey,
    body: JsonBody<BranchesBody>,
) -> Result<Response, Problem> {
    let (request, labels) = body.value.parts()?;
    let submission = (Submission::Branches(Box::new(request)), labels);
    submit::accept(&state, &whose, key, &body.fingerprint, submission).await
}

/// Plan branches of periodic responses: what they would do and cost. Starts nothing.
///
/// Takes the body of `POST /v1/branches` and answers at once. If the reduction is stored, the plan has the scheme, the step, and
/// the expected time of a point and of a branch that has no folds, from a short calibration of this machine.
#[utoipa::path(post, path = "/v1/branches/plan", operation_id = "plan_branches", tag = "jobs",
    request_body = BranchesBody,
    responses(
        (status = 200, description = "The plan.", body = BranchesPlan),
    ))]
pub(super) async fn plan_branches(
    State(state): State<AppState>,
    whose: Principal,
    body: JsonBody<BranchesBody>,
) -> Result<Json<BranchesPlan>, Problem> {
    Ok(Json(state.jobs.plan_branches(&whose, body.value.parts()?.0).await?))
}

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
    let JobRequest::Branches(asked) = &job.request else { return Err(wrong_kind(&job, JobKind::Branches)) };
    check_sensor(asked.sweep().sensors(), query.sensor)?;
    let marched = swept(&state, &whose, query.sweep.as_deref(), &job).await?;
    let legs = Legs::of(&state, &job, Followed::Branches, "point of a branch").await?;
    let bytes = legs.bytes();
    let read = move || Branches::of(legs.read::<BranchLeg>()?).ok_or_else(|| job_not_found(&id));
    let sensor = query.sensor as usize;
    let dots = marched.clone();
    let draw = move |branches: &Branches| plot::branches(branches, sensor, &dots);
    let figure = move |branches: &Branches| plot::figure::branches(branches, sensor, &marched);
    Forms::drawn_by(draw, figure).answer(&state, download, lasting(&job), READ_MEMORY * bytes, read).await
}
