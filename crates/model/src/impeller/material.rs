//! An isotropic, linear elastic material.

use nalgebra::{Matrix3, SVector};
use serde::{Deserialize, Serialize};

use super::error::ImpellerError;
use super::ranges::positive;

/// Cauchy stress `σ_xx, σ_yy, σ_zz, σ_xy, σ_yz, σ_zx`.
pub type Stress = SVector<f64, 6>;

/// Isotropic linear elasticity, in the model's consistent units. Default: titanium (`Ti-6Al-4V`) in mm-t-s-N.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields, default)]
pub struct Material {
    /// Young's modulus E > 0 (N/mm²).
    pub youngs_modulus: f64,
    /// Poisson's ratio, −1 < ν < 0.5.
    pub poissons_ratio: f64,
    /// Mass density ρ > 0 (t/mm³).
    pub density: f64,
}

impl Default for Material {
    fn default() -> Self {
        Self { youngs_modulus: 114_000.0, poissons_ratio: 0.32, density: 4.43e-9 }
    }
}

impl Material {
    /// Refuses constants without a positive definite elasticity.
    ///
    /// # Errors
    /// [`ImpellerError::Parameter`] names the field.
    pub fn validate(&self) -> Result<(), ImpellerError> {
        positive("material.youngs_modulus", self.youngs_modulus)?;
        positive("material.density", self.density)?;
        if !(self.poissons_ratio > -1.0 && self.poissons_ratio < 0.5) {
            return Err(ImpellerError::Parameter {
                field: "material.poissons_ratio",
                value: self.poissons_ratio.to_string(),
                requirement: "must lie between -1 and 0.5, both excluded",
            });
        }
        Ok(())
    }

    /// λ and μ of Lamé, `σ = λ tr(ε) 1 + 2μ ε`.
    pub fn lame_constants(&self) -> (f64, f64) {
        let (e, nu) = (self.youngs_modulus, self.poissons_ratio);
        (e * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)), e / (2.0 * (1.0 + nu)))
    }

    /// Stress under the displacement gradient `h_ij = ∂u_i/∂x_j`.
    pub fn stress(&self, h: &Matrix3<f64>) -> Stress {
        let (lambda, mu) = self.lame_constants();
        let normal = |i: usize| lambda * h.trace() + 2.0 * mu * h[(i, i)];
        let shear = |i: usize, j: usize| mu * (h[(i, j)] + h[(j, i)]);
        Stress::new(normal(0), normal(1), normal(2), shear(0, 1), shear(1, 2), shear(2, 0))
    }
}
