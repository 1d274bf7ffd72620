//! Kinds of tasks that machines share.

use crate::analysis::run::vectors;

/// Tasks that a worker takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    /// Tasks of jobs that any processor may compute.
    Any,
    /// Tasks of jobs that belong to processors with the vectors of this one.
    OfThisProcessor,
}

impl Kind {
    /// All kinds, each with workers of its own.
    pub(super) const ALL: [Self; 2] = [Self::Any, Self::OfThisProcessor];

    /// The vectors that a processor must have; none where any will do.
    pub(super) fn vectors(self) -> Option<String> {
        (self == Self::OfThisProcessor).then(vectors)
    }
}
