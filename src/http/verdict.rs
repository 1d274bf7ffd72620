//! Verdict on a sweep.

use axum::extract::State;
use axum::response::Response;
use serde::{Deserialize, Serialize};
use tokio::runtime::Handle;

use super::download::{Download, DownloadQuery, lasting};
use super::extract::JobPath;
use super::forms::{Forms, READ_MEMORY};
use super::problem::Problem;
use super::results::{find, sweep};
use super::state::AppState;
use crate::analysis::kinds::document::Document;
use crate::analysis::kinds::sweep::{CRITICAL_SPEEDS, ERRORS};
use crate::analysis::resolved::ResolvedSweep;
use crate::analysis::result::{ErrorEstimate, Point, SweepVerdict};
use crate::analysis::run::{self, Evidence, ModelFacts};
use crate::dynamics::sector::Units;
use crate::export::Export;
use crate::response::campbell::DrivenCrossing;
use crate::store::jobs::Job;
use crate::store::{Store, StoreError};
use crate::tokens::Principal;

/// Download the verdict on a sweep by its operating ranges and limits: clear, watch, undecided or act, why, and what would decide it.
///
/// The verdict is made on reading from the speeds finished so far. While the job runs it may still change, also once all speeds of a range are
/// finished: with added speeds, control runs and measured validity. In csv a line is a critical speed of the wheel.
#[utoipa::path(get, path = "/v1/jobs/{id}/verdict", operation_id = "get_verdict", tag = "results",
    params(("id" = String, Path, description = "Id of a sweep."), DownloadQuery),
    responses(
        (status = 200, description = "The verdict.", body = SweepVerdict),
        (status = 409, description = "The job is not a sweep.", body = Problem, content_type = "application/problem+json"),
    ))]
pub(super) async fn get_verdict(
    state: State<AppState>,
    whose: Principal,
    JobPath(id): JobPath,
    download: Download,
) -> Result<Response, Problem> {
    let job = find(&state, &whose, id).await?;
    judged(&state, job, download, Forms::undrawn(), run::judge).await
}

/// Function that makes a result of a sweep, its units and its finished speeds.
type Judge<T> = fn(&ResolvedSweep, &Units, Evidence<'_>) -> T;

/// Answers with what `judge` makes of the finished speeds of a job.
///
/// # Errors
/// Problem of a job that is not a sweep; errors of the store.
pub(super) async fn judged<T: Export + Serialize + Send + 'static>(
    state: &AppState,
    job: Job,
    download: Download,
    forms: Forms<T>,
    judge: Judge<T>,
) -> Result<Response, Problem> {
    sweep(&job)?;
    let bytes = READ_MEMORY * state.store.points_bytes(job.id).await?;
    let (store, runtime, lasting) = (state.store.clone(), Handle::current(), lasting(&job));
    let read = move || {
        let judged = runtime.block_on(Judged::read(&store, &job))?;
        Ok(judged.ok_or(StoreError::Unseen)?.by(judge))
    };
    forms.answer(state, download, lasting, bytes, read).await
}

/// Finished speeds of a sweep with their errors, from which its verdict is made.
pub(super) struct Judged<'a> {
    request: &'a ResolvedSweep,
    facts: &'a ModelFacts,
    points: Vec<Point>,
    errors: Option<ErrorEstimate>,
    driven: Option<Vec<DrivenCrossing>>,
    unfinished: bool,
}

/// Linear critical speeds in the table of a sensor.
#[derive(Deserialize)]
struct Predicted {
    driven_crossings: Vec<DrivenCrossing>,
}

impl<'a> Judged<'a> {
    /// Reads what is stored of a sweep; none for a job of another kind.
    pub(super) async fn read(store: &Store, job: &'a Job) -> Result<Option<Self>, StoreError> {
        let Ok((request, facts)) = sweep(job) else { return Ok(None) };
        let points = store.points(job.id).await?;
        let text = store.document(job.id, ERRORS).await?;
        let errors = text.map(|text| serde_json::from_str(&text)).transpose()?;
        let text = store.document(job.id, Document::part(CRITICAL_SPEEDS, 0)).await?;
        let predicted: Option<Predicted> = text.map(|text| serde_json::from_str(&text)).transpose()?;
        let driven = predicted.map(|of| of.driven_crossings);
        let unfinished = !job.head.status.is_final();
        Ok(Some(Self { request, facts, points, errors, driven, unfinished }))
    }

    /// Result that `judge` makes of the speeds.
    pub(super) fn by<T>(&self, judge: Judge<T>) -> T {
        let evidence = Evidence {
            points: &self.points,
            errors: self.errors.as_ref(),
            driven: self.driven.as_deref(),
            unfinished: self.unfinished,
        };
        judge(self.request, &self.facts.units, evidence)
    }
}
