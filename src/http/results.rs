//! Results of jobs.

use axum::extract::State;
use axum::response::Response;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use utoipa::{IntoParams, ToSchema};

use super::download::{Download, DownloadQuery};
use super::extract::{JobPath, Parameters, job_not_found, parse_job_id};
use super::forms::Forms;
use super::problem::{Kind, Problem};
use super::state::AppState;
use crate::analysis::kinds::document::Document;
use crate::analysis::kinds::kind::ResolvedJob;
use crate::analysis::kinds::modal_analysis::{CAMPBELL, MODAL_ANALYSIS};
use crate::analysis::kinds::sweep::{CRITICAL_SPEEDS, SWEEP};
use crate::analysis::resolved::{ResolvedModalAnalysis, ResolvedSensor, ResolvedSweep};
use crate::analysis::result::{Campbell, CriticalSpeeds, Point, most_utilised_first};
use crate::analysis::run::ModelFacts;
use crate::export::Export;
use crate::kinds::JobKind;
use crate::plot::{self, Frame};
use crate::store::jobs::{Job, JobId};
use crate::store::status::JobStatus;
use crate::tokens::Principal;

/// Sensor whose result to download.
#[derive(Debug, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
pub(super) struct SensorQuery {
    /// Index of the sensor in the request; default 0.
    #[serde(default)]
    pub(super) sensor: u32,
}

/// Order of critical speeds.
#[derive(Debug, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
pub(super) struct RankQuery {
    /// Quantity by which critical speeds are ranked, the largest first; without it those of a sensor ascend in speed, and those of
    /// the wheel begin with the most severe.
    #[param(inline)]
    rank: Option<RankWord>,
}

/// Quantity by which critical speeds can be ranked.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub(super) enum RankWord {
    /// Largest utilisation at the speed; speeds without one come last. The sweep must have recorded stress.
    Utilisation,
}

impl RankQuery {
    /// Forms of a table of `request`, ranked as the query asks for; `by_utilisation` ranks it so.
    pub(super) fn ranked<T>(
        &self,
        forms: Forms<T>,
        request: &ResolvedSweep,
        by_utilisation: fn(&mut T),
    ) -> Result<Forms<T>, Problem>
    where
        T: Export + Serialize + DeserializeOwned + Send + 'static,
    {
        match self.rank {
            None => Ok(forms),
            Some(RankWord::Utilisation) if request.stress_outside().is_none() => {
                let detail = "the sweep recorded no stress, so nothing is known of utilisation: ask for \"record\": {\"stress\": {}}";
                Err(Problem::parameter("rank", detail))
            }
            Some(RankWord::Utilisation) => Ok(forms.changed_by(by_utilisation)),
        }
    }
}

/// Download the critical speeds of a sweep beside the linear prediction.
///
/// Critical speeds are found from all speeds together, once the job is successful. If it is not finished, failed or was dismissed,
/// the interaction map has the speeds that are finished.
#[utoipa::path(get, path = "/v1/jobs/{id}/critical-speeds", operation_id = "get_critical_speeds", tag = "results",
    params(("id" = String, Path, description = "Id of a sweep."), SensorQuery, RankQuery, DownloadQuery),
    responses(
        (status = 200, description = "The table.", body = CriticalSpeeds),
        (status = 409, description = "The job is not a sweep, not finished, or ended without this result.",
            body = Problem, content_type = "application/problem+json"),
    ))]
pub(super) async fn get_critical_speeds(
    state: State<AppState>,
    whose: Principal,
    JobPath(id): JobPath,
    Parameters(query): Parameters<SensorQuery>,
    Parameters(rank): Parameters<RankQuery>,
    download: Download,
) -> Result<Response, Problem> {
    let job = find(&state, &whose, id).await?;
    let (request, _) = sweep(&job)?;
    check_sensor(request.sensors(), query.sensor)?;
    let by_utilisation = |table: &mut CriticalSpeeds| {
        most_utilised_first(&mut table.critical_speeds, |speed| speed.utilisation);
    };
    rank.ranked(Forms::drawn_by(plot::critical_speeds), request, by_utilisation)?
        .of_document(&state, download, &job, Document::part(CRITICAL_SPEEDS, query.sensor))
        .await
}

/// Parameters of a drawing of natural frequencies over speed.
#[derive(Debug, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
pub(super) struct CampbellQuery {
    /// Frame in which a drawing shows the vibration; default `rotating`.
    #[param(inline)]
    frame: Option<FrameWord>,
}

/// Frame of reference of a vibration.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub(super) enum FrameWord {
    /// Frame of the wheel.
    Rotating,
    /// Frame of the casing.
    Fixed,
}

