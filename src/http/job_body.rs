//! Jobs as answers show them.

use serde::Serialize;
use utoipa::ToSchema;

use super::problem::Problem;
use crate::analysis::request::{
    BranchesSettings, CampaignSettings, CaseStudySettings, ModalAnalysisRequest, RunUpSettings, StudyRequest,
    SweepRequest,
};
use crate::analysis::result::ReductionReport;
use crate::impeller::ImpellerParameters;
use crate::store::jobs::{Chosen, Job, JobHead, JobId, JobKind, JobRequest, SpeedCounts};
use crate::store::status::JobStatus;

/// Job with its labels, state, times, and links to its results.
#[derive(Debug, Serialize, ToSchema)]
pub(super) struct JobBody {
    /// Id of the job.
    #[schema(example = "0198c5a2-7c1e-7d54-9f3b-2f6d7a6f4b10")]
    id: String,
    /// Kind of the job.
    kind: JobKind,
    /// Name that the owner gave the job.
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
    /// Links to the job itself and to its results.
    links: Vec<Link>,
}

/// Job with its settings and with the report of the reduction that it rests on.
#[derive(Debug, Serialize, ToSchema)]
pub(super) struct JobDetail {
    /// Job as lists show it, with all its links.
    #[serde(flatten)]
    pub(super) job: JobBody,
    /// Request of the job with every default filled in, and with everything that `refine` or a threshold has added so far.
    pub(super) request: RequestBody,
    /// Settings that were chosen for the job, once they are, if its request asks for an accuracy or gives a budget.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) choice: Option<Chosen>,
    /// Reduction that the results of the job rest on, once there is one: residuals, sizes, and how far K(Ω) can be trusted between the given speeds.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) reduction: Option<ReductionReport>,
}

/// Request of a job, resolved.
#[derive(Debug, Serialize, ToSchema)]
#[serde(untagged)]
pub(super) enum RequestBody {
    /// Request of a sweep.
    Sweep(Box<SweepRequest>),
    /// Request of a modal analysis.
    ModalAnalysis(ModalAnalysisRequest),
    /// Request of a study.
    Study(Box<StudyRequest>),
    /// Request of a case study.
    CaseStudy(Box<CaseStudySettings>),
    /// Request of branches.
    Branches(Box<BranchesSettings>),
    /// Request of run-ups.
    RunUps(Box<RunUpSettings>),
    /// Request of a campaign, without its designs, which `GET /v1/jobs/{id}/campaign` has.
    Campaign(Box<CampaignSettings>),
    /// Request of a generated model.
    ModelGeneration(Box<ImpellerParameters>),
}

impl From<JobRequest> for RequestBody {
    fn from(request: JobRequest) -> Self {
        match request {
            JobRequest::Sweep(request) => Self::Sweep(Box::new((*request).into())),
            JobRequest::ModalAnalysis(request) => Self::ModalAnalysis((*request).into()),
            JobRequest::Study(request) => Self::Study(Box::new((*request).into())),
            JobRequest::CaseStudy(case) => Self::CaseStudy(Box::new((*case).into())),
            JobRequest::Branches(branches) => Self::Branches(Box::new((*branches).into())),
            JobRequest::RunUps(run_ups) => Self::RunUps(Box::new((*run_ups).into())),
            JobRequest::Campaign(campaign) => {
                // Thousands of designs would be sent again with every step of the job.
                let settings = CampaignSettings { designs: Vec::new(), ..(*campaign).into() };
                Self::Campaign(Box::new(settings))
            }
            JobRequest::ModelGeneration(parameters) => Self::ModelGeneration(parameters),
        }
    }
}

/// Link to something related.
#[derive(Debug, Serialize, ToSchema)]
pub(super) struct Link {
    /// Path on this service.
    #[schema(example = "/v1/jobs/0198c5a2-7c1e-7d54-9f3b-2f6d7a6f4b10/interaction-map")]
    href: String,
    /// Relation of the linked thing: `self`, `interaction-map`, `critical-speeds`, `wheel-critical-speeds`, `forces`, `spectra`
    /// (with a `{index}` to fill in), `campbell`, `branches`, `run-ups`, `spectrogram` (of the first run), `campaign`,
    /// `work-precision`, `histories`, `report`, `archive` or `model`; where it is recorded, and not in lists of jobs, `stress` and
    /// `fields`.
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
            links: links(job.id, kind, job.model.as_deref(), &[]),
            model: job.model,
            speeds: (job.speeds.total > 0).then_some(job.speeds),
            stored_bytes: job.stored_bytes,
            created_at: job.created_at,
            started_at: job.started_at,
            finished_at: job.finished_at,
            updated_at: job.updated_at,
            error: job.failure.as_ref().map(Problem::from),
        }
    }
}

/// Link to the report, for jobs that fit on a page.
const REPORT: (&str, &str) = ("report", "/report");

/// Link to the archive, for jobs that can be repeated.
const ARCHIVE: (&str, &str) = ("archive", "/archive");

/// Links of jobs that record stress, and of jobs that record states.
pub(super) fn recorded(stress: bool, states: bool) -> Vec<(&'static str, &'static str)> {
    let stress = stress.then_some(("stress", "/stress"));
    stress.into_iter().chain(states.then_some(("fields", "/fields"))).collect()
}

impl JobDetail {
    /// Job with all its links.
    pub(super) fn new(job: Job, reduction: Option<ReductionReport>) -> Self {
        let recorded = match &job.request {
            JobRequest::Sweep(sweep) => recorded(sweep.stress_outside().is_some(), sweep.records_states()),
            JobRequest::CaseStudy(case) => recorded(false, case.records_states()),
            _ => Vec::new(),
        };
        let links = links(job.id, job.kind, job.model.as_deref(), &recorded);
        let body = JobBody { links, ..job.head.into() };
        Self { job: body, request: job.request.into(), choice: job.choice, reduction }
    }
}

/// Links of a job, including those of its `recorded` results beside the results of its kind.
pub(super) fn links(
    id: JobId,
    kind: JobKind,
    model: Option<&str>,
    recorded: &[(&'static str, &str)],
) -> Vec<Link> {
    let results: &[(&str, &str)] = match kind {
        JobKind::Sweep => &[
            ("interaction-map", "/interaction-map"),
            ("critical-speeds", "/critical-speeds"),
            ("wheel-critical-speeds", "/critical-speeds/wheel"),
            ("spectra", "/spectra/{index}"),
            ("forces", "/forces"),
            REPORT,
            ARCHIVE,
        ],
        JobKind::ModalAnalysis => &[("campbell", "/campbell"), REPORT, ARCHIVE],
        JobKind::ModelGeneration => &[],
        JobKind::Study => &[("work-precision", "/work-precision"), ("histories", "/histories"), ARCHIVE],
        JobKind::CaseStudy => &[("histories", "/histories")],
        JobKind::Branches => &[("branches", "/branches")],
        JobKind::RunUp => &[("run-ups", "/run-ups"), ("spectrogram", "/spectrogram")],
        JobKind::Campaign => &[("campaign", "/campaign")],
    };
    let model = model.map(|model| Link { href: format!("/v1/models/{model}"), rel: "model" });
    [("self", "")]
        .iter()
        .chain(results)
        .chain(recorded)
        .map(|(rel, path)| Link { href: format!("/v1/jobs/{id}{path}"), rel })
        .chain(model)
        .collect()
}
