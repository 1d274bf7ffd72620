//! Kinds of jobs, and where they are posted.

use clap::ValueEnum;

/// Kind of a job.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum Kind {
    /// Contact over a range of speeds
    Sweep,
    /// Natural frequencies over speed, and the linear criterion
    ModalAnalysis,
    /// Motion, forces and energy at one speed
    CaseStudy,
    /// Periodic responses over speed, clearance, lobes or damping
    Branches,
    /// Run-ups and run-downs: a wheel whose speed changes
    RunUp,
    /// Contact over a range of speeds, of many designs of a scene
    Campaign,
    /// Convergence study: what accuracy costs in time
    Study,
    /// A model from the parameters of the generator
    ModelGeneration,
}

impl Kind {
    /// Path to which a job of this kind is posted.
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

    /// Name of the kind, as the service has it.
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
