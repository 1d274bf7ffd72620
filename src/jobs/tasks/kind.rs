//! What distinguishes tasks from each other.

#[cfg(feature = "cluster")]
use crate::analysis::run::vectors;
use crate::store::jobs::JobId;

/// Which tasks a worker takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::jobs) enum Kind {
    /// Of jobs that any processor may compute.
    Any,
    /// Of jobs that belong to processors with the vectors of this one.
    #[cfg(feature = "cluster")]
    OfThisProcessor,
}

#[cfg(feature = "cluster")]
impl Kind {
    /// The vectors that a processor must have; none where any will do.
    pub(super) fn vectors(self) -> Option<String> {
        (self == Self::OfThisProcessor).then(vectors)
    }
}

/// A job, as far as its tasks go.
#[derive(Debug, Clone, Copy)]
pub(in crate::jobs) struct Whose<'a> {
    pub(in crate::jobs) owner: &'a str,
    pub(in crate::jobs) job: JobId,
    /// Whether only processors with the vectors of this one may take its speeds.
    #[cfg(feature = "cluster")]
    pub(in crate::jobs) one_kind: bool,
}
