//! Kinds of jobs, and where they are posted.

use clap::ValueEnum;

/// What is to be computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum Kind {
    /// Contact over a range of speeds
    Sweep,
    /// Natural frequencies over speed, and the linear criterion
    ModalAnalysis,
    /// What happens at one speed
    CaseStudy,
    /// Periodic responses over speed, clearance, lobes or damping
    Branches,
    /// A wheel whose speed changes: run-ups and run-downs
    RunUp,
    /// Contact over a range of speeds, of many designs of a scene
    Campaign,
    /// What accuracy costs in time
    Study,
    /// A model from the parameters of the generator
    ModelGeneration,
}

impl Kind {
    /// Where a job of this kind is posted.
    pub(super) fn route(self) -> &'static str {
        match self {
            Self::Sweep => "/v1/sweeps",
            Self::ModalAnalysis => "/v1/modal-analyses",
            Self::CaseStudy => "/v1/case-studies",
            Self::Branches => "/v1/branches",
            Self::RunUp => "/v1/run-ups",
            Self::Campaign => "/v1/campaigns",
            Self::Study => "/v1/studies",
            Self::ModelGeneration => "/v1/models",
        }
    }

    /// What the service calls it.
    pub(super) fn word(self) -> &'static str {
        match self {
            Self::Sweep => "sweep",
            Self::ModalAnalysis => "modal_analysis",
            Self::CaseStudy => "case_study",
            Self::Branches => "branches",
            Self::RunUp => "run_up",
            Self::Campaign => "campaign",
            Self::Study => "study",
            Self::ModelGeneration => "model_generation",
        }
    }
}
