//! Modal analyses: natural frequencies over speed, and the linear interaction criterion.

use axum::Json;
use axum::extract::State;
use axum::response::Response;

use super::extract::JsonBody;
use super::idempotency::IdempotencyKey;
use super::labels::Labelled;
use super::problem::Problem;
use super::state::AppState;
use super::submit;
use crate::analysis::request::ModalAnalysisRequest;
use crate::analysis::run::ModalAnalysisPlan;
use crate::jobs::Submission;
use crate::tokens::Principal;

/// Body of a modal analysis: the request, and the labels of the job.
type ModalAnalysisBody = Labelled<ModalAnalysisRequest>;

/// Compute natural frequencies over speed and the linear interaction criterion.
#[utoipa::path(post, path = "/v1/modal-analyses", operation_id = "create_modal_analysis", tag = "jobs",
    params(("Idempotency-Key" = Option<String>, Header,
        description = "Repeating the request with this key repeats its answer and starts nothing.")),
    request_body(content = ModalAnalysisBody, example = json!({
        "model": "9f86d081884c7d659a2feaa0c55ad015a3bf4f1b2b0b822cd15d6c15b0f00a08",
        "modes_per_speed": 20,
        "families": 2,
        "superharmonics": [1, 2, 3],
        "lobes": 2,
        "speeds": {"from": 0.0, "to": 36000.0, "count": 37, "unit": "rpm"}
    })))]
pub(super) async fn create_modal_analysis(
    state: State<AppState>,
    whose: Principal,
    key: IdempotencyKey,
    body: JsonBody<ModalAnalysisBody>,
) -> Result<Response, Problem> {
    let (request, labels) = body.value.parts()?;
    let submission = (Submission::ModalAnalysis(Box::new(request)), labels);
    submit::accept(&state, &whose, key, &body.fingerprint, submission).await
}

/// Plan a modal analysis: what it would do and cost. Starts nothing.
///
/// Takes the body of `POST /v1/modal-analyses` and answers at once.
#[utoipa::path(post, path = "/v1/modal-analyses/plan", operation_id = "plan_modal_analysis", tag = "jobs",
    request_body(content = ModalAnalysisBody),
    responses(
        (status = 200, description = "The plan.", body = ModalAnalysisPlan),
    ))]
pub(super) async fn plan_modal_analysis(
    state: State<AppState>,
    whose: Principal,
    body: JsonBody<ModalAnalysisBody>,
) -> Result<Json<ModalAnalysisPlan>, Problem> {
    Ok(Json(state.jobs.plan_modal_analysis(&whose, body.value.parts()?.0).await?))
}
