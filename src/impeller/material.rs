//! An isotropic, linear elastic material.

use nalgebra::SMatrix;
use serde::{Deserialize, Serialize};

use super::error::ImpellerError;

/// Isotropic linear elasticity, in the model's consistent units. Default: titanium (`Ti-6Al-4V`) in mm-t-s-N.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
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
        super::parameters::positive("material.youngs_modulus", self.youngs_modulus)?;
        super::parameters::positive("material.density", self.density)?;
        if !(self.poissons_ratio > -1.0 && self.poissons_ratio < 0.5) {
            return Err(ImpellerError::Parameter {
                field: "material.poissons_ratio",
                value: self.poissons_ratio.to_string(),
                requirement: "must lie between -1 and 0.5, both excluded",
            });
        }
        Ok(())
    }

    /// C with σ = C ε, `ε = (ε_xx, ε_yy, ε_zz, γ_xy, γ_yz, γ_zx)`.
    pub fn elasticity(&self) -> SMatrix<f64, 6, 6> {
        let (e, nu) = (self.youngs_modulus, self.poissons_ratio);
        let shear = e / (2.0 * (1.0 + nu));
        let lambda = e * nu / ((1.0 + nu) * (1.0 - 2.0 * nu));
        let mut c = SMatrix::<f64, 6, 6>::zeros();
        for i in 0..3 {
            for j in 0..3 {
                c[(i, j)] = lambda;
            }
            c[(i, i)] += 2.0 * shear;
            c[(i + 3, i + 3)] = shear;
        }
        c
    }
}
