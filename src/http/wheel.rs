//! Critical speeds of the whole wheel.

use axum::extract::State;
use axum::response::Response;

use super::download::{Download, DownloadQuery};
use super::extract::{JobPath, Parameters};
use super::forms::Forms;
use super::problem::Problem;
use super::results::{RankQuery, find, sweep};
use super::state::AppState;
use crate::analysis::kinds::sweep::WHEEL_CRITICAL_SPEEDS;
use crate::analysis::result::{WheelCriticalSpeeds, most_utilised_first};
use crate::tokens::Principal;

/// Download the critical speeds of the wheel over all contact nodes, components and blades, the most severe or the most utilised first.
///
/// In json the critical speeds that each sensor sees are beside them; `critical-speeds` has those of one sensor with the linear
/// prediction, and its drawing.
#[utoipa::path(get, path = "/v1/jobs/{id}/critical-speeds/wheel", operation_id = "get_wheel_critical_speeds", tag = "results",
    params(("id" = String, Path, description = "Id of a sweep."), RankQuery, DownloadQuery),
    responses(
        (status = 200, description = "The table.", body = WheelCriticalSpeeds),
        (status = 409, description = "The job is not a sweep, not finished, ended without this result, or is of an earlier version.",
            body = Problem, content_type = "application/problem+json"),
    ))]
pub(super) async fn get_wheel_critical_speeds(
    state: State<AppState>,
    whose: Principal,
    JobPath(id): JobPath,
    Parameters(rank): Parameters<RankQuery>,
    download: Download,
) -> Result<Response, Problem> {
    let job = find(&state, &whose, id).await?;
    let (request, _) = sweep(&job)?;
    let by_utilisation = |table: &mut WheelCriticalSpeeds| {
        most_utilised_first(&mut table.critical_speeds, |speed| speed.utilisation);
    };
    rank.ranked(Forms::undrawn(), request, by_utilisation)?
        .of_document(&state, download, &job, WHEEL_CRITICAL_SPEEDS)
        .await
}
