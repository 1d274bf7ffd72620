//! Run-ups and run-downs: responses of a scene whose speed changes.

use axum::extract::State;
use axum::response::Response;
use serde::{Deserialize, Serialize};
use utoipa::{IntoParams, ToSchema};

use super::download::{Download, DownloadQuery, lasting};
use super::extract::{JobPath, Parameters, job_not_found};
use super::forms::{Forms, READ_MEMORY};
use super::legs::Legs;
use super::problem::{Kind, Problem};
use super::results::{check_sensor, find, resolved, swept};
use super::state::AppState;
use crate::analysis::kinds::run_up::{LEGS, RUN_UP, SPECTRA};
use crate::analysis::resolved::ResolvedRunUps;
use crate::analysis::result::{RunUpLeg, RunUps, Spectrogram};
use crate::analysis::run::{self, ModelFacts};
use crate::export::{Array, Export};
use crate::kinds::JobKind;
use crate::plot;
use crate::store::jobs::Job;
use crate::tokens::Principal;

/// Parameters of a drawing of run-ups.
#[derive(Debug, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
pub(super) struct RunUpsQuery {
    /// Index, in the request, of the sensor that a drawing shows; default 0.
    #[serde(default)]
    sensor: u32,
    /// Id of a sweep of the same model, whose speeds a drawing shows as dots. The sweep's scene may differ.
    #[param(max_length = 64)]
    sweep: Option<String>,
}

/// Download the envelopes of run-ups over the speed.
///
/// A job that is not finished, failed or was dismissed has the frames found so far. In csv a line is a frame; npz has an array for
/// each column of the csv. `GET /v1/jobs/{id}/spectrogram` has the spectra.
#[utoipa::path(get, path = "/v1/jobs/{id}/run-ups", operation_id = "get_run_ups", tag = "results",
    params(("id" = String, Path, description = "Id of run-ups."), RunUpsQuery, DownloadQuery),
    responses(
        (status = 200, description = "The run-ups.", body = RunUps),
        (status = 409, description = "The job is of another kind, or has no frame yet.", body = Problem,
            content_type = "application/problem+json"),
    ))]
pub(super) async fn get_run_ups(
    state: State<AppState>,
    whose: Principal,
    JobPath(id): JobPath,
    Parameters(query): Parameters<RunUpsQuery>,
    download: Download,
) -> Result<Response, Problem> {
    let job = find(&state, &whose, id).await?;
    let (asked, facts) = asked(&job)?;
    check_sensor(asked.sweep().sensors(), query.sensor)?;
    let steady = swept(&state, &whose, query.sweep.as_deref(), &job).await?;
    let legs = Legs::of(&state, &job, LEGS, FRAME).await?;
    let bytes = legs.bytes();
    let (asked, facts) = (asked.clone(), facts.clone());
    let read = move || run::run_ups(&asked, &facts, legs.read()?).ok_or_else(|| job_not_found(&id));
    let sensor = query.sensor as usize;
    Forms::drawn_by(move |run_ups: &RunUps| plot::run_ups(run_ups, sensor, &steady))
        .answer(&state, download, lasting(&job), bytes, read)
        .await
}

/// Spectrogram to download, and its drawing.
#[derive(Debug, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
pub(super) struct SpectrogramQuery {
    /// Number of the run, from 0; default 0.
    #[serde(default)]
    run: u32,
    /// Index of the sensor in the request; default 0.
    #[serde(default)]
    sensor: u32,
    /// Axis of a drawing beside the speed; default `order`.
    #[serde(default)]
    #[param(inline)]
    over: Over,
}

/// Axis beside the speed in a drawn spectrogram.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub(super) enum Over {
    /// Engine order; the default.
    #[default]
    Order,
    /// Frequency in Hz: engine orders fan out.
    Hz,
}

/// Download the amplitudes of a run over engine order and speed.
///
/// A job that is not finished has the frames found so far. In csv a line is a frame and a column an engine order; npz has
/// `amplitudes` as `[frame][line]`.
#[utoipa::path(get, path = "/v1/jobs/{id}/spectrogram", operation_id = "get_spectrogram", tag = "results",
    params(("id" = String, Path, description = "Id of run-ups."), SpectrogramQuery, DownloadQuery),
    responses(
        (status = 200, description = "The spectrogram.", body = Spectrogram),
        (status = 409, description = "The job is of another kind, or has no frame of this run yet.", body = Problem,
            content_type = "application/problem+json"),
    ))]
pub(super) async fn get_spectrogram(
    state: State<AppState>,
    whose: Principal,
    JobPath(id): JobPath,
    Parameters(query): Parameters<SpectrogramQuery>,
    download: Download,
) -> Result<Response, Problem> {
    let job = find(&state, &whose, id).await?;
    let (asked, facts) = asked(&job)?;
    check_sensor(asked.sweep().sensors(), query.sensor)?;
    if query.run >= asked.runs() {
        let detail = format!("the job has {} runs, counted from 0", asked.runs());
        return Err(Problem::parameter("run", detail));
    }
    let legs = Legs::of(&state, &job, LEGS, FRAME).await?;
    let (_, spectra) = state.store.parts(id, SPECTRA).await?;
    let bytes = legs.bytes() + READ_MEMORY * spectra;
    let (asked, facts) = (asked.clone(), facts.clone());
    let SpectrogramQuery { run: number, sensor, over } = query;
    let has_ended = lasting(&job).is_some();
    let read = move || {
        let mut of_run = Vec::new();
        for (index, leg) in legs.read::<RunUpLeg>()?.into_iter().enumerate() {
            if leg.run() == number {
                let spectra = legs.read_beside(index)?.unwrap_or_default();
                of_run.push(leg.with_spectra(spectra));
            }
        }
        let found = run::run_ups(&asked, &facts, of_run).and_then(|run_ups| {
            let spectrogram = run::spectrogram(&run_ups, number, sensor as usize)?;
            Some(Drawn { spectrogram, run_ups })
        });
        let unready = if has_ended { Kind::ResultUnavailable } else { Kind::ResultNotReady };
        found.ok_or_else(|| Problem::new(unready, format!("run {number}, counted from 0, has no frame")))
    };
    let unit = match over {
        Over::Order => plot::SpectrogramUnit::Order,
        Over::Hz => plot::SpectrogramUnit::Hz,
    };
    let (place, index) = (number as usize, sensor as usize);
    Forms::drawn_by(move |drawn: &Drawn| plot::spectrogram(&drawn.run_ups, place, index, unit))
        .answer(&state, download, lasting(&job), bytes, read)
        .await
}

/// Spectrogram with the run that is drawn beside it.
#[derive(Serialize)]
#[serde(transparent)]
struct Drawn {
    spectrogram: Spectrogram,
    #[serde(skip)]
    run_ups: RunUps,
}

impl Export for Drawn {
    fn table(&self) -> Vec<Array> {
        self.spectrogram.table()
    }

    fn arrays(&self) -> Vec<Array> {
        self.spectrogram.arrays()
    }
}

/// Name, for messages, of the part that a job still lacks when it has only begun.
const FRAME: &str = "frame of a run";

fn asked(job: &Job) -> Result<(&ResolvedRunUps, &ModelFacts), Problem> {
    resolved(job, JobKind(&RUN_UP))
}
