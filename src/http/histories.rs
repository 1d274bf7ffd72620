//! Histories of a speed, and of the first revolutions of a study.

use std::collections::BTreeSet;

use axum::extract::State;
use axum::response::Response;
use serde::{Deserialize, Serialize};
use utoipa::{IntoParams, ToSchema};

use super::download::{Download, DownloadQuery};
use super::extract::{JobPath, JsonBody, Parameters};
use super::forms::Forms;
use super::idempotency::IdempotencyKey;
use super::kinds::{self, ReceivedRequest};
use super::problem::{Kind, Problem};
use super::results::{check_sensor, find, sweep, wrong_kind};
use super::state::AppState;
use super::stream;
use super::studies::check_speed;
use crate::analysis::kinds::case_study::{CASE_STUDY, HistoriesOfSweep};
use crate::analysis::kinds::document::Document;
use crate::analysis::kinds::sweep::HISTORIES;
use crate::analysis::request::{HistoriesRequest, HistorySpeeds};
use crate::analysis::resolved::{ResolvedCaseStudy, ResolvedStudy, ResolvedSweep};
use crate::analysis::result::SpeedHistories;
use crate::analysis::run::{self, Histories};
use crate::kinds::JobKind;
use crate::plot::{self, HistoryQuantity};
use crate::store::jobs::{Job, JobId, Posted};
use crate::store::labels::Labels;
use crate::store::status::JobStatus;
use crate::tokens::Principal;

/// Histories to download, and their drawing.
#[derive(Debug, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
pub(super) struct HistoriesQuery {
    /// Index of the speed in the request, for a case study in that of its sweep; default the first that has histories.
    speed: Option<u32>,
    /// Index, in the request, of the sensor that a drawing shows; default 0.
    #[serde(default)]
    sensor: u32,
    /// Quantity that a drawing of one speed shows; default `displacement`.
    #[param(inline)]
    quantity: Option<Drawn>,
    /// Contact node whose forces a drawing shows; default 0.
    #[serde(default)]
    contact_node: u32,
}

/// Quantity that a drawing of the histories of a speed shows.
#[derive(Debug, Clone, Copy, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
enum Drawn {
    /// Displacement of a sensor.
    Displacement,
    /// Velocity of a sensor.
    Velocity,
    /// Forces on a contact node, blade by blade.
    Force,
    /// Nodes in contact and contact length.
    Contact,
    /// Energy and its parts.
    Energy,
    /// Motion of the radial sensors against the casing.
    Trajectories,
}

/// Histories of a job.
#[derive(Serialize, ToSchema)]
#[serde(untagged)]
#[expect(dead_code, reason = "describes the body in the OpenAPI document only")]
pub(super) enum HistoriesBody {
    /// Histories of one speed of a case study or a sweep.
    Speed(Box<SpeedHistories>),
    /// Histories of the first revolutions of a study.
    Study(Box<Histories>),
}

/// Download histories: those of one speed of a case study or a sweep, or the displacements of a study's first revolutions, one line per size.
///
/// In csv a line is a sample and a column a history. In npz, `displacement` and `velocity` of a speed are `[sensor][sample]` and
/// its `force` is `[sector][contact node][sample]`; `displacement` of a study is `[size][sensor][sample]`.
#[utoipa::path(get, path = "/v1/jobs/{id}/histories", operation_id = "get_histories", tag = "results",
    params(("id" = String, Path, description = "Id of a case study, sweep or study."), HistoriesQuery, DownloadQuery),
    responses(
        (status = 200, description = "The histories.", body = HistoriesBody),
        (status = 404, description = "There is no such job, or nothing was recorded of that speed.", body = Problem,
            content_type = "application/problem+json"),
        (status = 409, description = "The job has no histories, is not finished, or ended without this result.",
            body = Problem, content_type = "application/problem+json"),
    ))]
pub(super) async fn get_histories(
    state: State<AppState>,
    whose: Principal,
    JobPath(id): JobPath,
    Parameters(query): Parameters<HistoriesQuery>,
    download: Download,
) -> Result<Response, Problem> {
    let job = find(&state, &whose, id).await?;
    let speed = match query.speed {
        Some(speed) => speed,
        None => first(&state, &job).await?,
    };
    let document = Document::part(HISTORIES, speed);
    let sensor = query.sensor as usize;
    if let Some(study) = job.request.get::<ResolvedStudy>() {
        check_speed(&job, speed)?;
        check_sensor(study.sensors(), query.sensor)?;
        return Forms::drawn_by(move |histories: &Histories| plot::histories(histories, sensor))
            .of_document(&state, download, &job, document)
            .await;
    }
    check_drawn(&job, recorded_sweep(&job)?, &query)?;
    let (what, index) = query.what();
    Forms::drawn_by(move |histories: &SpeedHistories| match what {
        Some(what) => plot::speed_histories(histories, what, index),
        None => plot::trajectories(histories),
    })
    .of_document(&state, download, &job, document)
    .await
}

