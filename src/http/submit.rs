//! Acceptance of jobs of all kinds.

use axum::http::StatusCode;
use axum::response::Response;
use serde::Serialize;
use utoipa::ToSchema;

use super::idempotency::{self, IdempotencyKey};
use super::job_body::{Link, links, recorded};
use super::problem::Problem;
use super::state::AppState;
use crate::analysis::request::RecordedQuantity;
use crate::jobs::{Submission, SubmitError};
use crate::store::idempotency::Answer;
use crate::store::jobs::{JobId, JobKind};
use crate::store::labels::Labels;
use crate::store::status::JobStatus;
use crate::tokens::Principal;

/// Receipt of a job just accepted.
#[derive(Debug, Serialize, ToSchema)]
pub(super) struct Receipt {
    /// Id of the job.
    #[schema(example = "0198c5a2-7c1e-7d54-9f3b-2f6d7a6f4b10")]
    id: String,
    /// Kind of the job.
    kind: JobKind,
    /// Status of the job, always `accepted`.
    status: JobStatus,
    /// Links to the job, to follow it, and to its results.
    links: Vec<Link>,
}

/// Accepts a job with its labels, or repeats the answer given before under its key.
pub(super) async fn accept(
    state: &AppState,
    whose: &Principal,
    key: IdempotencyKey,
    fingerprint: &str,
    (submission, labels): (Submission, Labels),
) -> Result<Response, Problem> {
    if let Some(response) = key.replay(&state.store, whose, fingerprint).await? {
        return Ok(response);
    }
    let (id, kind) = (JobId::new(), submission.kind());
    let recorded = match &submission {
        Submission::Sweep(sweep) => recorded(sweep.record.stress.is_some(), sweep.record.wants_states()),
        Submission::CaseStudy(case) => recorded(false, case.record.wants(RecordedQuantity::State)),
        Submission::Histories(of) => recorded(false, of.2.wants_states()),
        _ => Vec::new(),
    };
    let links = links(id, kind, submission.model(), &recorded);
    let receipt = Receipt { id: id.to_string(), kind, status: JobStatus::Accepted, links };
    let answer = Answer {
        owner: whose.owner.clone(),
        key: String::new(),
        fingerprint: String::new(),
        status: StatusCode::ACCEPTED.as_u16(),
        location: format!("/v1/jobs/{id}"),
        body: serde_json::to_string(&receipt)?,
    };
    match state.jobs.submit(whose, id, submission, labels, key.answer(fingerprint, &answer).as_ref()).await {
        Ok(()) => Ok(idempotency::respond(&answer)),
        Err(error @ SubmitError::KeyTaken) => {
            key.replay(&state.store, whose, fingerprint).await?.ok_or_else(|| error.into())
        }
        Err(error) => Err(error.into()),
    }
}