impl FrameWord {
    /// Frame of a drawing; rotating unless another is asked for.
    pub(super) fn frame(asked: Option<Self>) -> Frame {
        match asked {
            Some(Self::Fixed) => Frame::Fixed,
            Some(Self::Rotating) | None => Frame::Rotating,
        }
    }
}

/// Download natural frequencies over speed with the linear criterion's crossings.
///
/// In csv a line is a family of a nodal diameter at a speed; in npz frequencies are `[speed][nodal diameter][family]`, NaN where there
/// are fewer, and crossings one array per field.
#[utoipa::path(get, path = "/v1/jobs/{id}/campbell", operation_id = "get_campbell", tag = "results",
    params(("id" = String, Path, description = "Id of a modal analysis."), CampbellQuery, DownloadQuery),
    responses(
        (status = 200, description = "The Campbell data.", body = Campbell),
        (status = 409, description = "The job is not a modal analysis, not finished, or ended without this result.",
            body = Problem, content_type = "application/problem+json"),
    ))]
pub(super) async fn get_campbell(
    state: State<AppState>,
    whose: Principal,
    JobPath(id): JobPath,
    Parameters(query): Parameters<CampbellQuery>,
    download: Download,
) -> Result<Response, Problem> {
    let job = find(&state, &whose, id).await?;
    resolved::<ResolvedModalAnalysis>(&job, JobKind(&MODAL_ANALYSIS))?;
    let forms = match FrameWord::frame(query.frame) {
        Frame::Rotating => Forms::drawn_by(plot::campbell),
        Frame::Fixed => Forms::drawn_by(plot::campbell_fixed_frame),
    };
    forms.of_document(&state, download, &job, CAMPBELL).await
}

/// Finds the job `id`, if the principal may see it: jobs of others are reported as missing.
pub(super) async fn find(state: &AppState, whose: &Principal, id: JobId) -> Result<Job, Problem> {
    let job = state.store.job(id).await?.filter(|job| whose.sees(&job.owner));
    job.ok_or_else(|| job_not_found(&id))
}

/// Refuses a job that was not successful; the message names what there is `instead`.
pub(super) fn expect_successful(job: &Job, instead: &str) -> Result<(), Problem> {
    let (kind, how) = match job.status {
        JobStatus::Successful => return Ok(()),
        JobStatus::Accepted | JobStatus::Running | JobStatus::Paused => {
            (Kind::ResultNotReady, format!("at {} %", job.progress))
        }
        JobStatus::Failed | JobStatus::Dismissed => (Kind::ResultUnavailable, job.status.as_str().to_owned()),
    };
    Err(Problem::new(kind, format!("the job is {how}; {instead}")))
}

/// Resolved request of a job of this `kind`, and the facts of its model; refuses jobs of other kinds.
pub(super) fn resolved<R: ResolvedJob>(job: &Job, kind: JobKind) -> Result<(&R, &ModelFacts), Problem> {
    job.request.get().zip(job.facts.as_ref()).ok_or_else(|| wrong_kind(job, kind))
}

/// Request of a sweep and the facts of its model; refuses jobs of other kinds.
pub(super) fn sweep(job: &Job) -> Result<(&ResolvedSweep, &ModelFacts), Problem> {
    resolved(job, JobKind(&SWEEP))
}

/// Speeds of the sweep with this id, which are drawn beside the result of `job` and must be of the same model; none without an id.
pub(super) async fn swept(
    state: &AppState,
    whose: &Principal,
    id: Option<&str>,
    job: &Job,
) -> Result<Vec<Point>, Problem> {
    let Some(id) = id else { return Ok(Vec::new()) };
    let other = find(state, whose, parse_job_id(id)?).await?;
    sweep(&other)?;
    if other.model != job.model {
        return Err(Problem::parameter("sweep", "a sweep of the model of this job"));
    }
    Ok(state.store.points(other.id).await?)
}

pub(super) fn check_sensor(sensors: &[ResolvedSensor], sensor: u32) -> Result<(), Problem> {
    let sensors = sensors.len();
    if sensor as usize >= sensors {
        return Err(Problem::parameter("sensor", format!("the job has {sensors} sensors, counted from 0")));
    }
    Ok(())
}

pub(super) fn wrong_kind(job: &Job, wanted: JobKind) -> Problem {
    let (is, wanted) = (job.kind.name, wanted.name);
    Problem::new(
        Kind::WrongJobKind,
        format!("this result belongs to jobs of kind {wanted}; the job is a {is}"),
    )
}
