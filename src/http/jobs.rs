//! Jobs: list, follow, cancel.

use axum::Json;
use axum::extract::State;
use serde::{Deserialize, Serialize};
use utoipa::{IntoParams, ToSchema};

use super::AppState;
use super::extract::{JobPath, Parameters, job_not_found};
use super::job_body::{JobBody, JobDetail};
use super::page;
use super::problem::{Kind, Problem};
use crate::jobs::Cancellation;
use crate::store::jobs::{JobFilter, JobId, JobKind};
use crate::store::status::JobStatus;

/// Which jobs to list.
#[derive(Debug, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
pub(super) struct JobQuery {
    /// Only jobs with this status.
    status: Option<JobStatus>,
    /// Only jobs of this kind.
    kind: Option<JobKind>,
    /// Jobs per page, 1 to 500; default 50.
    #[param(minimum = 1, maximum = 500)]
    limit: Option<u32>,
    /// Where the page begins: from `next` of the page before.
    cursor: Option<String>,
}

/// A page of jobs.
#[derive(Debug, Serialize, ToSchema)]
pub(super) struct JobList {
    /// Newest first.
    jobs: Vec<JobBody>,
    /// Path of the next page; absent on the last.
    #[serde(skip_serializing_if = "Option::is_none")]
    next: Option<String>,
}

/// List jobs.
#[utoipa::path(get, path = "/v1/jobs", operation_id = "list_jobs", tag = "jobs", params(JobQuery),
    responses(
        (status = 200, description = "A page of jobs, newest first.", body = JobList),
        (status = 400, description = "A parameter is not valid.", body = Problem,
            content_type = "application/problem+json"),
    ))]
pub(super) async fn list_jobs(
    state: State<AppState>,
    Parameters(query): Parameters<JobQuery>,
) -> Result<Json<JobList>, Problem> {
    let limit = page::limit(query.limit)?;
    let before = page::cursor(query.cursor.as_deref(), JobId::parse)?;
    let filter = JobFilter { status: query.status, kind: query.kind, before };
    // One more than asked for tells whether there is another page.
    let mut jobs = state.store.jobs(filter, limit + 1).await?;
    let next = page::cut(&mut jobs, limit).map(|last| {
        let mut next = format!("/v1/jobs?limit={limit}&cursor={}", last.id);
        if let Some(status) = query.status {
            next += &format!("&status={}", status.as_str());
        }
        if let Some(kind) = query.kind {
            next += &format!("&kind={}", kind.as_str());
        }
        next
    });
    Ok(Json(JobList { jobs: jobs.into_iter().map(JobBody::from).collect(), next }))
}

/// Follow a job.
#[utoipa::path(get, path = "/v1/jobs/{id}", operation_id = "get_job", tag = "jobs",
    params(("id" = String, Path, description = "Id of the job.")),
    responses(
        (status = 200, description = "The job.", body = JobDetail),
        (status = 404, description = "There is no such job.", body = Problem,
            content_type = "application/problem+json"),
    ))]
pub(super) async fn get_job(
    state: State<AppState>,
    JobPath(id): JobPath,
) -> Result<Json<JobDetail>, Problem> {
    let job = state.store.job(id).await?.ok_or_else(|| job_not_found(&id))?;
    let reduction = match (job.request.model(), job.request.modes_per_speed()) {
        (Some(model), Some(modes_per_speed)) => {
            let mut reports = state.store.reduction_reports(model).await?.into_iter();
            reports.find(|report| report.modes_per_speed == modes_per_speed)
        }
        _ => None,
    };
    let choice = job.choice.clone();
    Ok(Json(JobDetail { job: job.into(), choice, reduction }))
}

/// Cancel a job.
///
/// Computing stops within moments. Speeds that were finished stay readable. Cancelling a cancelled job changes nothing.
#[utoipa::path(delete, path = "/v1/jobs/{id}", operation_id = "cancel_job", tag = "jobs",
    params(("id" = String, Path, description = "Id of the job.")),
    responses(
        (status = 200, description = "The job is dismissed.", body = JobDetail),
        (status = 404, description = "There is no such job.", body = Problem,
            content_type = "application/problem+json"),
        (status = 409, description = "The job has ended already.", body = Problem,
            content_type = "application/problem+json"),
    ))]
pub(super) async fn cancel_job(
    state: State<AppState>,
    JobPath(id): JobPath,
) -> Result<Json<JobDetail>, Problem> {
    match state.jobs.cancel(id).await? {
        Cancellation::Dismissed => get_job(state, JobPath(id)).await,
        Cancellation::Unknown => Err(job_not_found(&id)),
        Cancellation::AlreadyFinal(status) => {
            let detail = format!("the job is {} and cannot be cancelled any more", status.as_str());
            Err(Problem::new(Kind::JobFinished, detail))
        }
    }
}
