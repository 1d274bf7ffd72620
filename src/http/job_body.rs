//! Jobs as answers show them.

use std::borrow::Cow;

use serde::Serialize;
use serde_json::value::RawValue;
use utoipa::openapi::schema::AnyOfBuilder;
use utoipa::openapi::{Ref, RefOr, Schema};
use utoipa::{PartialSchema, ToSchema};

use super::problem::Problem;
use crate::analysis::kinds::kind::Recorded;
use crate::analysis::request::HistoriesRequest;
use crate::analysis::result::{Chosen, ReductionReport, VerdictWord};
use crate::kinds::{self, JobKind};
use crate::store::jobs::{Job, JobHead, JobId, SpeedCounts};
use crate::store::status::JobStatus;

/// Job with its labels, state, times, and links to its results.
#[derive(Debug, Serialize, ToSchema)]
pub(super) struct JobBody {
    /// Id of the job.
    #[schema(example = "0198c5a2-7c1e-7d54-9f3b-2f6d7a6f4b10")]
    id: String,
    /// Kind of the job.
    kind: JobKind,
    /// Name of the job.
    #[serde(skip_serializing_if = "Option::is_none")]
    name: Option<String>,
    /// Words to group the job by.
    tags: Vec<String>,
    /// Notes of the owner.
    #[serde(skip_serializing_if = "Option::is_none")]
    notes: Option<String>,
    /// Status of the job.
    status: JobStatus,
    /// Percent of the work done; never falls, and is 100 only when the job is successful.
    #[schema(minimum = 0, maximum = 100)]
    progress: u8,
    /// Part of the work that runs now, in words.
    #[serde(skip_serializing_if = "String::is_empty")]
    phase: String,
    /// Id of the model that the job computes from; for a `model_generation`, of the model it made, once it is successful.
    #[serde(skip_serializing_if = "Option::is_none")]
    model: Option<String>,
    /// Counts of the job's speeds, for a campaign those of all designs; a `model_generation` has none.
    #[serde(skip_serializing_if = "Option::is_none")]
    speeds: Option<SpeedCounts>,
    /// Bytes that the results of the job take in the data folder.
    stored_bytes: u64,
    /// Time at which the job was accepted (RFC 3339).
    created_at: String,
    /// Time at which computing began (RFC 3339).
    #[serde(skip_serializing_if = "Option::is_none")]
    started_at: Option<String>,
    /// Time at which the job ended (RFC 3339).
    #[serde(skip_serializing_if = "Option::is_none")]
    finished_at: Option<String>,
    /// Time at which status or progress last changed (RFC 3339).
    updated_at: String,
    /// Reason why the job failed.
    #[serde(skip_serializing_if = "Option::is_none")]
    error: Option<Problem>,
    /// Verdict on a finished sweep when it ended, in one word; `GET /v1/jobs/{id}/verdict` explains it. Absent for jobs of earlier versions.
    #[serde(skip_serializing_if = "Option::is_none")]
    verdict: Option<VerdictWord>,
    /// Links to the job itself and to its results.
    links: Vec<Link>,
}

/// Job with its settings and with the report of the reduction that it rests on.
#[derive(Debug, Serialize, ToSchema)]
pub(super) struct JobDetail {
    /// Job as lists show it, with all its links.
    #[serde(flatten)]
    pub(super) job: JobBody,
    /// Request as it was posted, without labels: posted again to `posted_to`, it starts another job like this one. Absent for some jobs of
    /// earlier versions, which did not keep it, and in events.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) posted: Option<PostedBody>,
    /// Path to which the request was posted.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(example = "/v1/sweeps")]
    pub(super) posted_to: Option<String>,
    /// Request as it was resolved: with every default filled in, and with everything that `refine` or a threshold has added so far. Results
    /// have it as `settings`. The designs of a campaign are left out, which `GET /v1/jobs/{id}/campaign` has.
    pub(super) request: ResolvedBody,
    /// Settings that were chosen for the job, once they are, if its request asks for an accuracy or gives a budget.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) choice: Option<Chosen>,
    /// Reduction that the results of the job rest on, once there is one: residuals, sizes, and how far K(Ω) can be trusted between the given speeds.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) reduction: Option<ReductionReport>,
}

/// Request of a job of any kind, as it was posted.
#[derive(Debug, Serialize)]
#[serde(transparent)]
pub(super) struct PostedBody(Box<RawValue>);

