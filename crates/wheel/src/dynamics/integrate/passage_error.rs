//! Errors of return maps.

use super::run::Divergence;
use rubmap_numerics::complementarity::ComplementarityError;

/// Reason why a scene has no return map, or a state no image.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PassageError {
    /// Abradable coating.
    #[error("a coating that wears is never as it was, so that nothing repeats")]
    Coating,
    /// Clearances that change.
    #[error("clearances that change leave behind what depends on how it was come to: it is marched")]
    ClearanceChange,
    /// Coulomb friction as a disc.
    #[error("of friction with the law \"disc\" no tangent is known: march, or take the law \"sliding\"")]
    Disc,
    /// Blades that bend far.
    #[error("periodic responses cannot be solved for where blades bend far")]
    Bending,
    /// Orbit of the shaft that returns too late, or never.
    #[error("an orbit of whirl ratio {whirl_ratio} does not come round within {most} revolutions")]
    Orbit {
        /// Whirl ratio κ.
        whirl_ratio: f64,
        /// Most revolutions that an orbit may take.
        most: usize,
    },
    /// Flow that left the bounds of the theory.
    #[error("the motion leaves the bounds of linear theory")]
    Diverged(Divergence),
    /// Contact problem of a step that could not be solved.
    #[error("contact: {0}")]
    Contact(ComplementarityError),
}
