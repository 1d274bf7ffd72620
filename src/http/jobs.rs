//! Jobs: list, follow, cancel, delete.

use axum::Json;
use axum::extract::State;
use axum::http::StatusCode;
use axum::response::{IntoResponse, Response};
use serde::{Deserialize, Serialize};
use utoipa::{IntoParams, ToSchema};

use super::extract::{JobPath, MergePatch, Parameters, job_not_found};
use super::job_body::{JobBody, JobDetail};
use super::labels::LabelPatch;
use super::page;
use super::problem::{Kind, Problem};
use super::results::find;
use super::state::AppState;
use crate::jobs::Cancellation;
use crate::kinds::JobKind;
use crate::store::StoreError;
use crate::store::jobs::{Job, JobDeletion, JobFilter, JobHead, JobId};
use crate::store::status::JobStatus;
use crate::tokens::Principal;

/// Filters of a list of jobs, and its page.
#[derive(Debug, Serialize, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
pub(super) struct JobQuery {
    /// Status of the jobs to list; default any.
    #[serde(skip_serializing_if = "Option::is_none")]
    status: Option<JobStatus>,
    /// Kind of the jobs to list; default any.
    #[serde(skip_serializing_if = "Option::is_none")]
    kind: Option<JobKind>,
    /// Id of a model: lists only jobs that compute from it, or made it.
    #[serde(skip_serializing_if = "Option::is_none")]
    model: Option<String>,
    /// Text in the names of the jobs to list; letters a to z may be capitals or not.
    #[serde(skip_serializing_if = "Option::is_none")]
    name: Option<String>,
    /// Tag of the jobs to list.
    #[serde(skip_serializing_if = "Option::is_none")]
    tag: Option<String>,
    /// Jobs per page, 1 to 500; default 50.
    #[param(minimum = 1, maximum = 500)]
    limit: Option<u32>,
    /// Cursor at which the page begins: from `next` of the page before.
    cursor: Option<String>,
}

/// Page of a list of jobs.
#[derive(Debug, Serialize, ToSchema)]
pub(super) struct JobList {
    /// Jobs of the page, newest first.
    jobs: Vec<JobBody>,
    /// Path of the next page; absent on the last.
    #[serde(skip_serializing_if = "Option::is_none")]
    next: Option<String>,
}

/// List jobs.
#[utoipa::path(get, path = "/v1/jobs", operation_id = "list_jobs", tag = "jobs", params(JobQuery),
    responses(
        (status = 200, description = "A page of jobs, newest first.", body = JobList),
    ))]
pub(super) async fn list_jobs(
    state: State<AppState>,
    whose: Principal,
    Parameters(query): Parameters<JobQuery>,
) -> Result<Json<JobList>, Problem> {
    let limit = page::limit(query.limit)?;
    let before = page::cursor(query.cursor.as_deref(), JobId::parse)?;
    let owner = whose.only().map(ToOwned::to_owned);
    let JobQuery { status, kind, model, name, tag, .. } = &query;
    let (model, name, tag) = (model.clone(), name.clone(), tag.clone());
    let filter = JobFilter { owner, status: *status, kind: *kind, model, name, tag, before };
    // One more than asked for tells whether there is another page.
    let mut jobs = state.store.jobs(filter, limit + 1).await?;
    let next = page::cut(&mut jobs, limit).map(|last| {
        let cursor = Some(last.id.to_string());
        page::path("/v1/jobs", &JobQuery { limit: Some(limit), cursor, ..query })
    });
    let next = next.transpose()?;
    for job in &mut jobs {
        tell_phase(&state, job);
    }
    Ok(Json(JobList { jobs: jobs.into_iter().map(JobBody::from).collect(), next }))
}

/// Puts the present phase into a job: the stored one is a second old, or older while the store takes nothing.
fn tell_phase(state: &AppState, job: &mut JobHead) {
    if let Some(phase) = state.jobs.phase(job.id) {
        job.phase = phase;
    }
}

/// Read the state of a job, its request, and links to its results.
#[utoipa::path(get, path = "/v1/jobs/{id}", operation_id = "get_job", tag = "jobs",
    params(("id" = String, Path, description = "Id of the job.")),
    responses(
        (status = 200, description = "The job.", body = JobDetail),
    ))]
pub(super) async fn get_job(
    state: State<AppState>,
    whose: Principal,
    JobPath(id): JobPath,
) -> Result<Json<JobDetail>, Problem> {
    let job = find(&state, &whose, id).await?;
    Ok(Json(detail(&state, job).await?))
}

/// Job with everything that is known beyond its stored row: the present phase, and the report of its reduction.
pub(super) async fn detail(state: &AppState, mut job: Job) -> Result<JobDetail, StoreError> {
    tell_phase(state, &mut job.head);
    let reduction = match (job.request.models().first(), job.request.modes_per_speed()) {
        (Some(model), Some(modes_per_speed)) => {
            let mut reports = state.store.reduction_reports(model).await?.into_iter();
            reports.find(|report| report.modes_per_speed == modes_per_speed)
        }
        _ => None,
    };
    Ok(JobDetail::new(job, reduction)?)
}

