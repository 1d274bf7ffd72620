//! Results of jobs.

use std::collections::BTreeSet;

use axum::extract::State;
use axum::response::Response;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use tokio::runtime::Handle;
use utoipa::{IntoParams, ToSchema};

use super::extract::{JobPath, Parameters, SpeedPath, job_not_found};
use super::problem::{Kind, Problem};
use super::state::AppState;
use super::stream::{self, Leave};
use crate::analysis::resolved::ResolvedSweep;
use crate::analysis::result::{
    Campbell, CriticalSpeeds, InteractionMap, Point, SpeedResult, SpeedSpectra, WearMap,
};
use crate::analysis::run::{self, ModelFacts};
use crate::dynamics::sector::Units;
use crate::store::jobs::{Job, JobId, JobKind, JobRequest};
use crate::store::results::Document;
use crate::store::status::JobStatus;
use crate::tokens::Principal;

/// Memory of spectra that are being read, over what they take unpacked: the row, its numbers deflated and inflated, the spectra.
pub(super) const ROW_MEMORY: u64 = 4;

/// Memory of a document, over its text: the row and the text.
pub(super) const TEXT_MEMORY: u64 = 2;

/// Memory of a document that is drawn, over its text: the text, its numbers and the drawing.
pub(super) const DRAWN_MEMORY: u64 = 4;

/// Which part of an interaction map to download.
#[derive(Debug, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
pub(super) struct MapQuery {
    /// Index of the sensor in the request; default 0.
    #[serde(default)]
    sensor: u32,
    /// Only the wheel's component in this nodal diameter.
    nodal_diameter: Option<u32>,
}

/// Which table of critical speeds to download.
#[derive(Debug, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
pub(super) struct SensorQuery {
    /// Index of the sensor in the request; default 0.
    #[serde(default)]
    pub(super) sensor: u32,
}

/// One speed of a sweep.
#[derive(Debug, Serialize, ToSchema)]
pub(super) struct SpectraBody {
    /// Credentials and summary.
    point: Point,
    /// Units of the model.
    units: Units,
    /// Amplitudes over engine order, per sensor and nodal diameter; null unless `point.status` is `completed`.
    spectra: Option<SpeedSpectra>,
    /// Wear of an abradable coating; absent without one.
    #[serde(skip_serializing_if = "Option::is_none")]
    wear: Option<WearMap>,
}

/// Download the interaction map: amplitude over speed and engine order.
///
/// While the job runs, the map has the speeds finished so far; rows of the others are null. A speed that diverged or
/// failed is in `points` with its message and has no amplitude.
#[utoipa::path(get, path = "/v1/jobs/{id}/interaction-map", operation_id = "get_interaction_map", tag = "results",
    params(("id" = String, Path, description = "Id of a sweep."), MapQuery),
    responses(
        (status = 200, description = "The map.", body = InteractionMap),
        (status = 400, description = "A parameter is not valid.", body = Problem,
            content_type = "application/problem+json"),
        (status = 404, description = "There is no such job.", body = Problem,
            content_type = "application/problem+json"),
        (status = 409, description = "The job is not a sweep.", body = Problem,
            content_type = "application/problem+json"),
    ))]
pub(super) async fn get_interaction_map(
    state: State<AppState>,
    whose: Principal,
    JobPath(id): JobPath,
    Parameters(query): Parameters<MapQuery>,
) -> Result<Response, Problem> {
    let job = find(&state, &whose, id).await?;
    let (request, facts) = sweep(&job)?;
    check_sensor(request, query.sensor)?;
    let largest = facts.sectors / 2;
    if query.nodal_diameter.is_some_and(|nodal_diameter| nodal_diameter > largest) {
        let detail = format!("{} sectors have nodal diameters 0 to {largest}", facts.sectors);
        return Err(Problem::parameter("nodal_diameter", detail));
    }
    let MapQuery { sensor, nodal_diameter } = query;
    let sensor = sensor as usize;
    let leave = state.answers.leave(&state.jobs, ROW_MEMORY * state.store.largest_spectra(id).await?).await;
    let errors = state.store.document(id, Document::Errors).await?;
    let errors = errors.map(|errors| serde_json::from_str(&errors)).transpose()?;
    let (store, runtime) = (state.store.clone(), Handle::current());
    let map = stream::blocking(move || {
        let (request, facts) = sweep(&job)?;
        let points = runtime.block_on(store.points(id))?.into_iter().map(|point| (point, None)).collect();
        let map = run::interaction_map(request, &facts.units, points, sensor, nodal_diameter);
        let map = InteractionMap { plan: job.plan.clone(), errors, amplitude: Vec::new(), ..map };
        Ok::<_, Problem>((map, leave))
    });
    let (map, leave) = map.await??;
    let (store, runtime) = (state.store.clone(), Handle::current());
    Ok(stream::json(leave, move || {
        let row =
            move |spectra: &SpeedSpectra| run::map_row(spectra, sensor, nodal_diameter).map(<[f64]>::to_vec);
        // Speeds finished since the points were read are for the next reader.
        let finished: BTreeSet<u32> = map.points.iter().map(|point| point.index).collect();
        let item = move |index| match finished.contains(&index) {
            true => runtime.block_on(store.map_row(id, index, row)),
            false => Ok(None),
        };
        MapInPieces { amplitude: stream::Read { items: map.speeds_rad_s.len() as u32, item }, map }
    }))
}

