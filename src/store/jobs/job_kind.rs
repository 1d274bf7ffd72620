//! Kinds of jobs.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use crate::store::error::StoreError;

/// Kind of a job.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum JobKind {
    /// Contact simulations over speeds.
    Sweep,
    /// Natural frequencies over speeds.
    ModalAnalysis,
    /// Model generated from the parameters of the generator.
    ModelGeneration,
    /// Study of errors and times over a grid of settings.
    Study,
    /// Case study: detailed results at chosen speeds.
    CaseStudy,
    /// Branches of periodic responses over a parameter of their scene.
    Branches,
    /// Run-ups: a scene whose speed changes.
    RunUp,
    /// Contact simulations over speeds, of many designs of a scene.
    Campaign,
}

impl JobKind {
    /// Word for the kind in requests, in answers and in the database.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Sweep => "sweep",
            Self::ModalAnalysis => "modal_analysis",
            Self::ModelGeneration => "model_generation",
            Self::Study => "study",
            Self::CaseStudy => "case_study",
            Self::Branches => "branches",
            Self::RunUp => "run_up",
            Self::Campaign => "campaign",
        }
    }

    /// Kind that a column holds.
    pub(super) fn from_column(text: &str) -> Result<Self, StoreError> {
        let kinds = [
            Self::Sweep,
            Self::ModalAnalysis,
            Self::ModelGeneration,
            Self::Study,
            Self::CaseStudy,
            Self::Branches,
            Self::RunUp,
            Self::Campaign,
        ];
        let kind = kinds.into_iter().find(|kind| kind.as_str() == text);
        kind.ok_or_else(|| StoreError::Unknown { column: "jobs.kind", value: text.to_owned() })
    }
}
