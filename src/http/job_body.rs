//! A job as it is shown.

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

/// A job.
#[derive(Debug, Serialize, ToSchema)]
pub(super) struct JobBody {
    /// Its id.
    #[schema(example = "0198c5a2-7c1e-7d54-9f3b-2f6d7a6f4b10")]
    id: String,
    /// Its kind.
    kind: JobKind,
    /// What its owner calls it.
    #[serde(skip_serializing_if = "Option::is_none")]
    name: Option<String>,
    /// Words to group by.
    tags: Vec<String>,
    /// What its owner has noted.
    #[serde(skip_serializing_if = "Option::is_none")]
    notes: Option<String>,
    /// How far it is.
    status: JobStatus,
    /// Percent of the work done; never falls, 100 only when successful.
    #[schema(minimum = 0, maximum = 100)]
    progress: u8,
    /// What runs now, in words.
    #[serde(skip_serializing_if = "String::is_empty")]
    phase: String,
    /// Id of the model it computes from; of a `model_generation`, the model it made, once it is successful.
    #[serde(skip_serializing_if = "Option::is_none")]
    model: Option<String>,
    /// Its speeds, counted, of a campaign those of all designs; a `model_generation` has none.
    #[serde(skip_serializing_if = "Option::is_none")]
    speeds: Option<SpeedCounts>,
    /// Bytes that its results take in the data folder.
    stored_bytes: u64,
    /// When it was accepted (RFC 3339).
    created_at: String,
    /// When computing began.
    #[serde(skip_serializing_if = "Option::is_none")]
    started_at: Option<String>,
    /// When it ended.
    #[serde(skip_serializing_if = "Option::is_none")]
    finished_at: Option<String>,
    /// When it last changed its status or progress.
    updated_at: String,
    /// Why it failed.
    #[serde(skip_serializing_if = "Option::is_none")]
    error: Option<Problem>,
    /// The job itself and its results.
    links: Vec<Link>,
}

/// A job and what was found about its model.
#[derive(Debug, Serialize, ToSchema)]
pub(super) struct JobDetail {
    /// The job.
    #[serde(flatten)]
    pub(super) job: JobBody,
    /// What was asked for, with every default filled in, and with what `refine` or a threshold has added so far.
    pub(super) request: RequestBody,
    /// The settings that were chosen for it, once they are, of a job that asks for an accuracy or gives a budget.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) choice: Option<Chosen>,
    /// The reduction that its results rest on, once there is one: residuals, sizes, and how far K(Ω) can be trusted
    /// between the given speeds.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) reduction: Option<ReductionReport>,
}

/// What a job was asked for.
#[derive(Debug, Serialize, ToSchema)]
#[serde(untagged)]
pub(super) enum RequestBody {
    /// Of a sweep.
    Sweep(Box<SweepRequest>),
    /// Of a modal analysis.
    ModalAnalysis(ModalAnalysisRequest),
    /// Of a study.
    Study(Box<StudyRequest>),
    /// Of a case study.
    CaseStudy(Box<CaseStudySettings>),
    /// Of branches.
    Branches(Box<BranchesSettings>),
    /// Of run-ups.
    RunUps(Box<RunUpSettings>),
    /// Of a campaign, without its designs, which `GET /v1/jobs/{id}/campaign` has.
    Campaign(Box<CampaignSettings>),
    /// Of a generated model.
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

/// A link to something related.
#[derive(Debug, Serialize, ToSchema)]
pub(super) struct Link {
    /// Path on this service.
    #[schema(example = "/v1/jobs/0198c5a2-7c1e-7d54-9f3b-2f6d7a6f4b10/interaction-map")]
    href: String,
    /// What it is: `self`, `interaction-map`, `critical-speeds`, `wheel-critical-speeds`, `forces`, `spectra` (with a `{index}` to fill
    /// in), `campbell`, `branches`, `run-ups`, `spectrogram` (of the first run), `campaign`, `work-precision`, `histories`, `report`, `archive` or `model`; where it is recorded, and not in lists of jobs,
    /// `stress` and `fields`.
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

/// Of jobs that fit on a page.
const REPORT: (&str, &str) = ("report", "/report");

/// Of jobs that can be repeated.
const ARCHIVE: (&str, &str) = ("archive", "/archive");

/// Of jobs that record stress, and of those that record states.
pub(super) fn recorded(stress: bool, states: bool) -> Vec<(&'static str, &'static str)> {
    let stress = stress.then_some(("stress", "/stress"));
    stress.into_iter().chain(states.then_some(("fields", "/fields"))).collect()
}

impl JobDetail {
    /// A job with all its links.
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

/// Links of a job, with those of what it has `recorded` beside the results of its kind.
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
