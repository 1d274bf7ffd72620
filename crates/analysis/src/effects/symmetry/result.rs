//! What is found of the symmetry of a scene.

use serde::{Deserialize, Serialize};

/// How often a scene repeats around the wheel.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct FoundSymmetry {
    /// The scene repeats so often around the wheel: the greatest common divisor of the number of sectors, that of the
    /// lobes, and the orders of all that drives or disturbs the wheel besides.
    pub repeats: u32,
    /// Nodal diameters that move in a response with that symmetry: multiples of `repeats`.
    pub moving_nodal_diameters: Vec<u32>,
    /// The others stay at rest (at round-off) until the symmetry breaks by itself.
    pub resting_nodal_diameters: Vec<u32>,
}
