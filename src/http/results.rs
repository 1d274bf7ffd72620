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
use crate::analysis::resolved::{ResolvedSensor, ResolvedSweep};
use crate::analysis::result::{Campbell, CriticalSpeeds, Point, most_utilised_first};
use crate::analysis::run::ModelFacts;
use crate::export::Export;
use crate::plot::{self, Frame};
use crate::store::jobs::{Job, JobId, JobKind, JobRequest};
use crate::store::results::Document;
use crate::store::status::JobStatus;
use crate::tokens::Principal;

/// Which table of critical speeds to download.
#[derive(Debug, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
pub(super) struct SensorQuery {
    /// Index of the sensor in the request; default 0.
    #[serde(default)]
    pub(super) sensor: u32,
}

/// In which order critical speeds come.
#[derive(Debug, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
pub(super) struct RankQuery {
    /// What critical speeds are ranked by, the largest first; without it those of a sensor ascend in speed, and those of the wheel
    /// begin with the most severe.
    #[param(inline)]
    rank: Option<RankWord>,
}

/// What critical speeds can be ranked by.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub(super) enum RankWord {
    /// The largest utilisation at the speed; speeds without one come last. Of a sweep that recorded stress.
    Utilisation,
}

impl RankQuery {
    /// The forms of a table of `request`, ranked as it is asked for; `by_utilisation` does so.
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
/// They are said of all speeds together, once the job is successful. Of a job that is not finished, failed or was dismissed the
/// interaction map has the speeds that are done.
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
    rank.ranked(
        Forms::drawn_by(plot::critical_speeds, plot::figure::critical_speeds),
        request,
        by_utilisation,
    )?
    .of_document(&state, download, &job, Document::CriticalSpeeds(query.sensor))
    .await
}

/// Which frequencies over speed to download.
#[derive(Debug, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
pub(super) struct CampbellQuery {
    /// Of a drawing: the frame in which the vibration is seen; default `rotating`.
    #[param(inline)]
    frame: Option<FrameWord>,
}

/// Frame in which vibration is seen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub(super) enum FrameWord {
    /// On the wheel.
    Rotating,
    /// On the casing.
    Fixed,
}

impl FrameWord {
    /// The frame of a drawing.
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
    if !matches!(job.request, JobRequest::ModalAnalysis(_)) {
        return Err(wrong_kind(&job, JobKind::ModalAnalysis));
    }
    let forms = match FrameWord::frame(query.frame) {
        Frame::Rotating => Forms::drawn_by(plot::campbell, plot::figure::campbell),
        Frame::Fixed => Forms::drawn_by(plot::campbell_fixed_frame, plot::figure::campbell_fixed_frame),
    };
    forms.of_document(&state, download, &job, Document::Campbell).await
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
        JobStatus::Accepted | JobStatus::Running | JobStatus::Paused => {
            (Kind::ResultNotReady, format!("at {} %", job.progress))
        }
        JobStatus::Failed | JobStatus::Dismissed => (Kind::ResultUnavailable, job.status.as_str().to_owned()),
    };
    Err(Problem::new(kind, format!("the job is {how}; {instead}")))
}

/// The request of a sweep and the facts of its model.
pub(super) fn sweep(job: &Job) -> Result<(&ResolvedSweep, &ModelFacts), Problem> {
    match (&job.request, &job.facts) {
        (JobRequest::Sweep(request), Some(facts)) => Ok((request, facts)),
        _ => Err(wrong_kind(job, JobKind::Sweep)),
    }
}

/// Speeds of the sweep with this id, of the same model as `job`, that are drawn beside; none of none.
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
    let (is, wanted) = (job.request.kind().as_str(), wanted.as_str());
    Problem::new(
        Kind::WrongJobKind,
        format!("this result belongs to jobs of kind {wanted}; the job is a {is}"),
    )
}
