//! Convergence studies: what accuracy costs in time.

use axum::extract::State;
use axum::response::Response;
use serde::Deserialize;
use utoipa::{IntoParams, ToSchema};

use super::extract::{JobPath, JsonBody, Parameters};
use super::idempotency::IdempotencyKey;
use super::labels::Labelled;
use super::problem::Problem;
use super::results::{self, find, wrong_kind};
use super::state::AppState;
use super::submit::{self, Receipt};
use crate::analysis::request::StudyRequest;
use crate::analysis::resolved::ResolvedStudy;
use crate::analysis::result::Quantity;
use crate::analysis::run::{Histories, WorkPrecision};
use crate::jobs::Submission;
use crate::plot;
use crate::store::jobs::{Job, JobKind, JobRequest};
use crate::store::results::Document;
use crate::tokens::Principal;

/// The body: the request, and what the job is to be called.
type StudyBody = Labelled<StudyRequest>;

/// Form of a download.
#[derive(Debug, Clone, Copy, Default, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub(super) enum Format {
    /// All numbers.
    #[default]
    Json,
    /// A table.
    Csv,
    /// A drawing.
    Svg,
}

/// Form of a download of histories.
#[derive(Debug, Clone, Copy, Default, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub(super) enum HistoriesFormat {
    /// All numbers.
    #[default]
    Json,
    /// A drawing.
    Svg,
}

/// What to download of a study.
#[derive(Debug, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
pub(super) struct WorkPrecisionQuery {
    /// `json` (default) or `csv` for all speeds and quantities, `svg` for a drawing of one.
    #[serde(default)]
    #[param(inline)]
    format: Format,
    /// Of the drawing: whose error; default `amplitude`.
    #[param(inline)]
    quantity: Option<Quantity>,
    /// Of the drawing: index of the speed in the request; default 0.
    #[serde(default)]
    speed: u32,
}

/// Which histories of a study to download.
#[derive(Debug, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
pub(super) struct HistoriesQuery {
    /// `json` (default) for all sensors, `svg` for a drawing of one.
    #[serde(default)]
    #[param(inline)]
    format: HistoriesFormat,
    /// Index of the speed in the request; default 0.
    #[serde(default)]
    speed: u32,
    /// Of the drawing: index of the sensor in the request; default 0.
    #[serde(default)]
    sensor: u32,
}

/// Compare a grid of settings with a reference one level finer: errors, times, observed orders.
///
/// Every combination of the grid is run at every speed, and a setting that is unstable is listed with the reason. Runs are kept: a
/// study that shares settings with an earlier one on the same scene computes the others only.
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
    })),
    responses(
        (status = 202, description = "The job is accepted.", body = Receipt,
            headers(("Location" = String, description = "Path of the job."))),
        (status = 400, description = "The body is not JSON; `errors` has line and column.", body = Problem,
            content_type = "application/problem+json"),
        (status = 413, description = "The body is too large.", body = Problem,
            content_type = "application/problem+json"),
        (status = 415, description = "The body is not declared as application/json.", body = Problem,
            content_type = "application/problem+json"),
        (status = 422, description = "A field is unknown, missing or impossible, the model is unknown (`errors` \
            points at each), or the idempotency key belongs to another request.", body = Problem,
            content_type = "application/problem+json"),
    ))]
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
#[utoipa::path(get, path = "/v1/jobs/{id}/work-precision", operation_id = "get_work_precision", tag = "results",
    params(("id" = String, Path, description = "Id of a study."), WorkPrecisionQuery),
    responses(
        (status = 200, description = "Errors and times of every setting.",
            content((WorkPrecision = "application/json"), (String = "text/csv"), (String = "image/svg+xml"))),
        (status = 400, description = "A parameter is not valid.", body = Problem,
            content_type = "application/problem+json"),
        (status = 404, description = "There is no such job.", body = Problem,
            content_type = "application/problem+json"),
        (status = 409, description = "The job is not a study, not finished, or ended without this result.",
            body = Problem, content_type = "application/problem+json"),
    ))]
pub(super) async fn get_work_precision(
    state: State<AppState>,
    whose: Principal,
    JobPath(id): JobPath,
    Parameters(query): Parameters<WorkPrecisionQuery>,
) -> Result<Response, Problem> {
    let job = find(&state, &whose, id).await?;
    check_speed(&job, query.speed)?;
    let (document, speed) = (Document::WorkPrecision, query.speed as usize);
    match query.format {
        Format::Json => results::document(&state, &job, document).await,
        Format::Csv => {
            results::drawn(&state, &job, document, "text/csv; charset=utf-8", WorkPrecision::csv).await
        }
        Format::Svg => {
            let quantity = query.quantity.unwrap_or(Quantity::Amplitude);
            let draw = move |document: &WorkPrecision| plot::work_precision(document, speed, quantity);
            results::drawn(&state, &job, document, "image/svg+xml", draw).await
        }
    }
}

/// Download the displacements of the first revolutions, one line per size.
#[utoipa::path(get, path = "/v1/jobs/{id}/histories", operation_id = "get_histories", tag = "results",
    params(("id" = String, Path, description = "Id of a study."), HistoriesQuery),
    responses(
        (status = 200, description = "The histories.",
            content((Histories = "application/json"), (String = "image/svg+xml"))),
        (status = 400, description = "A parameter is not valid.", body = Problem,
            content_type = "application/problem+json"),
        (status = 404, description = "There is no such job.", body = Problem,
            content_type = "application/problem+json"),
        (status = 409, description = "The job is not a study, not finished, or ended without this result.",
            body = Problem, content_type = "application/problem+json"),
    ))]
pub(super) async fn get_histories(
    state: State<AppState>,
    whose: Principal,
    JobPath(id): JobPath,
    Parameters(query): Parameters<HistoriesQuery>,
) -> Result<Response, Problem> {
    let job = find(&state, &whose, id).await?;
    if matches!(job.request, JobRequest::Sweep(_) | JobRequest::CaseStudy(_)) {
        return results::document(&state, &job, Document::Histories(query.speed)).await;
    }
    let request = check_speed(&job, query.speed)?;
    let sensors = request.sensors().len();
    if query.sensor as usize >= sensors {
        return Err(Problem::parameter("sensor", format!("the job has {sensors} sensors, counted from 0")));
    }
    let (document, sensor) = (Document::Histories(query.speed), query.sensor as usize);
    match query.format {
        HistoriesFormat::Json => results::document(&state, &job, document).await,
        HistoriesFormat::Svg => {
            let draw = move |histories: &Histories| plot::histories(histories, sensor);
            results::drawn(&state, &job, document, "image/svg+xml", draw).await
        }
    }
}

/// The request of a study that has so many speeds.
fn check_speed(job: &Job, speed: u32) -> Result<&ResolvedStudy, Problem> {
    let JobRequest::Study(request) = &job.request else { return Err(wrong_kind(job, JobKind::Study)) };
    let total = job.speeds.total;
    if speed >= total {
        return Err(Problem::parameter("speed", format!("the job has {total} speeds, counted from 0")));
    }
    Ok(request)
}
