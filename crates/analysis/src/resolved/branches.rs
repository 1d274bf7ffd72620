//! Branches as they are stored and run.

use serde::Serialize;

use crate::error::Violation;
use crate::request::{Along, BranchParameter, BranchesSettings};
use crate::resolved::sweep::ResolvedSweep;

/// A scene at one speed and the number of it that changes; see [`BranchesSettings`], as which it is written.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(into = "BranchesSettings")]
pub struct ResolvedBranches {
    pub(crate) sweep: ResolvedSweep,
    /// A speed in rad/s.
    pub(crate) along: Along,
    pub(crate) doubled: bool,
    pub(crate) most_points: u32,
}

impl ResolvedBranches {
    /// Reads again what was resolved before.
    ///
    /// # Errors
    /// What is wrong with it, if it was not.
    pub fn stored(written: BranchesSettings) -> Result<Self, Vec<Violation>> {
        let BranchesSettings { sweep, along, doubled, most_points } = written;
        Ok(Self { sweep: ResolvedSweep::stored(sweep, 0)?, along, doubled, most_points })
    }

    /// The scene at the speed where they begin.
    pub fn sweep(&self) -> &ResolvedSweep {
        &self.sweep
    }

    /// The value of the parameter where they begin.
    pub(crate) fn start(&self) -> f64 {
        match self.along.parameter {
            BranchParameter::Speed => self.speed_rad_s(),
            _ => 1.0,
        }
    }

    /// The speed where they begin.
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