/// Change the labels of a job.
///
/// Takes a merge patch (RFC 7396): a label that is left out stays, null removes it. Nothing else of a job can be changed.
#[utoipa::path(patch, path = "/v1/jobs/{id}", operation_id = "label_job", tag = "jobs",
    params(("id" = String, Path, description = "Id of the job.")),
    request_body(content((LabelPatch = "application/merge-patch+json"), (LabelPatch = "application/json"))),
    responses(
        (status = 200, description = "The job as it is called now.", body = JobDetail),
        (status = 415, description = "The body is not declared as JSON.", body = Problem,
            content_type = "application/problem+json"),
        (status = 422, description = "A field is unknown or impossible: `errors` points at it.", body = Problem,
            content_type = "application/problem+json"),
    ))]
pub(super) async fn label_job(
    state: State<AppState>,
    whose: Principal,
    JobPath(id): JobPath,
    MergePatch(patch): MergePatch<LabelPatch>,
) -> Result<Json<JobDetail>, Problem> {
    find(&state, &whose, id).await?;
    if !state.store.label_job(id, patch.changes()?).await? {
        return Err(job_not_found(&id));
    }
    get_job(state, whose, JobPath(id)).await
}

/// Pause a job.
///
/// Computing stops within moments; finished results stay and can be read. `POST /v1/jobs/{id}/continue` continues the job where it
/// was, also after the service was stopped in between. A job that is paused already stays paused.
#[utoipa::path(post, path = "/v1/jobs/{id}/pause", operation_id = "pause_job", tag = "jobs",
    params(("id" = String, Path, description = "Id of the job.")),
    responses(
        (status = 200, description = "The job, which is paused.", body = JobDetail),
        (status = 409, description = "The job has ended.", body = Problem,
            content_type = "application/problem+json"),
    ))]
pub(super) async fn pause_job(
    state: State<AppState>,
    whose: Principal,
    JobPath(id): JobPath,
) -> Result<Json<JobDetail>, Problem> {
    set_paused(state, whose, id, true).await
}

/// Continue a paused job.
///
/// The job waits for its turn as a new one does, and computes nothing again that was finished. A job that was not paused goes on as
/// it did.
#[utoipa::path(post, path = "/v1/jobs/{id}/continue", operation_id = "continue_job", tag = "jobs",
    params(("id" = String, Path, description = "Id of the job.")),
    responses(
        (status = 200, description = "The job, which waits for its turn or is computed.", body = JobDetail),
        (status = 409, description = "The job has ended.", body = Problem,
            content_type = "application/problem+json"),
    ))]
pub(super) async fn continue_job(
    state: State<AppState>,
    whose: Principal,
    JobPath(id): JobPath,
) -> Result<Json<JobDetail>, Problem> {
    set_paused(state, whose, id, false).await
}

async fn set_paused(
    state: State<AppState>,
    whose: Principal,
    id: JobId,
    paused: bool,
) -> Result<Json<JobDetail>, Problem> {
    find(&state, &whose, id).await?;
    match state.jobs.set_paused(id, paused).await? {
        None => Err(job_not_found(&id)),
        Some(status) if status.is_final() => {
            let detail = format!("the job is {}: it cannot be paused or continued any more", status.as_str());
            Err(Problem::new(Kind::JobEnded, detail))
        }
        Some(_) => get_job(state, whose, JobPath(id)).await,
    }
}

/// Extent of a deletion.
#[derive(Debug, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
pub(super) struct DeletionQuery {
    /// Whether only to cancel: a job that has ended, perhaps while this request was on its way, stays as it is. Such a request can be sent again.
    #[serde(default)]
    cancel_only: bool,
}

/// Cancel a job that has not ended, or delete one that has.
///
/// Computing stops within moments, and speeds that were finished stay readable (200 with the job). A job that has ended, a
/// cancelled one included, is deleted with everything it stored, and its room is freed (204), unless the request only cancels.
#[utoipa::path(delete, path = "/v1/jobs/{id}", operation_id = "delete_job", tag = "jobs",
    params(("id" = String, Path, description = "Id of the job."), DeletionQuery),
    responses(
        (status = 200, description = "The job had not ended and is dismissed, or is only to be cancelled and has ended.",
            body = JobDetail),
        (status = 204, description = "The job had ended; it is gone with its results."),
    ))]
pub(super) async fn delete_job(
    state: State<AppState>,
    whose: Principal,
    JobPath(id): JobPath,
    Parameters(query): Parameters<DeletionQuery>,
) -> Result<Response, Problem> {
    find(&state, &whose, id).await?;
    if !query.cancel_only {
        match state.jobs.delete(id).await? {
            JobDeletion::Deleted => return Ok(StatusCode::NO_CONTENT.into_response()),
            JobDeletion::Unknown => return Err(job_not_found(&id)),
            JobDeletion::Unfinished => {}
        }
    }
    match state.jobs.cancel(id).await? {
        Cancellation::Unknown => Err(job_not_found(&id)),
        // Ended in between: then it is there to be read, or deleted by another request.
        Cancellation::Dismissed | Cancellation::AlreadyFinal(_) => {
            Ok(get_job(state, whose, JobPath(id)).await?.into_response())
        }
    }
}
