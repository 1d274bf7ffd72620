//! Convergence studies: accuracy of settings and its cost in time.

use axum::extract::State;
use axum::response::Response;
use serde::Deserialize;
use utoipa::{IntoParams, ToSchema};

use super::download::{Download, DownloadQuery};
use super::extract::{JobPath, JsonBody, Parameters};
use super::forms::Forms;
use super::idempotency::IdempotencyKey;
use super::labels::Labelled;
use super::problem::Problem;
use super::results::{find, wrong_kind};
use super::state::AppState;
use super::submit;
use crate::analysis::request::StudyRequest;
use crate::analysis::resolved::ResolvedStudy;
use crate::analysis::result::Quantity;
use crate::analysis::run::WorkPrecision;
use crate::jobs::Submission;
use crate::plot;
use crate::store::jobs::{Job, JobKind, JobRequest};
use crate::store::results::Document;
use crate::tokens::Principal;

/// Body of a study: the request, and the labels of the job.
type StudyBody = Labelled<StudyRequest>;

/// Parameters of a drawing of a study.
#[derive(Debug, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
pub(super) struct WorkPrecisionQuery {
    /// Quantity whose error a drawing shows; default `amplitude`.
    #[param(inline)]
    quantity: Option<Quantity>,
    /// Index, in the request, of the speed that a drawing shows; default 0.
    #[serde(default)]
    speed: u32,
    /// Axis over which a drawing shows the error; default `time`.
    #[param(inline)]
    over: Option<Over>,
}

/// Axis over which errors are drawn.
#[derive(Debug, Clone, Copy, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub(super) enum Over {
    /// CPU time.
    Time,
    /// Time step.
    Step,
}

/// Compare a grid of settings with a reference one level finer: errors, times, observed orders.
///
/// Every combination of the grid is run at every speed, and a setting that is unstable is listed with the reason. Runs are stored:
/// a study that shares settings with an earlier one on the same scene computes only the others.
#[utoipa::path(post, path = "/v1/studies", operation_id = "create_study", tag = "jobs",
    params(("Idempotency-Key" = Option<String>, Header,
        description = "Repeating the request with this key repeats its answer and starts nothing.")),
    request_body(content = StudyBody, example = json!({
        "model": "9f86d081884c7d659a2feaa0c55ad015a3bf4f1b2b0b822cd15d6c15b0f00a08",
        "speeds": {"values": [24000.0], "unit": "rpm"},
        "scene": {
            "centrifugal_stiffening": true,
            "damping": {"modal_ratio": 0.005},
            "casing": {
                "clearance": {"leading": 0.30, "trailing": 0.22},
                "lobes": {"count": 2, "amplitude": 0.425, "width_rad": 0.35}
            },
            "contact": {}
        },
        "grid": {
            "modes_per_speed": [1, 8, 20, 28, 42],
            "steps_per_revolution": [450, 900, 1800, 3600, 7200, 14400],
            "schemes": ["exact_modal", "massless_boundary", "central_differences"]
        },
        "history_revolutions": 3
    })))]
pub(super) async fn create_study(
    state: State<AppState>,
    whose: Principal,
    key: IdempotencyKey,
    body: JsonBody<StudyBody>,
) -> Result<Response, Problem> {
    let (request, labels) = body.value.parts()?;
    let submission = (Submission::Study(Box::new(request)), labels);
    submit::accept(&state, &whose, key, &body.fingerprint, submission).await
}

/// Download errors and times of a study.
///
/// In csv a line is a run; npz has an array for each column of the csv.
#[utoipa::path(get, path = "/v1/jobs/{id}/work-precision", operation_id = "get_work_precision", tag = "results",
    params(("id" = String, Path, description = "Id of a study."), WorkPrecisionQuery, DownloadQuery),
    responses(
        (status = 200, description = "Errors and times of every setting.", body = WorkPrecision),
        (status = 409, description = "The job is not a study, not finished, or ended without this result.",
            body = Problem, content_type = "application/problem+json"),
    ))]
pub(super) async fn get_work_precision(
    state: State<AppState>,
    whose: Principal,
    JobPath(id): JobPath,
    Parameters(query): Parameters<WorkPrecisionQuery>,
    download: Download,
) -> Result<Response, Problem> {
    let job = find(&state, &whose, id).await?;
    check_speed(&job, query.speed)?;
    let (speed, quantity) = (query.speed as usize, query.quantity.unwrap_or(Quantity::Amplitude));
    let over = query.over.unwrap_or(Over::Time);
    let draw = move |found: &WorkPrecision| match over {
        Over::Time => plot::work_precision(found, speed, quantity),
        Over::Step => plot::error_over_step(found, speed, quantity),
    };
    let figure = move |found: &WorkPrecision| match over {
        Over::Time => plot::figure::work_precision(found, speed, quantity),
        Over::Step => plot::figure::error_over_step(found, speed, quantity),
    };
    Forms::drawn_by(draw, figure).of_document(&state, download, &job, Document::WorkPrecision).await
}

/// Request of a study; refuses jobs of other kinds, and a speed that the study does not have.
pub(super) fn check_speed(job: &Job, speed: u32) -> Result<&ResolvedStudy, Problem> {
    let JobRequest::Study(request) = &job.request else { return Err(wrong_kind(job, JobKind::Study)) };
    let total = job.speeds.total;
    if speed >= total {
        return Err(Problem::parameter("speed", format!("the job has {total} speeds, counted from 0")));
    }
    Ok(request)
}
