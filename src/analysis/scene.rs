//! The scene: which effects a simulation has. What a scene does not name does not exist in the run.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// Effects of one simulation.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct Scene {
    /// Use K(Ω) through the package's three stiffness matrices (Eq. 3); otherwise the stiffness at rest.
    #[serde(default)]
    pub centrifugal_stiffening: bool,
    /// Modal damping; absent: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub damping: Option<Damping>,
    /// The casing around the wheel; absent: the wheel spins freely.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub casing: Option<Casing>,
    /// Unilateral contact between blade tips and casing; absent: tips pass through it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub contact: Option<Contact>,
}

/// Modal damping of the reduced wheel.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct Damping {
    /// Ratio ζ of every mode not listed in `family_ratios`; 0 ≤ ζ < 1.
    pub modal_ratio: f64,
    /// Ratios of the first modal families, the same in every nodal diameter.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub family_ratios: Vec<f64>,
}

/// Rigid casing of revolution with an optional static restriction.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
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
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
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
    pub values: Option<Vec<f64>>,
}

/// Equal Gaussian lobes, evenly spaced in the fixed frame.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct Lobes {
    /// Number of lobes, at least 1.
    pub count: u32,
    /// Height A of a lobe, in the model's unit of length.
    pub amplitude: f64,
    /// Half-width w in exp(−(φ/w)²), rad.
    pub width_rad: f64,
    /// Angle of the first lobe from the package's x axis, rad.
    #[serde(default)]
    pub phase_rad: f64,
}

/// Frictionless unilateral contact, exact complementarity at every step (Eqs 9, 10).
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct Contact {}
