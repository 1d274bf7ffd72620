//! Blades that bend far, as it is asked for.

use serde::{Deserialize, Serialize};

use crate::effects::asked::Plain;

/// Blades that bend so far that linear theory ends: displacement of second order, which draws tips back as they bend, and geometric stiffening,
/// condensed on a few coordinates of every blade. For models with a mesh. Speeds are marched, and branches cannot be followed.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct GeometricNonlinearity {
    /// Part of it that counts.
    pub include: Bending,
    /// Number of coordinates of a blade, 1 to 8: the shapes that the lowest families of all nodal diameters have in common.
    #[serde(default = "coordinates")]
    #[cfg_attr(feature = "schema", schema(minimum = 1, maximum = 8, default = 4))]
    pub coordinates: u32,
}

/// Part of geometric nonlinearity.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(rename_all = "snake_case")]
pub enum Bending {
    /// Displacement of second order: gaps, the directions of contact forces, and sensors and tips at contact nodes.
    Kinematics,
    /// Stiffening as well: forces from the strain energy of third and fourth order, and of the inertia of the displacement of second order.
    Full,
}

fn coordinates() -> u32 {
    4
}

impl Plain for Option<GeometricNonlinearity> {}
