//! Elastic casing, its alternatives resolved.

use super::request::{self, CasingMode, Ring};
use crate::effects::asked::Asked;
use crate::error::Violation;

/// Elastic casing in the fixed frame.
#[derive(Debug, Clone, PartialEq)]
pub struct FlexibleCasing {
    pub(crate) waves: WavesOf,
    pub(crate) damping_ratio: f64,
}

/// Source of the waves of an elastic casing.
#[derive(Debug, Clone, PartialEq)]
pub enum WavesOf {
    /// Ring, whose in-plane bending waves are computed.
    Ring(Ring),
    /// Modes as given.
    Modes(Vec<CasingMode>),
}

impl Asked for Option<request::FlexibleCasing> {
    type Resolved = Option<FlexibleCasing>;

    fn resolve(self, refuse: &mut dyn FnMut(Violation)) -> Option<FlexibleCasing> {
        let request::FlexibleCasing { ring, modes, damping_ratio } = self?;
        let waves = match (ring, modes) {
            (Some(ring), None) => WavesOf::Ring(ring),
            (None, Some(modes)) => WavesOf::Modes(modes),
            _ => {
                refuse(Violation::new(
                    "/scene/flexible_casing",
                    "give either `ring`, whose modes are computed, or `modes`",
                ));
                return None;
            }
        };
        Some(FlexibleCasing { waves, damping_ratio })
    }

    fn of(resolved: Option<FlexibleCasing>) -> Self {
        let FlexibleCasing { waves, damping_ratio } = resolved?;
        let (ring, modes) = match waves {
            WavesOf::Ring(ring) => (Some(ring), None),
            WavesOf::Modes(modes) => (None, Some(modes)),
        };
        Some(request::FlexibleCasing { ring, modes, damping_ratio })
    }
}
