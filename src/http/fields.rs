//! Fields of a recorded run: instants and deflection shapes.

use axum::extract::State;
use axum::response::Response;
use serde::Deserialize;
use tokio::runtime::Handle;
use utoipa::{IntoParams, ToSchema};

use super::download::{Download, DownloadQuery, Next, lasting};
use super::extract::{JobPath, Parameters};
use super::field::{self, ShownQuery};
use super::form::Form;
use super::forms::READ_MEMORY;
use super::histories::recorded_sweep;
use super::models::model_not_found;
use super::problem::{Kind, Problem};
use super::results::{expect_successful, find};
use super::state::AppState;
use crate::analysis::fields::{deflection_shape, instants, largest_instant};
use crate::analysis::kinds::document::Document;
use crate::analysis::kinds::sweep::STATES;
use crate::dynamics::reduction::ReductionError;
use crate::export::fields::FieldFile;
use crate::jobs::StaticWheelError;
use crate::store::jobs::{Job, JobId};
use crate::store::states::StatesError;
use crate::store::{Store, StoreError};
use crate::tokens::Principal;

/// Field to download: its speed, and an instant or a deflection shape.
#[derive(Debug, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
pub(super) struct FieldsQuery {
    /// Index of the speed in the request, for a case study in that of its sweep; default the first that was recorded.
    speed: Option<u32>,
    /// Index of the instant among those recorded, from 0; default the instant of the largest displacement of a contact node.
    instant: Option<u32>,
    /// Engine order of a deflection shape over all recorded revolutions, which replaces the instant; 0 is the mean.
    engine_order: Option<u32>,
    /// Phase of a deflection shape, degrees; default 0.
    phase_deg: Option<f64>,
    /// Whether displacement and stress of an instant are those of the whole load or of the vibration alone; default `leave_out`.
    #[serde(rename = "static", default)]
    #[param(inline)]
    static_part: StaticPart,
}

/// Treatment of the static part of the centrifugal load.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub(super) enum StaticPart {
    /// Displacement and stress are those of the vibration alone.
    #[default]
    LeaveOut,
    /// Displacement and stress contain the static part, as `largest` of a sweep's stress does; files also have it separately, as
    /// `static_displacement` and `static_stress`.
    Include,
}

/// Download the field of a recorded run, of the whole wheel or one sector: an instant, or the deflection shape of an engine order.
///
/// `vtu` has all elements, `vtp` the skin, `npz` arrays, `pvd` a zip of files over time, svg and png a drawing of the skin. A
/// package without a mesh gives points only.
///
/// A case study, or the histories of a sweep, must have recorded the quantity `state`.
#[utoipa::path(get, path = "/v1/jobs/{id}/fields", operation_id = "get_fields", tag = "results",
    params(("id" = String, Path, description = "Id of a case study or sweep."), FieldsQuery, ShownQuery, DownloadQuery),
    responses(
        (status = 200, description = "The field."),
        (status = 404, description = "There is no such job, its model is deleted, or no state was recorded of that speed.",
            body = Problem, content_type = "application/problem+json"),
        (status = 409, description = "The job has no states, is not finished, or its reduction is gone.",
            body = Problem, content_type = "application/problem+json"),
    ))]
pub(super) async fn get_fields(
    state: State<AppState>,
    whose: Principal,
    JobPath(id): JobPath,
    Parameters(query): Parameters<FieldsQuery>,
    Parameters(shown): Parameters<ShownQuery>,
    download: Download,
) -> Result<Response, Problem> {
    let job = find(&state, &whose, id).await?;
    let sweep = recorded_sweep(&job)?;
    let model = sweep.model();
    let model = state.store.model(model, whose.only()).await?.ok_or_else(|| model_not_found(model))?;
    let part = shown.part(&model.facts)?;
    if query.instant.is_some() && query.engine_order.is_some() {
        return Err(Problem::parameter(
            "engine_order",
            "an instant, or an engine order over all of them: not both",
        ));
    }
    match query.phase_deg {
        Some(_) if query.engine_order.is_none() => {
            return Err(Problem::parameter(
                "phase_deg",
                "only a deflection shape has a phase: name its engine_order",
            ));
        }
        Some(phase) if !phase.is_finite() => {
            return Err(Problem::parameter("phase_deg", "a phase is a number"));
        }
        _ => {}
    }
    if query.static_part == StaticPart::Include {
        check_static(query.engine_order.is_some(), model.facts.mesh.is_some())?;
    }
    let (document, speed, bytes) = recorded(&state, &job, query.speed).await?;
    let source = field::source(&state, &model, sweep.modes_per_speed()).await?;
    let answer = match download.begin(&state, lasting(&job), &Form::FIELDS)? {
        Next::Done(response) => return Ok(response),
        Next::Make(answer) => answer,
    };
    shown.check(answer.form)?;
    let frames = shown.frames(answer.form);
    let columns = if query.engine_order.is_some() { 2 } else { frames };
    let memory = |columns| READ_MEMORY * bytes + source.memory(model.facts.own_dofs, columns);
    if query.engine_order.is_none() {
        check_memory(frames, state.jobs.most_memory(), memory)?;
    }
    let bytes = memory(columns);
    let fixed = match query.static_part {
        StaticPart::LeaveOut => None,
        StaticPart::Include => state.jobs.static_wheel(&source, model.facts.own_dofs).await?,
    };
    let speed_rad_s = sweep.speeds().rad_s().get(speed as usize).copied().unwrap_or(0.0);
    let fixed = fixed.map(|fixed| fixed.displacement(speed_rad_s, sweep.is_stiffened()));
    let excluded_radius = sweep.stress_outside();
    let (store, runtime) = (state.store.clone(), Handle::current());
    let view = (shown.view(&source), model.facts.units.clone());
    field::answer(&state, answer, bytes, view, move || {
        let states = field::read_states((&store, &runtime), job.id, document, &source)?;
        let sector = source.sector(shown.stress, excluded_radius).map_err(Box::new)?;
        let field = source.with_basis(|wheel, basis| match query.engine_order {
            Some(order) => {
                let phase = query.phase_deg.unwrap_or_default().to_radians();
                deflection_shape(&states, &sector, order, (phase, frames), basis)
            }
            None => {
                let count = states.revolutions.len();
                let at: Vec<usize> = match query.instant {
                    Some(instant) => vec![instant as usize],
                    None if frames > 1 => (0..frames).map(|frame| frame * count / frames).collect(),
                    None => vec![largest_instant(&states, wheel).unwrap_or(0)],
                };
                instants(&states, &sector, &at, basis)
            }
        })?;
        let field = field.at_speed(speed_rad_s).upon(&sector, fixed.as_deref());
        Ok(FieldFile { sector, field, part })
    })
    .await
}