impl ToSchema for PostedBody {}

impl PartialSchema for PostedBody {
    fn schema() -> RefOr<Schema> {
        any_of(kinds::all().map(|kind| (kind.request.name)()).chain([HistoriesRequest::name()]))
    }
}

/// Request of a job of any kind, resolved.
#[derive(Debug, Serialize)]
#[serde(transparent)]
pub(super) struct ResolvedBody(Box<RawValue>);

impl ToSchema for ResolvedBody {}

impl PartialSchema for ResolvedBody {
    fn schema() -> RefOr<Schema> {
        any_of(kinds::all().map(|kind| (kind.resolved.name)()))
    }
}

/// Schema of a value that has at least one of the schemas of these `names`; not exactly one, as an empty object has several.
fn any_of(names: impl Iterator<Item = Cow<'static, str>>) -> RefOr<Schema> {
    names.map(Ref::from_schema_name).fold(AnyOfBuilder::new(), AnyOfBuilder::item).into()
}

/// Link to something related.
#[derive(Debug, Serialize, ToSchema)]
pub(super) struct Link {
    /// Path on this service.
    #[schema(example = "/v1/jobs/0198c5a2-7c1e-7d54-9f3b-2f6d7a6f4b10/interaction-map")]
    href: String,
    /// Relation of the linked thing: `self`, `interaction-map`, `critical-speeds`, `wheel-critical-speeds`, `verdict`, `level`, `forces`, `spectra`
    /// (with a `{index}` to fill in), `campbell`, `interference`, `branches`, `run-ups`, `spectrogram` (of the first run), `campaign`,
    /// `work-precision`, `histories`, `report`, `archive` or `model`; where it is recorded, and not in lists of jobs, `stress`,
    /// `fields` and `backbones`.
    rel: &'static str,
}

impl From<JobHead> for JobBody {
    fn from(job: JobHead) -> Self {
        let kind = job.kind;
        Self {
            id: job.id.to_string(),
            kind,
            name: job.labels.name,
            tags: job.labels.tags,
            notes: job.labels.notes,
            status: job.status,
            progress: job.progress,
            phase: if job.status == JobStatus::Running { job.phase } else { String::new() },
            links: links(job.id, kind, job.model.as_deref(), Recorded::default()),
            model: job.model,
            speeds: (job.speeds.total > 0).then_some(job.speeds),
            stored_bytes: job.stored_bytes,
            created_at: job.created_at,
            started_at: job.started_at,
            finished_at: job.finished_at,
            updated_at: job.updated_at,
            error: job.failure.as_ref().map(Problem::from),
            verdict: job.verdict.filter(|_| job.status == JobStatus::Successful),
        }
    }
}

impl JobDetail {
    /// Job with all its links.
    ///
    /// # Errors
    /// If its request cannot be written, which is a defect.
    pub(super) fn new(job: Job, reduction: Option<ReductionReport>) -> serde_json::Result<Self> {
        let links = links(job.id, job.kind, job.model.as_deref(), job.request.records());
        let body = JobBody { links, ..job.head.into() };
        let (posted_to, posted) = job.posted.map(|posted| (posted.to, posted.body)).unzip();
        Ok(Self {
            job: body,
            posted: posted.map(RawValue::from_string).transpose()?.map(PostedBody),
            posted_to,
            request: ResolvedBody(RawValue::from_string(job.request.shown()?)?),
            choice: job.choice,
            reduction,
        })
    }
}

/// Links of a job, including those of what it `records` beside the results of its kind.
pub(super) fn links(id: JobId, kind: JobKind, model: Option<&str>, records: Recorded) -> Vec<Link> {
    let recorded = [
        (records.stress, ("stress", "/stress")),
        (records.states, ("fields", "/fields")),
        (records.backbones, ("backbones", "/backbones")),
    ];
    let recorded = recorded.iter().filter(|(wanted, _)| *wanted).map(|(_, link)| link);
    let model = model.map(|model| Link { href: format!("/v1/models/{model}"), rel: "model" });
    [("self", "")]
        .iter()
        .chain(kind.results)
        .chain([&("archive", "/archive")])
        .chain(recorded)
        .map(|(rel, path)| Link { href: format!("/v1/jobs/{id}{path}"), rel })
        .chain(model)
        .collect()
}
