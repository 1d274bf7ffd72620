//! Mode shapes and natural frequencies of a model.

use axum::extract::State;
use axum::response::Response;
use serde::{Deserialize, Serialize};
use utoipa::{IntoParams, ToSchema};

use super::download::{Download, DownloadQuery, Next};
use super::extract::{ModelPath, Parameters};
use super::field::{self, ShownQuery};
use super::form::Form;
use super::models::model_not_found;
use super::problem::{Kind, Problem, ProblemItem};
use super::state::AppState;
use super::stream;
use crate::analysis::fields::{ModeRequest, Motion, ShapeFrequencies, mode_field, mode_frequencies};
use crate::export::fields::FieldFile;
use crate::store::models::StoredModel;
use crate::tokens::Principal;

/// Bytes that an answer in JSON and its eigenproblems take.
const LIST_MEMORY: u64 = 64 << 20;

/// Mode to download, and its speed, motion and phase.
#[derive(Debug, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
pub(super) struct ModesQuery {
    /// Modes per speed of the reduction; default the finest that there is.
    #[param(minimum = 1)]
    modes_per_speed: Option<u32>,
    /// Speed of rotation, rad/s; default 0. Modes are those of K(Ω) where the model has it, without Coriolis forces.
    #[serde(default)]
    #[param(minimum = 0.0)]
    speed_rad_s: f64,
    /// Nodal diameter of the mode; a field needs one.
    nodal_diameter: Option<u32>,
    /// Number of the mode, from 1 by ascending frequency; default 1.
    #[param(minimum = 1)]
    mode: Option<u32>,
    /// Motion of the mode; default `standing`.
    #[param(inline)]
    motion: Option<Motion>,
    /// Phase, degrees; default 0: turns the pattern of a standing mode about the wheel, and is how far a travelling mode has come.
    phase_deg: Option<f64>,
}

impl ModesQuery {
    /// Refuses parameters of a shape where the frequencies of all modes are listed.
    fn check_list(&self) -> Result<(), Problem> {
        let given = [
            ("nodal_diameter", self.nodal_diameter.is_some()),
            ("mode", self.mode.is_some()),
            ("motion", self.motion.is_some()),
            ("phase_deg", self.phase_deg.is_some()),
        ];
        match given.into_iter().find(|(_, given)| *given) {
            Some((name, _)) => Err(Problem::parameter(
                name,
                "json lists the frequencies of all modes: ask for a shape with `format`",
            )),
            None => Ok(()),
        }
    }
}

/// Natural frequencies of a model at a speed.
#[derive(Debug, Serialize, ToSchema)]
pub(super) struct ModesBody {
    /// Speed of rotation, rad/s.
    speed_rad_s: f64,
    /// Modes per speed of the reduction.
    modes_per_speed: u32,
    /// Natural frequencies by nodal diameter.
    nodal_diameters: Vec<ShapeFrequencies>,
}

/// Download a mode shape of the whole wheel or one sector, or the natural frequencies of all modes.
///
/// `vtu` has all elements, `vtp` the skin, `npz` arrays, `pvd` a zip of files over one period, svg and png a drawing of the skin;
/// json lists the frequencies of all nodal diameters. The largest displacement is 1. A package without a mesh gives points only.
///
/// The model must have been reduced, which every sweep and modal analysis does.
#[utoipa::path(get, path = "/v1/models/{id}/modes", operation_id = "get_modes", tag = "models",
    params(("id" = String, Path, description = "Id of the model."), ModesQuery, ShownQuery, DownloadQuery),
    responses(
        (status = 200, description = "The mode, or the list.", body = ModesBody),
        (status = 409, description = "The model has no such reduction.", body = Problem,
            content_type = "application/problem+json"),
        (status = 422, description = "The wheel has no modes at that speed.", body = Problem,
            content_type = "application/problem+json"),
    ))]
pub(super) async fn get_modes(
    state: State<AppState>,
    whose: Principal,
    ModelPath(id): ModelPath,
    Parameters(query): Parameters<ModesQuery>,
    Parameters(shown): Parameters<ShownQuery>,
    download: Download,
) -> Result<Response, Problem> {
    let model = state.store.model(&id, whose.only()).await?.ok_or_else(|| model_not_found(&id))?;
    let modes_per_speed = match query.modes_per_speed {
        Some(modes) => modes,
        None => finest(&state, &model).await?,
    };
    let modes = modes_per_speed as usize;
    let part = shown.part(&model.facts)?;
    let speed_rad_s = query.speed_rad_s;
    if !(speed_rad_s.is_finite() && speed_rad_s >= 0.0) {
        return Err(Problem::parameter("speed_rad_s", "a speed is a number from 0 on"));
    }
    if !model.facts.stiffness_reaches(speed_rad_s) {
        let detail = model.facts.not_extrapolated();
        return Err(Problem::new(Kind::InvalidRequest, detail.clone()).with(ProblemItem {
            parameter: Some("speed_rad_s".to_owned()),
            detail,
            ..ProblemItem::default()
        }));
    }
    if !query.phase_deg.unwrap_or_default().is_finite() {
        return Err(Problem::parameter("phase_deg", "a phase is a number"));
    }
    let source = field::source(&state, &model, modes_per_speed).await?;
    let lasting = format!("model {id}, {modes_per_speed} modes per speed");
    let next = download.begin(&state, Some(lasting), &Form::LIST_AND_FIELDS)?;
    let answer = match next {
        Next::Done(response) => return Ok(response),
        Next::Make(answer) => answer,
    };
    shown.check(answer.form)?;
    if answer.form == Form::Json {
        query.check_list()?;
        let leave = state.answers.leave(&state.jobs, LIST_MEMORY).await;
        let list = move || mode_frequencies(&source.reduced().wheel, speed_rad_s, true, modes);
        let nodal_diameters = stream::blocking(list).await??;
        return Ok(answer.document(leave, ModesBody { speed_rad_s, modes_per_speed, nodal_diameters }));
    }
    let most = model.facts.sectors / 2;
    let Some(nodal_diameter) = query.nodal_diameter else {
        let detail = format!("a mode shape has a nodal diameter: 0 to {most}");
        return Err(Problem::parameter("nodal_diameter", detail));
    };
    let asked = ModeRequest {
        speed_rad_s,
        stiffening: true,
        nodal_diameter: nodal_diameter as usize,
        modes,
        mode: query.mode.unwrap_or(1) as usize,
        motion: query.motion.unwrap_or(Motion::Standing),
        phase: query.phase_deg.unwrap_or_default().to_radians(),
        frames: shown.frames(answer.form),
    };
    let bytes = source.memory(model.facts.own_dofs, 1);
    let view = (shown.view(&source), model.facts.units.clone());
    field::answer(&state, answer, bytes, view, move || {
        let sector = source.sector(shown.stress, None).map_err(Box::new)?;
        let field = source.with_basis(|wheel, basis| mode_field(wheel, &sector, &asked, basis))?;
        Ok(FieldFile { sector, field, part })
    })
    .await
}

/// Modes per speed of the finest reduction.
async fn finest(state: &AppState, model: &StoredModel) -> Result<u32, Problem> {
    let reports = state.store.reduction_reports(&model.id).await?;
    reports.iter().map(|report| report.modes_per_speed).max().ok_or_else(|| {
        let detail = format!("model {} has not been reduced: a sweep or a modal analysis does it", model.id);
        Problem::new(Kind::NotReduced, detail)
    })
}