/// A map whose rows are read from the store while they are sent: all of them may be larger than memory.
#[derive(Serialize)]
struct MapInPieces<R> {
    amplitude: R,
    /// Without rows.
    #[serde(flatten)]
    map: InteractionMap,
}

/// Download the spectra of one speed.
#[utoipa::path(get, path = "/v1/jobs/{id}/spectra/{index}", operation_id = "get_spectra", tag = "results",
    params(
        ("id" = String, Path, description = "Id of a sweep."),
        ("index" = u32, Path, description = "Index of the speed in the request, from 0."),
    ),
    responses(
        (status = 200, description = "The speed.", body = SpectraBody),
        (status = 404, description = "There is no such job or speed, or the job ended before it.", body = Problem,
            content_type = "application/problem+json"),
        (status = 409, description = "The job is not a sweep, or the speed is not finished yet.", body = Problem,
            content_type = "application/problem+json"),
    ))]
pub(super) async fn get_spectra(
    state: State<AppState>,
    whose: Principal,
    SpeedPath(id, index): SpeedPath,
) -> Result<Response, Problem> {
    let job = find(&state, &whose, id).await?;
    let (_, facts) = sweep(&job)?;
    let total = job.speeds.total;
    let index = index.filter(|index| *index < total).ok_or_else(|| {
        Problem::new(Kind::SpeedNotFound, format!("the job has {total} speeds, counted from 0"))
    })?;
    let leave = state.answers.leave(&state.jobs, ROW_MEMORY * state.store.largest_spectra(id).await?).await;
    let (store, runtime) = (state.store.clone(), Handle::current());
    let read = move || Ok::<_, Problem>((runtime.block_on(store.speed_result(id, index))?, leave));
    let (result, leave) = stream::blocking(read).await??;
    match result {
        Some(result) => {
            let SpeedResult { point, spectra, wear, .. } = result;
            let units = facts.units.clone();
            Ok(stream::json(leave, move || SpectraBody { point, units, spectra, wear }))
        }
        None if job.status.is_final() => Err(Problem::new(
            Kind::SpeedNotFound,
            format!("the job was {} before speed {index} was computed", job.status.as_str()),
        )),
        None => Err(Problem::new(Kind::ResultNotReady, format!("speed {index} is not finished yet"))),
    }
}

/// Download the critical speeds of a sweep beside the linear prediction.
///
/// They are said of all speeds together, once the job is successful. Of a job that is not finished, failed or was dismissed the
/// interaction map has the speeds that are done.
#[utoipa::path(get, path = "/v1/jobs/{id}/critical-speeds", operation_id = "get_critical_speeds", tag = "results",
    params(("id" = String, Path, description = "Id of a sweep."), SensorQuery),
    responses(
        (status = 200, description = "The table.", body = CriticalSpeeds),
        (status = 400, description = "A parameter is not valid.", body = Problem,
            content_type = "application/problem+json"),
        (status = 404, description = "There is no such job.", body = Problem,
            content_type = "application/problem+json"),
        (status = 409, description = "The job is not a sweep, not finished, or ended without this result.",
            body = Problem, content_type = "application/problem+json"),
    ))]
pub(super) async fn get_critical_speeds(
    state: State<AppState>,
    whose: Principal,
    JobPath(id): JobPath,
    Parameters(query): Parameters<SensorQuery>,
) -> Result<Response, Problem> {
    let job = find(&state, &whose, id).await?;
    check_sensor(sweep(&job)?.0, query.sensor)?;
    document(&state, &job, Document::CriticalSpeeds(query.sensor)).await
}

/// Download natural frequencies over speed with the linear criterion's crossings.
#[utoipa::path(get, path = "/v1/jobs/{id}/campbell", operation_id = "get_campbell", tag = "results",
    params(("id" = String, Path, description = "Id of a modal analysis.")),
    responses(
        (status = 200, description = "The Campbell data.", body = Campbell),
        (status = 404, description = "There is no such job.", body = Problem,
            content_type = "application/problem+json"),
        (status = 409, description = "The job is not a modal analysis, not finished, or ended without this result.",
            body = Problem, content_type = "application/problem+json"),
    ))]
