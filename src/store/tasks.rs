//! Units of work, as queues have them.

use serde::{Deserialize, Serialize};

use super::jobs::job::JobId;

/// Preparation of a job: to the point where its speeds can be computed, or to its end where it has none.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub struct PrepareJob {
    /// The job.
    pub job: JobId,
}

/// Computation of one speed of one job.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub struct RunSpeed {
    /// The job.
    pub job: JobId,
    /// Index of the speed in its request.
    pub speed: u32,
}
