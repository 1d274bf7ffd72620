//! What is asked for, as it came.

use crate::analysis::request::{ModalAnalysisRequest, StudyRequest, SweepRequest};
use crate::impeller::ImpellerParameters;
use crate::store::jobs::JobKind;

/// A job to be checked and accepted.
#[derive(Debug, Clone)]
pub enum Submission {
    /// Contact simulations over speeds.
    Sweep(Box<SweepRequest>),
    /// Natural frequencies over speeds.
    ModalAnalysis(Box<ModalAnalysisRequest>),
    /// A model from parameters of the generator, which are sound.
    ModelGeneration(Box<ImpellerParameters>),
    /// Errors and times of a grid of settings.
    Study(Box<StudyRequest>),
}

impl Submission {
    /// Kind of the job.
    pub fn kind(&self) -> JobKind {
        match self {
            Self::Sweep(_) => JobKind::Sweep,
            Self::ModalAnalysis(_) => JobKind::ModalAnalysis,
            Self::ModelGeneration(_) => JobKind::ModelGeneration,
            Self::Study(_) => JobKind::Study,
        }
    }

    /// The model it computes from, if it does.
    pub fn model(&self) -> Option<&str> {
        match self {
            Self::Sweep(request) => Some(&request.model),
            Self::ModalAnalysis(request) => Some(&request.model),
            Self::ModelGeneration(_) => None,
            Self::Study(request) => Some(&request.model),
        }
    }
}