/// Sweep whose speeds a job records; refuses jobs that record none.
pub(super) fn recorded_sweep(job: &Job) -> Result<&ResolvedSweep, Problem> {
    let case = job.request.get().map(ResolvedCaseStudy::sweep);
    case.or_else(|| job.request.get()).ok_or_else(|| wrong_kind(job, JobKind(&CASE_STUDY)))
}

/// Index of the first speed of a job that has histories; where none has, the first of all.
async fn first(state: &AppState, job: &Job) -> Result<u32, Problem> {
    Ok(state.store.document_parts(job.id, HISTORIES).await?.first().copied().unwrap_or(0))
}

/// Refuses a sensor or a contact node that does not exist and thus cannot be drawn.
fn check_drawn(job: &Job, sweep: &ResolvedSweep, query: &HistoriesQuery) -> Result<(), Problem> {
    check_sensor(sweep.sensors(), query.sensor)?;
    let nodes = job.facts.as_ref().map_or(0, |facts| facts.contact_nodes);
    if query.contact_node >= nodes {
        let detail = format!("the model has contact nodes 0 to {}", nodes.saturating_sub(1));
        return Err(Problem::parameter("contact_node", detail));
    }
    Ok(())
}

impl HistoriesQuery {
    /// Quantity of a speed that is drawn, and its sensor or contact node; no quantity means the trajectories.
    fn what(&self) -> (Option<HistoryQuantity>, usize) {
        let (sensor, node) = (self.sensor as usize, self.contact_node as usize);
        match self.quantity.unwrap_or(Drawn::Displacement) {
            Drawn::Displacement => (Some(HistoryQuantity::Displacement), sensor),
            Drawn::Velocity => (Some(HistoryQuantity::Velocity), sensor),
            Drawn::Force => (Some(HistoryQuantity::Force), node),
            Drawn::Contact => (Some(HistoryQuantity::Contact), 0),
            Drawn::Energy => (Some(HistoryQuantity::Energy), 0),
            Drawn::Trajectories => (None, 0),
        }
    }
}

/// Record histories of a sweep that has ended.
///
/// A new job simulates the speeds again with all settings of the sweep. The same version on the same kind of processor gives the
/// same results to the bit.
#[utoipa::path(post, path = "/v1/jobs/{id}/histories", operation_id = "create_histories", tag = "jobs",
    params(
        ("id" = String, Path, description = "Id of a sweep."),
        ("Idempotency-Key" = Option<String>, Header,
            description = "Repeating the request with this key repeats its answer and starts nothing."),
    ),
    request_body(content = HistoriesRequest, example = json!({"speeds": "critical"})),
    responses(
        (status = 409, description = "The job is not a sweep, or not successful.", body = Problem,
            content_type = "application/problem+json"),
        (status = 422, description = "A field is unknown or impossible, the model is gone (`errors` points at each), or the \
            idempotency key belongs to another request.", body = Problem, content_type = "application/problem+json"),
    ))]
pub(super) async fn create_histories(
    state: State<AppState>,
    whose: Principal,
    key: IdempotencyKey,
    JobPath(id): JobPath,
    body: JsonBody<HistoriesRequest>,
) -> Result<Response, Problem> {
    let job = find(&state, &whose, id).await?;
    let (settings, _) = sweep(&job)?;
    if job.status != JobStatus::Successful {
        let detail =
            format!("the sweep is {}: its speeds are recorded once it is successful", job.status.as_str());
        return Err(Problem::new(Kind::ResultNotReady, detail));
    }
    let critical = critical(&state, id, settings, &body.value).await?;
    let posted = Posted { to: format!("/v1/jobs/{id}/histories"), body: serde_json::to_string(&body.value)? };
    let sweep = settings.clone();
    let received = ReceivedRequest {
        asked: Box::new(HistoriesOfSweep { sweep, critical, request: body.value }),
        labels: Labels::default(),
        posted: Some(posted),
        // The same words on another job are another request.
        fingerprint: format!("{}-{id}", body.fingerprint),
    };
    kinds::accept(&state, &whose, key, received).await
}

/// Indices of the critical speeds, if the request asks for them; otherwise none.
async fn critical(
    state: &AppState,
    id: JobId,
    settings: &ResolvedSweep,
    request: &HistoriesRequest,
) -> Result<BTreeSet<u32>, Problem> {
    match request.speeds {
        HistorySpeeds::Critical => {
            let (settings, points) = (settings.clone(), state.store.points(id).await?);
            stream::blocking(move || run::critical_indices(&settings, &points)).await
        }
        HistorySpeeds::Indices(_) => Ok(BTreeSet::new()),
    }
}
