//! A case study as it is stored and run.

use serde::Serialize;

use crate::error::Violation;
use crate::request::{CaseStudySettings, Recorded, RecordedQuantity};
use crate::resolved::sweep::ResolvedSweep;

/// Speeds of a sweep with what is recorded of each; see [`CaseStudySettings`], as which it is written.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(into = "CaseStudySettings")]
pub struct ResolvedCaseStudy {
    pub(crate) sweep: ResolvedSweep,
    pub(crate) speeds: Vec<u32>,
    pub(crate) record: Recorded,
}

impl ResolvedCaseStudy {
    /// Reads again what was resolved before, its sweep with so many `rounds` of a refinement.
    ///
    /// # Errors
    /// What is wrong with it, if it was not.
    pub fn stored(written: CaseStudySettings, rounds: u32) -> Result<Self, Vec<Violation>> {
        let CaseStudySettings { sweep, speeds, record } = written;
        Ok(Self { sweep: ResolvedSweep::stored(sweep, rounds)?, speeds, record })
    }

    /// The sweep of whose speeds it is.
    pub fn sweep(&self) -> &ResolvedSweep {
        &self.sweep
    }

    /// Whether rows of the reduction's basis must be beside it, must not, or are kept where it reduces.
    pub fn fields(&self) -> Option<bool> {
        if self.records_states() { Some(true) } else { self.sweep.fields() }
    }

    /// Whether states are recorded.
    pub fn records_states(&self) -> bool {
        self.record.wants(RecordedQuantity::State)
    }

    /// Indices of the speeds in the sweep; at least one.
    pub fn speeds(&self) -> &[u32] {
        &self.speeds
    }
}

impl From<ResolvedCaseStudy> for CaseStudySettings {
    fn from(case: ResolvedCaseStudy) -> Self {
        Self { sweep: case.sweep.into(), speeds: case.speeds, record: case.record }
    }
}
