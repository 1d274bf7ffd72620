//! A case study as it is stored and run.

use serde::Serialize;

use crate::error::Violation;
use crate::request::{CaseStudySettings, Recorded, RecordedQuantity};
use crate::resolved::sweep::ResolvedSweep;

/// Case study: speeds of a sweep with what is recorded of each; written as [`CaseStudySettings`].
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(into = "CaseStudySettings")]
pub struct ResolvedCaseStudy {
    pub(crate) sweep: ResolvedSweep,
    pub(crate) speeds: Vec<u32>,
    pub(crate) record: Recorded,
}

impl ResolvedCaseStudy {
    /// Reads a case study that was resolved and stored before, its sweep with so many `rounds` of a refinement.
    ///
    /// # Errors
    /// Violations, if the case study was never resolved.
    pub fn stored(written: CaseStudySettings, rounds: u32) -> Result<Self, Vec<Violation>> {
        let CaseStudySettings { sweep, speeds, record } = written;
        Ok(Self { sweep: ResolvedSweep::stored(sweep, rounds)?, speeds, record })
    }

    /// Sweep whose speeds are studied.
    pub fn sweep(&self) -> &ResolvedSweep {
        &self.sweep
    }

    /// Whether the rows of the reduction's basis must be stored, must not, or are stored where the study reduces.
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
