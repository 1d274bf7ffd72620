//! Ends of backbone curves, in words.

use std::fmt;

/// Resonance between the motion of a curve and another mode.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Resonance {
    /// Harmonic h of the motion.
    pub harmonic: usize,
    /// Nodal diameter of the other mode.
    pub nodal_diameter: usize,
    /// Rank of the other mode in its nodal diameter, from 0.
    pub rank: usize,
}

/// Reason for the end of a backbone curve.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BackboneEnd {
    /// The largest amplitude that was asked for is reached.
    LargestAmplitude,
    /// No motion of a larger amplitude was found beside a resonance with another mode.
    AtResonance(Resonance),
    /// No motion of a larger amplitude was found, far from any resonance.
    NotFound,
    /// The square of the frequency falls to zero: nothing draws the blades back.
    NoRestoringForce,
    /// Too few harmonics: the largest number allowed does not resolve the motion.
    Unresolved {
        /// Number of harmonics.
        harmonics: usize,
    },
    /// The contact nodes do not move in the mode.
    StillContact,
}

impl fmt::Display for Resonance {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { harmonic, nodal_diameter, rank } = self;
        write!(
            f,
            "resonance of harmonic {harmonic} with mode {} of nodal diameter {nodal_diameter}",
            rank + 1
        )
    }
}

impl fmt::Display for BackboneEnd {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::LargestAmplitude => write!(f, "the largest amplitude is reached"),
            Self::AtResonance(resonance) => {
                write!(f, "no larger motion was found near the {resonance}, with which energy is exchanged")
            }
            Self::NotFound => write!(f, "no larger motion was found: the curve turns back or ends"),
            Self::NoRestoringForce => {
                write!(f, "the frequency falls to zero: the potential of fourth order does not hold so far")
            }
            Self::Unresolved { harmonics } => {
                write!(f, "{harmonics} harmonics are too few for a larger motion")
            }
            Self::StillContact => write!(f, "the contact nodes do not move in this mode"),
        }
    }
}
