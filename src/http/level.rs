//! Level of the wheel over speed.

use axum::extract::State;
use axum::response::Response;
use serde::Deserialize;
use utoipa::IntoParams;

use super::download::{Download, DownloadQuery};
use super::extract::{JobPath, Parameters};
use super::forms::Forms;
use super::problem::Problem;
use super::results::find;
use super::state::AppState;
use super::verdict::judged;
use crate::analysis::result::{LimitKind, SweepLevel};
use crate::analysis::run;
use crate::plot;
use crate::tokens::Principal;

/// Parameters of a drawing of the level.
#[derive(Debug, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
pub(super) struct LevelQuery {
    /// Quantity that a drawing shows; by default the one that decides the verdict, without limits the tip motion.
    #[param(inline)]
    quantity: Option<LimitKind>,
}

/// Download the level of the wheel over speed: tip motion, clearance consumption, utilisation and the largest contact force on a node, over all
/// contact nodes, components and blades, beside the verdict that they lead to.
///
/// Made on reading from the speeds finished so far. A drawing shows one quantity with operating ranges, limits, errors and critical speeds. In
/// csv a line is a speed.
#[utoipa::path(get, path = "/v1/jobs/{id}/level", operation_id = "get_level", tag = "results",
    params(("id" = String, Path, description = "Id of a sweep."), LevelQuery, DownloadQuery),
    responses(
        (status = 200, description = "The level.", body = SweepLevel),
        (status = 409, description = "The job is not a sweep.", body = Problem, content_type = "application/problem+json"),
    ))]
pub(super) async fn get_level(
    state: State<AppState>,
    whose: Principal,
    JobPath(id): JobPath,
    Parameters(query): Parameters<LevelQuery>,
    download: Download,
) -> Result<Response, Problem> {
    let job = find(&state, &whose, id).await?;
    let forms = Forms::drawn_by(move |level: &SweepLevel| plot::wheel_level(level, query.quantity));
    judged(&state, job, download, forms, run::level).await
}
