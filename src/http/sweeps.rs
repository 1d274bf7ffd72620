//! Sweeps of contact simulations over rotational speeds.

use axum::Json;
use axum::extract::State;
use axum::response::Response;

use super::extract::JsonBody;
use super::idempotency::IdempotencyKey;
use super::labels::Labelled;
use super::problem::Problem;
use super::state::AppState;
use super::submit;
use crate::analysis::request::SweepRequest;
use crate::analysis::run::SweepPlan;
use crate::jobs::Submission;
use crate::tokens::Principal;

/// Body of a sweep: the request, and the labels of the job.
type SweepBody = Labelled<SweepRequest>;

/// Simulate contact over rotational speeds.
///
/// The request is checked against its model at once; all violations come in one answer. If the reduction is stored, it is also
/// checked against the reduced model (fixed numbers of steps or kept modes against the stability limit, friction against what lets
/// the tips slide); if not, such a violation fails the job before its first speed, with the same pointers. `POST /v1/sweeps/plan`
/// refuses the same requests.
#[utoipa::path(post, path = "/v1/sweeps", operation_id = "create_sweep", tag = "jobs",
    params(("Idempotency-Key" = Option<String>, Header,
        description = "Repeating the request with this key repeats its answer and starts nothing.")),
    request_body(content = SweepBody, example = json!({
        "model": "9f86d081884c7d659a2feaa0c55ad015a3bf4f1b2b0b822cd15d6c15b0f00a08",
        "modes_per_speed": 20,
        "speeds": {"from": 12000.0, "to": 36000.0, "count": 60, "unit": "rpm"},
        "scene": {
            "centrifugal_stiffening": true,
            "damping": {"modal_ratio": 0.005},
            "casing": {
                "clearance": {"leading": 0.30, "trailing": 0.22},
                "lobes": {"count": 2, "amplitude": 0.425, "width_rad": 0.35}
            },
            "contact": {}
        },
        "integration": {
            "steps_per_revolution": "auto", "revolutions": "auto", "ramp_revolutions": 1.0, "window_revolutions": 20
        },
        "sensors": [
            {"contact_node": 0, "sector": 0, "component": "radial"},
            {"contact_node": 9, "sector": 0, "component": "radial"}
        ],
        "max_engine_order": 24
    })))]
pub(super) async fn create_sweep(
    state: State<AppState>,
    whose: Principal,
    key: IdempotencyKey,
    body: JsonBody<SweepBody>,
) -> Result<Response, Problem> {
    let (request, labels) = body.value.parts()?;
    let submission = (Submission::Sweep(Box::new(request)), labels);
    submit::accept(&state, &whose, key, &body.fingerprint, submission).await
}

/// Plan a sweep: what it would do and cost. Starts nothing.
///
/// Takes the body of `POST /v1/sweeps` and answers at once with effects on and off, symmetry, contact pairs, and, if the reduction
/// is stored, unknowns, scheme and step with the reason that set them, and the expected computing time and memory, from a short
/// calibration of this machine. The results of a sweep repeat the estimate beside the cost that was spent.
#[utoipa::path(post, path = "/v1/sweeps/plan", operation_id = "plan_sweep", tag = "jobs",
    request_body(content = SweepBody),
    responses(
        (status = 200, description = "The plan.", body = SweepPlan),
    ))]
pub(super) async fn plan_sweep(
    state: State<AppState>,
    whose: Principal,
    body: JsonBody<SweepBody>,
) -> Result<Json<SweepPlan>, Problem> {
    Ok(Json(state.jobs.plan_sweep(&whose, body.value.parts()?.0).await?))
}
