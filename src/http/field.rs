//! Common parts of requests for fields: which part of the wheel, which view and form, and what is refused.

use std::io;

use axum::response::Response;
use serde::Deserialize;
use tokio::runtime::Handle;
use utoipa::{IntoParams, ToSchema};

use super::download::Answer;
use super::form::Form;
use super::problem::{Kind, Problem};
use super::state::AppState;
use super::stream;
use crate::analysis::fields::{FieldError, Part, surface};
use crate::analysis::kinds::document::Document;
use crate::analysis::run::ModelFacts;
use crate::dynamics::sector::Units;
use crate::dynamics::states::WheelStates;
use crate::export::fields::FieldFile;
use crate::jobs::FieldSource;
use crate::plot::{self, SurfaceView};
use crate::store::jobs::JobId;
use crate::store::models::StoredModel;
use crate::store::{Store, states};

/// Frames of a pvd by default, over a period or over the recorded instants.
const FRAMES: u32 = 24;

/// Part of a field to download, and its drawing.
#[derive(Debug, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
pub(super) struct ShownQuery {
    /// Index of the one sector to download, from 0; default all sectors.
    sector: Option<u32>,
    /// Adds stress, in the model's units: that of the vibration, for a mode at a largest displacement of 1. The static part of the
    /// centrifugal load is not included unless `static` says so. `excluded` in files marks where no stress is claimed, near contact
    /// nodes.
    #[serde(default)]
    pub(super) stress: bool,
    /// Direction from which a drawing shows the wheel; default `front`.
    #[param(inline)]
    view: Option<ViewWord>,
    /// Number of files of a pvd, over one period or over all recorded instants; default 24. Instants are computed at once: more
    /// than memory has room for are refused with the number that fits.
    #[param(minimum = 1, maximum = 96)]
    frames: Option<u32>,
}

impl ShownQuery {
    /// Part that is asked for, one sector or the wheel; refuses a sector that does not exist, and stress where there is no mesh.
    pub(super) fn part(&self, facts: &ModelFacts) -> Result<Part, Problem> {
        if self.stress && facts.mesh.is_none() {
            let detail =
                "the package has no mesh, so nothing is known of stress; displacement comes as points";
            return Err(Problem::parameter("stress", detail));
        }
        part(self.sector, facts)
    }

    /// Refuses parameters that do not apply to an answer in this form.
    pub(super) fn check(&self, form: Form) -> Result<(), Problem> {
        let refused = [
            ("frames", self.frames.is_some() && form != Form::Pvd, "only a pvd has frames"),
            ("view", self.view.is_some() && !form.is_drawing(), "only a drawing has a view: svg and png"),
            ("stress", self.stress && form == Form::Json, "json lists frequencies: stress goes with a shape"),
            (
                "sector",
                self.sector.is_some() && form == Form::Json,
                "json lists frequencies: they are of the wheel",
            ),
        ];
        match refused.into_iter().find(|(_, refused, _)| *refused) {
            Some((name, _, detail)) => Err(Problem::parameter(name, detail)),
            None => Ok(()),
        }
    }

    /// Number of frames of an answer in this form.
    pub(super) fn frames(&self, form: Form) -> usize {
        if form == Form::Pvd { self.frames.unwrap_or(FRAMES) as usize } else { 1 }
    }

    /// View of a drawing of a field that is computed from `source`.
    pub(super) fn view(&self, source: &FieldSource) -> SurfaceView {
        self.view.unwrap_or_default().of(source)
    }
}

/// Direction from which a drawing shows the wheel.
#[derive(Debug, Clone, Copy, Default, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub(super) enum ViewWord {
    /// View along the axis, from the side of the casing, where the blades are seen.
    #[default]
    Front,
    /// View along the axis, from the side opposite to the casing.
    Rear,
    /// View across the axis.
    Meridional,
}

impl ViewWord {
    /// View of a field that is computed from `source`: its casing decides which side of the axis is the front.
    pub(super) fn of(self, source: &FieldSource) -> SurfaceView {
        match (self, source.opens_along_axis()) {
            (Self::Front, true) | (Self::Rear, false) => SurfaceView::Front,
            (Self::Front, false) | (Self::Rear, true) => SurfaceView::Rear,
            (Self::Meridional, _) => SurfaceView::Meridional,
        }
    }
}

