//! What elements are made of, and what it bears.

use serde::{Deserialize, Serialize};

/// An isotropic, linear elastic material, in the package's consistent units. What it bears has no default: without it nothing is said of
/// margins.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Material {
    /// Young's modulus E > 0.
    pub youngs_modulus: f64,
    /// Poisson's ratio, −1 < ν < 0.5.
    pub poissons_ratio: f64,
    /// Mass density ρ > 0.
    pub density: f64,
    /// Yield strength.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub yield_strength: Option<f64>,
    /// Ultimate strength.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ultimate_strength: Option<f64>,
    /// Fatigue strength.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fatigue_strength: Option<FatigueStrength>,
}

/// The stress amplitude that a material bears when it alternates about zero.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FatigueStrength {
    /// Amplitude of a fully reversed stress.
    pub amplitude: f64,
    /// Where it comes from: standard or test, number of cycles, surface, temperature.
    pub source: String,
}
