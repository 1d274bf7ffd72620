//! Symmetry of a scene.

use serde::{Deserialize, Serialize};

/// Symmetry of a scene: how often it repeats around the wheel.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct FoundSymmetry {
    /// Number of times that the scene repeats around the wheel: the greatest common divisor of the number of sectors, that of the lobes, and the
    /// orders of all that drives or disturbs the wheel besides.
    pub repeats: u32,
    /// Nodal diameters that move in a response with the symmetry of the scene: multiples of `repeats`.
    pub moving_nodal_diameters: Vec<u32>,
    /// Nodal diameters that stay at rest (at round-off) until the symmetry breaks by itself: all that are no multiples of `repeats`.
    pub resting_nodal_diameters: Vec<u32>,
}
