//! Case studies: histories of one simulated speed, and of speeds of a sweep that has ended.

use std::collections::BTreeSet;

use axum::extract::State;
use axum::response::Response;

use super::extract::{JobPath, JsonBody};
use super::idempotency::IdempotencyKey;
use super::labels::Labelled;
use super::problem::{Kind, Problem};
use super::results::{find, sweep};
use super::state::AppState;
use super::stream;
use super::submit;
use crate::analysis::request::{CaseStudyRequest, HistoriesRequest, HistorySpeeds};
use crate::analysis::resolved::ResolvedSweep;
use crate::analysis::run;
use crate::jobs::Submission;
use crate::store::jobs::JobId;
use crate::store::labels::Labels;
use crate::store::status::JobStatus;
use crate::tokens::Principal;

type CaseStudyBody = Labelled<CaseStudyRequest>;

/// Simulate one speed and record its histories: displacements, velocities, forces, energy.
///
/// `GET /v1/jobs/{id}/histories` has the histories. A sweep records those of its own speeds with `record`.
#[utoipa::path(post, path = "/v1/case-studies", operation_id = "create_case_study", tag = "jobs",
    params(("Idempotency-Key" = Option<String>, Header,
        description = "Repeating the request with this key repeats its answer and starts nothing.")),
    request_body(content = CaseStudyBody, example = json!({
        "model": "9f86d081884c7d659a2feaa0c55ad015a3bf4f1b2b0b822cd15d6c15b0f00a08",
        "speed": {"value": 24000.0, "unit": "rpm"},
        "scene": {
            "centrifugal_stiffening": true,
            "damping": {"modal_ratio": 0.005},
            "casing": {
                "clearance": {"leading": 0.30, "trailing": 0.22},
                "lobes": {"count": 2, "amplitude": 0.425, "width_rad": 0.35}
            },
            "contact": {}
        },
        "record": {"revolutions": [0, 10], "quantities": ["displacement", "velocity", "contact_force", "contact", "energy"]}
    })))]
pub(super) async fn create_case_study(
    state: State<AppState>,
    whose: Principal,
    key: IdempotencyKey,
    body: JsonBody<CaseStudyBody>,
) -> Result<Response, Problem> {
    let (request, labels) = body.value.parts()?;
    let submission = (Submission::CaseStudy(Box::new(request)), labels);
    submit::accept(&state, &whose, key, &body.fingerprint, submission).await
}

/// Record histories of a sweep that has ended.
///
/// A new job simulates the speeds again with all settings of the sweep. The same version on the same kind of processor gives the
/// same results to the bit.
#[utoipa::path(post, path = "/v1/jobs/{id}/histories", operation_id = "create_histories", tag = "jobs",
    params(
        ("id" = String, Path, description = "Id of a sweep."),
        ("Idempotency-Key" = Option<String>, Header,
            description = "Repeating the request with this key repeats its answer and starts nothing."),
    ),
    request_body(content = HistoriesRequest, example = json!({"speeds": "critical"})),
    responses(
        (status = 409, description = "The job is not a sweep, or not successful.", body = Problem,
            content_type = "application/problem+json"),
        (status = 422, description = "A field is unknown or impossible, the model is gone (`errors` points at each), or the \
            idempotency key belongs to another request.", body = Problem, content_type = "application/problem+json"),
    ))]
pub(super) async fn create_histories(
    state: State<AppState>,
    whose: Principal,
    key: IdempotencyKey,
    JobPath(id): JobPath,
    body: JsonBody<HistoriesRequest>,
) -> Result<Response, Problem> {
    let job = find(&state, &whose, id).await?;
    let (settings, _) = sweep(&job)?;
    if job.status != JobStatus::Successful {
        let detail =
            format!("the sweep is {}: its speeds are recorded once it is successful", job.status.as_str());
        return Err(Problem::new(Kind::ResultNotReady, detail));
    }
    let critical = critical(&state, id, settings, &body.value).await?;
    let submission = Submission::Histories(Box::new((settings.clone(), critical, body.value)));
    // The same words on another job are another request.
    let fingerprint = format!("{}-{id}", body.fingerprint);
    submit::accept(&state, &whose, key, &fingerprint, (submission, Labels::default())).await
}

/// Indices of the critical speeds, if the request asks for them; otherwise none.
async fn critical(
    state: &AppState,
    id: JobId,
    settings: &ResolvedSweep,
    request: &HistoriesRequest,
) -> Result<BTreeSet<u32>, Problem> {
    match request.speeds {
        HistorySpeeds::Critical => {
            let (settings, points) = (settings.clone(), state.store.points(id).await?);
            stream::blocking(move || run::critical_indices(&settings, &points)).await
        }
        HistorySpeeds::Indices(_) => Ok(BTreeSet::new()),
    }
}
