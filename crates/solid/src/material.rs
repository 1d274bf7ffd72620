//! Materials of elements, and their strength.

use nalgebra::{Matrix3, SVector};
use serde::{Deserialize, Serialize};

/// Cauchy stress `σ_11, σ_22, σ_33, σ_12, σ_23, σ_31`.
pub type Stress = SVector<f64, 6>;

/// Isotropic, linear elastic material, in the package's consistent units. Strengths have no default: without them no margins are reported.
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

/// Strengths of a material, as far as they are known, in the model's unit of stress.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct GivenStrengths {
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

impl Material {
    /// Material with these strengths in place of its own.
    #[must_use]
    pub fn with_strengths(&self, given: &GivenStrengths) -> Self {
        let GivenStrengths { yield_strength, ultimate_strength, fatigue_strength } = given.clone();
        Self { yield_strength, ultimate_strength, fatigue_strength, ..*self }
    }

    /// Lamé's constants λ and μ, `σ = λ tr(ε) 1 + 2μ ε`.
    pub fn lame_constants(&self) -> Lame {
        lame_constants(self.youngs_modulus, self.poissons_ratio)
    }
}

/// Lamé's constants of an isotropic material.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lame {
    /// First constant λ.
    pub lambda: f64,
    /// Shear modulus μ.
    pub mu: f64,
}

/// Lamé's constants from Young's modulus and Poisson's ratio.
pub fn lame_constants(e: f64, nu: f64) -> Lame {
    Lame { lambda: e * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)), mu: e / (2.0 * (1.0 + nu)) }
}

/// Stress under the displacement gradient `h_ij = ∂u_i/∂x_j`.
pub fn stress(constants: Lame, h: &Matrix3<f64>) -> Stress {
    let Lame { lambda, mu } = constants;
    let normal = |i: usize| lambda * h.trace() + 2.0 * mu * h[(i, i)];
    let shear = |i: usize, j: usize| mu * (h[(i, j)] + h[(j, i)]);
    Stress::new(normal(0), normal(1), normal(2), shear(0, 1), shear(1, 2), shear(2, 0))
}

/// Symmetric matrix of a stress.
pub(crate) fn tensor(stress: &Stress) -> Matrix3<f64> {
    let [xx, yy, zz, xy, yz, zx] = (*stress).into();
    Matrix3::new(xx, xy, zx, xy, yy, yz, zx, yz, zz)
}

/// Fatigue strength: the stress amplitude that a material bears when stress alternates about zero.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct FatigueStrength {
    /// Amplitude of a fully reversed stress.
    pub amplitude: f64,
    /// Source of the amplitude: standard or test, number of cycles, surface, temperature.
    pub source: String,
}
