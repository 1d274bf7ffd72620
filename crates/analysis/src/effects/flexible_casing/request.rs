//! An elastic casing, as it is asked for.

use serde::{Deserialize, Serialize};

/// Elastic casing in the fixed frame: a ring, or its modes as given.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct FlexibleCasing {
    /// Ring whose in-plane bending modes are computed; else give `modes`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ring: Option<Ring>,
    /// Modes as given; else give `ring`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(feature = "schema", schema(min_items = 1, max_items = 50))]
    pub modes: Option<Vec<CasingMode>>,
    /// Modal damping ratio of every casing mode, in [0, 1); 1 % by default, that of a bolted steel structure.
    #[serde(default = "default_casing_damping")]
    pub damping_ratio: f64,
}

fn default_casing_damping() -> f64 {
    0.01
}

/// Thin elastic ring: breathing (n = 0) and inextensional bending in its plane (n ≥ 2). A free ring resists no translation
/// (n = 1): give `modes` of the mounted casing where that matters.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct Ring {
    /// Radius of the centre line, length.
    pub radius: f64,
    /// Young's modulus, force/length².
    pub modulus: f64,
    /// Mass per volume.
    pub density: f64,
    /// Area of the section, length².
    pub area: f64,
    /// Second moment of area for bending in the ring's plane, length⁴.
    pub second_moment: f64,
    /// Highest nodal diameter n, at most 50. Waves of more than n_max periods count as rigid; 8 reaches what a handful of lobes
    /// and blades excites.
    #[serde(default = "default_n_max")]
    #[cfg_attr(feature = "schema", schema(maximum = 50))]
    pub n_max: u32,
}

fn default_n_max() -> u32 {
    8
}

/// One nodal diameter of the casing: two waves, cos nφ and sin nφ (one for n = 0).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct CasingMode {
    /// Nodal diameter n.
    #[cfg_attr(feature = "schema", schema(maximum = 50))]
    pub nodal_diameter: u32,
    /// Natural frequency, Hz.
    pub frequency_hz: f64,
    /// Modal mass for a radial displacement of unit amplitude.
    pub modal_mass: f64,
}
