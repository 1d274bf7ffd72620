//! Requests for jobs, as they came.

use std::collections::BTreeSet;

use crate::analysis::request::{
    BranchesRequest, CampaignRequest, CaseStudyRequest, HistoriesRequest, ModalAnalysisRequest, RunUpRequest,
    StudyRequest, SweepRequest,
};
use crate::analysis::resolved::ResolvedSweep;
use crate::impeller::ImpellerParameters;
use crate::store::jobs::JobKind;

/// A job to be checked and accepted.
#[derive(Debug, Clone)]
pub enum Submission {
    /// Sweep: contact simulations over speeds.
    Sweep(Box<SweepRequest>),
    /// Modal analysis: natural frequencies over speeds.
    ModalAnalysis(Box<ModalAnalysisRequest>),
    /// Generation of a model from parameters of the generator, which are sound.
    ModelGeneration(Box<ImpellerParameters>),
    /// Convergence study: errors and times of a grid of settings.
    Study(Box<StudyRequest>),
    /// Case study: one speed with everything recorded.
    CaseStudy(Box<CaseStudyRequest>),
    /// Branches: periodic responses over a number of their scene.
    Branches(Box<BranchesRequest>),
    /// Run-ups: a scene whose speed changes.
    RunUps(Box<RunUpRequest>),
    /// Campaign: contact simulations over speeds, of many designs of a scene.
    Campaign(Box<CampaignRequest>),
    /// Histories of a sweep that has ended, with the indices of its critical speeds.
    Histories(Box<(ResolvedSweep, BTreeSet<u32>, HistoriesRequest)>),
}

impl Submission {
    /// Kind of the job.
    pub fn kind(&self) -> JobKind {
        match self {
            Self::Sweep(_) => JobKind::Sweep,
            Self::ModalAnalysis(_) => JobKind::ModalAnalysis,
            Self::ModelGeneration(_) => JobKind::ModelGeneration,
            Self::Study(_) => JobKind::Study,
            Self::CaseStudy(_) | Self::Histories(_) => JobKind::CaseStudy,
            Self::Branches(_) => JobKind::Branches,
            Self::RunUps(_) => JobKind::RunUp,
            Self::Campaign(_) => JobKind::Campaign,
        }
    }

    /// Model that the job computes from, if it does.
    pub fn model(&self) -> Option<&str> {
        match self {
            Self::Sweep(request) => Some(&request.model),
            Self::ModalAnalysis(request) => Some(&request.model),
            Self::ModelGeneration(_) => None,
            Self::Study(request) => Some(&request.model),
            Self::CaseStudy(request) => Some(&request.model),
            Self::Branches(request) => Some(&request.model),
            Self::RunUps(request) => Some(&request.model),
            Self::Campaign(request) => Some(&request.model),
            Self::Histories(of) => Some(of.0.model()),
        }
    }
}
