//! Why a passage cannot be had.

use super::run::Divergence;
use rubmap_numerics::complementarity::ComplementarityError;

/// Why a scene has no such map, or a state no image.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PassageError {
    /// An abradable coating.
    #[error("a coating that wears is never as it was, so that nothing repeats")]
    Coating,
    /// Clearances that change.
    #[error("clearances that change leave behind what depends on how it was come to: it is marched")]
    ClearanceChange,
    /// Friction as a disc.
    #[error("of friction with the law \"disc\" no tangent is known: march, or take the law \"sliding\"")]
    Disc,
    /// An orbit of the shaft that is back where it was too late, or never.
    #[error("an orbit of whirl ratio {whirl_ratio} does not come round within {most} revolutions")]
    Orbit {
        /// κ.
        whirl_ratio: f64,
        /// Revolutions.
        most: usize,
    },
    /// The flow left the bounds of the theory.
    #[error("the motion leaves the bounds of linear theory")]
    Diverged(Divergence),
    /// The contact problem of a step could not be solved.
    #[error("contact: {0}")]
    Contact(ComplementarityError),
}