/// Refuses more instants than fit into the memory that an answer can get: they are computed at once.
fn check_memory(instants: usize, most: Option<u64>, memory: impl Fn(usize) -> u64) -> Result<(), Problem> {
    let Some(most) = most.filter(|most| instants > 1 && memory(instants) > *most) else { return Ok(()) };
    let mib = |bytes: u64| bytes.div_ceil(1 << 20);
    let fit = (1..instants).rev().find(|&fewer| memory(fewer) <= most).unwrap_or(1);
    let detail = format!(
        "{instants} instants take {} MiB of memory and an answer gets {} MiB: {fit} fit; the shape of an engine order takes as much for \
         any number of frames",
        mib(memory(instants)),
        mib(most)
    );
    Err(Problem::parameter("frames", detail))
}

/// Refuses the static part where there is none: for deflection shapes, and for packages without a mesh.
fn check_static(of_shape: bool, has_mesh: bool) -> Result<(), Problem> {
    let detail = match (of_shape, has_mesh) {
        (true, _) => {
            "a deflection shape is what vibrates at one engine order: the static part goes with an instant"
        }
        (_, false) => "the package has no mesh, so nothing is known of where its mass is: leave this away",
        (false, true) => return Ok(()),
    };
    Err(Problem::parameter("static", detail))
}

/// Indices of the speeds whose states are recorded.
pub(super) async fn recorded_speeds(store: &Store, job: JobId) -> Result<Vec<u32>, StoreError> {
    store.document_parts(job, STATES).await
}

/// Document with the states of a speed, the index of that speed in the sweep, and the bytes of the document.
async fn recorded(
    state: &AppState,
    job: &Job,
    speed: Option<u32>,
) -> Result<(Document<'static>, u32, u64), Problem> {
    let all = recorded_speeds(&state.store, job.id).await?;
    let found = match speed {
        Some(speed) => all.contains(&speed).then_some(speed),
        None => all.first().copied(),
    };
    if let Some(speed) = found {
        let document = Document::part(STATES, speed);
        let bytes = state.store.document_bytes(job.id, document).await?.unwrap_or(0);
        return Ok((document, speed, bytes));
    }
    expect_successful(job, "fields are there once the speed is recorded")?;
    let detail = match all.as_slice() {
        [] => "no state was recorded: post a case study with `state` among the quantities of its record"
            .to_owned(),
        some => format!("states were recorded of speeds {some:?}"),
    };
    Err(Problem::new(Kind::HistoryNotRecorded, detail))
}

impl From<StaticWheelError> for Problem {
    fn from(error: StaticWheelError) -> Self {
        match error {
            StaticWheelError::Package(error) => Box::new(error).into(),
            StaticWheelError::Unsolved(ReductionError::Model(error)) => {
                Self::new(Kind::InvalidModel, error.to_string())
            }
            StaticWheelError::Unsolved(error) => {
                tracing::error!(%error, "the static part of the centrifugal load cannot be solved");
                Self::new(Kind::Internal, "the static part cannot be solved; the service's log says more")
            }
        }
    }
}

impl From<StatesError> for Problem {
    fn from(error: StatesError) -> Self {
        match error {
            StatesError::OtherReduction => Self::new(Kind::ResultUnavailable, error.to_string()),
            StatesError::Damaged(_) => {
                tracing::error!(%error, "a recorded state cannot be read");
                Self::new(Kind::Internal, "the recorded state cannot be read; the service's log says more")
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn more_instants_than_fit_are_refused_with_what_would() {
        let memory = |instants: usize| (100 + 10 * instants as u64) << 20;
        for (instants, most) in [(24, None), (24, Some(340 << 20)), (1, Some(0))] {
            assert!(check_memory(instants, most, memory).is_ok());
        }
        let problem = check_memory(24, Some(339 << 20), memory).unwrap_err();
        assert!(problem.detail.contains("24 instants take 340 MiB"), "{}", problem.detail);
        assert!(problem.detail.contains("gets 339 MiB: 23 fit"), "{}", problem.detail);
    }
}