/// Part of a wheel: the sector of this index, if it exists, or the whole wheel.
pub(super) fn part(sector: Option<u32>, facts: &ModelFacts) -> Result<Part, Problem> {
    match sector {
        None => Ok(Part::Wheel),
        Some(sector) if sector < facts.sectors => Ok(Part::Sector(sector as usize)),
        Some(_) => {
            let last = facts.sectors - 1;
            Err(Problem::parameter("sector", format!("the wheel has sectors 0 to {last}")))
        }
    }
}

/// Source of a model's fields: its reduction with so many modes per speed, which must have been computed.
pub(super) async fn source(
    state: &AppState,
    model: &StoredModel,
    modes_per_speed: u32,
) -> Result<FieldSource, Problem> {
    let found = state.jobs.field_source(&model.id, modes_per_speed).await?;
    found.ok_or_else(|| {
        let detail = format!(
            "model {} has no reduction with {modes_per_speed} modes per speed: a sweep or a modal analysis with it makes one",
            model.id
        );
        Problem::new(Kind::NotReduced, detail)
    })
}

/// Makes a field and writes it in the form of an answer.
pub(super) async fn answer(
    state: &AppState,
    answer: Answer,
    bytes: u64,
    (view, units): (SurfaceView, Units),
    make: impl FnOnce() -> Result<FieldFile, Problem> + Send + 'static,
) -> Result<Response, Problem> {
    let length = units.length.clone();
    let make = move || make().map(|file| file.claiming(&length));
    if answer.form.is_drawing() {
        let leave = state.answers.leave(&state.jobs, bytes + answer.bytes()).await;
        let draw = move || {
            let FieldFile { sector, field, part } = make()?;
            let surface = surface(&field, &sector, part, 0, &units).ok_or_else(|| {
                Problem::parameter("format", "the package has no mesh, so there is no surface to draw; vtu, vtp and npz have its nodes")
            })?;
            Ok(plot::surface(&surface, view))
        };
        return answer.drawn(state, leave, draw).await;
    }
    written(state, answer, bytes, make).await
}

/// Makes a field and writes it in the form of an answer that is not a drawing.
pub(super) async fn written(
    state: &AppState,
    answer: Answer,
    bytes: u64,
    make: impl FnOnce() -> Result<FieldFile, Problem> + Send + 'static,
) -> Result<Response, Problem> {
    let leave = state.answers.leave(&state.jobs, bytes).await;
    let (file, leave) = stream::blocking(move || Ok::<_, Problem>((make()?, leave))).await??;
    let form = answer.form;
    Ok(answer.written(leave, move |out| match form {
        Form::Vtp => file.vtp(out),
        Form::Npz => file.npz(out),
        Form::Pvd => file.pvd(out),
        _ => file.vtu(out),
    }))
}

/// Reads the recorded states of a speed; waits for the database.
pub(super) fn read_states(
    (store, runtime): (&Store, &Handle),
    job: JobId,
    document: Document<'_>,
    source: &FieldSource,
) -> Result<WheelStates, Problem> {
    let text = runtime.block_on(store.document(job, document))?.unwrap_or_default();
    Ok(states::unpack(&text, &source.reduced().wheel)?)
}

impl From<FieldError> for Problem {
    fn from(error: FieldError) -> Self {
        match error {
            FieldError::Parameter { parameter, message } => Self::parameter(parameter, message),
            FieldError::Model(error) => Self::new(Kind::InvalidModel, error.to_string()),
            FieldError::Basis(error) if is_lost(&error) => {
                tracing::warn!(%error, "the basis of a stored reduction cannot be read");
                let detail = "the rows of this reduction's basis at the nodes are not there, or damaged: a modal analysis or a sweep \
                              with the same modes_per_speed and \"fields\": true reduces once more and keeps them; then ask again";
                Self::new(Kind::NotReduced, detail)
            }
            FieldError::Basis(error) => error.into(),
        }
    }
}

/// Whether a basis was not stored, or is damaged.
fn is_lost(error: &io::Error) -> bool {
    use io::ErrorKind::{InvalidData, NotFound, UnexpectedEof};

    matches!(error.kind(), NotFound | InvalidData | UnexpectedEof)
}
