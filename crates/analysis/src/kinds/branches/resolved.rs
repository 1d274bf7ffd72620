//! Branches as they are stored and run.

use serde::Serialize;

use crate::error::Violation;
use crate::request::{Along, BranchParameter, BranchesSettings};
use crate::resolved::sweep::ResolvedSweep;

/// Branches: a scene at one speed and the number of it that changes; written as [`BranchesSettings`].
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(into = "BranchesSettings")]
pub struct ResolvedBranches {
    pub(crate) sweep: ResolvedSweep,
    /// Number of the scene that changes, and its range; a speed in rad/s.
    pub(crate) along: Along,
    pub(crate) doubled: bool,
    pub(crate) most_points: u32,
}

impl ResolvedBranches {
    /// Reads branches that were resolved and stored before.
    ///
    /// # Errors
    /// Violations, if the branches were never resolved.
    pub fn stored(written: BranchesSettings) -> Result<Self, Vec<Violation>> {
        let BranchesSettings { sweep, along, doubled, most_points } = written;
        Ok(Self { sweep: ResolvedSweep::stored(sweep, 0)?, along, doubled, most_points })
    }

    /// Scene at the speed where the branches begin, as a sweep.
    pub fn sweep(&self) -> &ResolvedSweep {
        &self.sweep
    }

    /// Value of the parameter where the branches begin.
    pub(crate) fn start(&self) -> f64 {
        match self.along.parameter {
            BranchParameter::Speed => self.speed_rad_s(),
            _ => 1.0,
        }
    }

    /// Speed where the branches begin, rad/s.
    pub(crate) fn speed_rad_s(&self) -> f64 {
        self.sweep.speeds.rad_s()[0]
    }
}

impl From<ResolvedBranches> for BranchesSettings {
    fn from(branches: ResolvedBranches) -> Self {
        let ResolvedBranches { sweep, along, doubled, most_points } = branches;
        Self { sweep: sweep.into(), along, doubled, most_points }
    }
}