pub(super) async fn get_campbell(
    state: State<AppState>,
    whose: Principal,
    JobPath(id): JobPath,
) -> Result<Response, Problem> {
    let job = find(&state, &whose, id).await?;
    if !matches!(job.request, JobRequest::ModalAnalysis(_)) {
        return Err(wrong_kind(&job, JobKind::ModalAnalysis));
    }
    document(&state, &job, Document::Campbell).await
}

/// The job `id`, if who asks may see it: jobs of others are as if they were not there.
pub(super) async fn find(state: &AppState, whose: &Principal, id: JobId) -> Result<Job, Problem> {
    let job = state.store.job(id).await?.filter(|job| whose.sees(&job.owner));
    job.ok_or_else(|| job_not_found(&id))
}

/// Refuses a job that was not successful, and says what there is `instead`.
pub(super) fn expect_successful(job: &Job, instead: &str) -> Result<(), Problem> {
    let (kind, how) = match job.status {
        JobStatus::Successful => return Ok(()),
        JobStatus::Accepted | JobStatus::Running => (Kind::ResultNotReady, format!("at {} %", job.progress)),
        JobStatus::Failed | JobStatus::Dismissed => (Kind::ResultUnavailable, job.status.as_str().to_owned()),
    };
    Err(Problem::new(kind, format!("the job is {how}; {instead}")))
}

/// The request of a sweep and the facts of its model.
fn sweep(job: &Job) -> Result<(&ResolvedSweep, &ModelFacts), Problem> {
    match (&job.request, &job.facts) {
        (JobRequest::Sweep(request), Some(facts)) => Ok((request, facts)),
        _ => Err(wrong_kind(job, JobKind::Sweep)),
    }
}

pub(super) fn check_sensor(request: &ResolvedSweep, sensor: u32) -> Result<(), Problem> {
    let sensors = request.sensors().len();
    if sensor as usize >= sensors {
        return Err(Problem::parameter("sensor", format!("the job has {sensors} sensors, counted from 0")));
    }
    Ok(())
}

pub(super) fn wrong_kind(job: &Job, wanted: JobKind) -> Problem {
    let (is, wanted) = (job.request.kind().as_str(), wanted.as_str());
    Problem::new(
        Kind::WrongJobKind,
        format!("this result belongs to jobs of kind {wanted}; the job is a {is}"),
    )
}

/// A document as it was stored.
pub(super) async fn document(state: &AppState, job: &Job, document: Document) -> Result<Response, Problem> {
    let leave = leave_for(state, job, document, TEXT_MEMORY).await?;
    let body = read(state, job.id, document);
    let (body, leave) = stream::blocking(move || Ok::<_, Problem>((body()?, leave))).await??;
    Ok(stream::text(leave, "application/json", body))
}

/// A document in another form, which `draw` gives it.
pub(super) async fn drawn<T: DeserializeOwned>(
    state: &AppState,
    job: &Job,
    document: Document,
    content_type: &'static str,
    draw: impl FnOnce(&T) -> String + Send + 'static,
) -> Result<Response, Problem> {
    let leave = leave_for(state, job, document, DRAWN_MEMORY).await?;
    let body = read(state, job.id, document);
    let drawing = move || Ok::<_, Problem>((draw(&serde_json::from_str(&body()?)?), leave));
    let (drawing, leave) = stream::blocking(drawing).await??;
    Ok(stream::text(leave, content_type, drawing))
}

/// What reads the text of a document, on a thread that may wait.
fn read(
    state: &AppState,
    job: JobId,
    document: Document,
) -> impl FnOnce() -> Result<String, Problem> + Send + 'static {
    let (store, runtime) = (state.store.clone(), Handle::current());
    move || runtime.block_on(store.document(job, document))?.ok_or_else(|| job_not_found(&job))
}

/// Leave to answer with a document that takes `times` its text in memory; the reason if there is none.
async fn leave_for(state: &AppState, job: &Job, document: Document, times: u64) -> Result<Leave, Problem> {
    if let Some(bytes) = state.store.document_bytes(job.id, document).await? {
        return Ok(state.answers.leave(&state.jobs, times * bytes).await);
    }
    let instead = match document {
        Document::CriticalSpeeds(_) => {
            ": critical speeds are said of all speeds together; the interaction map has those that are done"
        }
        _ => "",
    };
    Err(match job.status {
        JobStatus::Accepted | JobStatus::Running | JobStatus::Successful => {
            Problem::new(Kind::ResultNotReady, format!("the job is at {} %{instead}", job.progress))
        }
        JobStatus::Failed | JobStatus::Dismissed => {
            let status = job.status.as_str();
            Problem::new(Kind::ResultUnavailable, format!("the job is {status}{instead}"))
        }
    })
}
