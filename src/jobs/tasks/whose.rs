//! Jobs, as far as their tasks go.

use crate::store::jobs::JobId;

/// A job, as far as its tasks go.
#[derive(Debug, Clone, Copy)]
pub(in crate::jobs) struct Whose<'a> {
    pub(in crate::jobs) owner: &'a str,
    pub(in crate::jobs) job: JobId,
    /// Whether only processors with the vectors of this one may take its speeds.
    pub(in crate::jobs) one_kind: bool,
}
