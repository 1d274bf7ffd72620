//! Part of a run: what it begins at, and what it leaves.

use super::run::Outcome;
use crate::dynamics::energy::EnergyAudit;
use crate::dynamics::initial::InitialMode;
use crate::dynamics::statistics::RunStatistics;

/// Part of a run, from sample to sample, both counted from where the run began.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Part {
    /// The sample that it begins at: what the simulation calls initial is the state there.
    pub first_sample: u64,
    /// How many samples follow.
    pub samples: u64,
}

/// What part of a run left.
#[derive(Debug, Clone, PartialEq)]
pub struct Stretch {
    /// Why it ended before its end; none if it did not. Never [`Outcome::Completed`].
    pub ended: Option<Outcome>,
    /// `[sensor][sample]`: displacement at the sensor's sector.
    pub displacement: Vec<Vec<f64>>,
    /// `[sensor][sample]`: largest size of the same displacement at any sector.
    pub largest: Vec<Vec<f64>>,
    /// All modes that are integrated, at the end.
    pub end: Vec<InitialMode>,
    /// What was counted.
    pub statistics: RunStatistics,
    /// The energy identity.
    pub energy: EnergyAudit,
}
