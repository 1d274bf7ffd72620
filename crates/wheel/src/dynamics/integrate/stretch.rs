//! Part of a run: its beginning and its results.

use super::run::Outcome;
use crate::dynamics::energy::EnergyAudit;
use crate::dynamics::initial::InitialMode;
use crate::dynamics::statistics::RunStatistics;

/// Part of a run, from sample to sample, both counted from where the run began.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Part {
    /// Sample that the part begins at: the initial state of the simulation is the state there.
    pub first_sample: u64,
    /// Number of samples that follow.
    pub samples: u64,
}

/// Results of part of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct Stretch {
    /// Outcome of a part that ended before its end; none if it did not. Never [`Outcome::Completed`].
    pub ended: Option<Outcome>,
    /// Displacements at the sensor's sector, `[sensor][sample]`.
    pub displacement: Vec<Vec<f64>>,
    /// Largest size of the displacement at any sector, `[sensor][sample]`.
    pub largest: Vec<Vec<f64>>,
    /// Modes that are integrated, at the end, all of them.
    pub end: Vec<InitialMode>,
    /// Counters of the part.
    pub statistics: RunStatistics,
    /// Energy audit of the part.
    pub energy: EnergyAudit,
}
