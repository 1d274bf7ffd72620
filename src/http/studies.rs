//! Convergence studies: accuracy of settings and its cost in time.

use axum::extract::State;
use axum::response::Response;
use serde::Deserialize;
use utoipa::{IntoParams, ToSchema};

use super::download::{Download, DownloadQuery};
use super::extract::{JobPath, Parameters};
use super::forms::Forms;
use super::problem::Problem;
use super::results::{find, resolved};
use super::state::AppState;
use crate::analysis::kinds::study::{STUDY, WORK_PRECISION};
use crate::analysis::resolved::ResolvedStudy;
use crate::analysis::result::Quantity;
use crate::analysis::run::WorkPrecision;
use crate::kinds::JobKind;
use crate::plot;
use crate::store::jobs::Job;
use crate::tokens::Principal;

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
    Forms::drawn_by(move |found: &WorkPrecision| match over {
        Over::Time => plot::work_precision(found, speed, quantity),
        Over::Step => plot::error_over_step(found, speed, quantity),
    })
    .of_document(&state, download, &job, WORK_PRECISION)
    .await
}

/// Request of a study; refuses jobs of other kinds, and a speed that the study does not have.
pub(super) fn check_speed(job: &Job, speed: u32) -> Result<&ResolvedStudy, Problem> {
    let (request, _) = resolved::<ResolvedStudy>(job, JobKind(&STUDY))?;
    let total = job.speeds.total;
    if speed >= total {
        return Err(Problem::parameter("speed", format!("the job has {total} speeds, counted from 0")));
    }
    Ok(request)
}
