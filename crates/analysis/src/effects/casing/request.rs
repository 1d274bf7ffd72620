//! The casing, as it is asked for.

use serde::{Deserialize, Serialize};

/// Casing of revolution with an optional static restriction.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct Casing {
    /// Clearance at rest along the chord.
    pub clearance: Clearance,
    /// Lobes of the restriction; absent: the casing is circular.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lobes: Option<Lobes>,
}

/// Clearance in the model's unit of length: `leading` and `trailing` (linear in the arc length through the contact
/// nodes), or `values`, one per contact node.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct Clearance {
    /// At the leading edge (contact node 0).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub leading: Option<f64>,
    /// At the trailing edge (last contact node).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub trailing: Option<f64>,
    /// One value per contact node.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(feature = "schema", schema(max_items = 8192))]
    pub values: Option<Vec<f64>>,
}

/// Equal Gaussian lobes, evenly spaced in the fixed frame.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct Lobes {
    /// Number of lobes, at least 1.
    #[cfg_attr(feature = "schema", schema(minimum = 1, maximum = 100))]
    pub count: u32,
    /// Height A of a lobe, in the model's unit of length; at most a tenth of the radius at which the tips lie.
    pub amplitude: f64,
    /// Half-width w in exp(−(φ/w)²), rad; at most √2π/`count`, from where there is no valley between two lobes.
    pub width_rad: f64,
    /// Angle of the first lobe from the package's x axis, rad.
    #[serde(default)]
    pub phase_rad: f64,
}
