//! Backbone curves of modal analyses.

use axum::extract::State;
use axum::response::Response;

use super::download::{Download, DownloadQuery};
use super::extract::JobPath;
use super::forms::Forms;
use super::problem::{Kind, Problem};
use super::results::{find, resolved};
use super::state::AppState;
use crate::analysis::kinds::modal_analysis::{BACKBONES, MODAL_ANALYSIS};
use crate::analysis::resolved::ResolvedModalAnalysis;
use crate::analysis::result::Backbones;
use crate::kinds::JobKind;
use crate::plot;
use crate::tokens::Principal;

/// Download the backbone curves of a modal analysis: frequency of free vibration over its amplitude.
///
/// In csv a line is a point, with whether its curve is complete, its end and the resonances passed.
#[utoipa::path(get, path = "/v1/jobs/{id}/backbones", operation_id = "get_backbones", tag = "results",
    params(("id" = String, Path, description = "Id of a modal analysis with `backbones`."), DownloadQuery),
    responses(
        (status = 200, description = "The curves.", body = Backbones),
        (status = 409, description = "The job is not such a modal analysis, not finished, or ended without this result.",
            body = Problem, content_type = "application/problem+json"),
    ))]
pub(super) async fn get_backbones(
    state: State<AppState>,
    whose: Principal,
    JobPath(id): JobPath,
    download: Download,
) -> Result<Response, Problem> {
    let job = find(&state, &whose, id).await?;
    let (request, _) = resolved::<ResolvedModalAnalysis>(&job, JobKind(&MODAL_ANALYSIS))?;
    if request.bending_coordinates().is_none() {
        let detail = "the analysis was not asked for backbone curves: post it again with \"backbones\": {}";
        return Err(Problem::new(Kind::ResultUnavailable, detail));
    }
    Forms::drawn_by(plot::backbones).of_document(&state, download, &job, BACKBONES).await
}
