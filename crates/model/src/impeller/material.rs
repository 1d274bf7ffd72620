//! Isotropic, linear elastic material.

use rubmap_solid::material::{self, FatigueStrength};
use serde::{Deserialize, Serialize};

use super::error::ImpellerError;
use super::ranges::positive;

/// Isotropic linear elasticity, in the model's consistent units. Default: titanium (`Ti-6Al-4V`) in mm-t-s-N.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields, default)]
pub struct Material {
    /// Young's modulus E > 0 (N/mm²).
    pub youngs_modulus: f64,
    /// Poisson's ratio, −1 < ν < 0.5.
    pub poissons_ratio: f64,
    /// Mass density ρ > 0 (t/mm³).
    pub density: f64,
    /// Yield strength (N/mm²); none unless given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub yield_strength: Option<f64>,
    /// Ultimate strength (N/mm²); none unless given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ultimate_strength: Option<f64>,
    /// Fatigue strength; none unless given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fatigue_strength: Option<FatigueStrength>,
}

impl Default for Material {
    fn default() -> Self {
        Self {
            youngs_modulus: 114_000.0,
            poissons_ratio: 0.32,
            density: 4.43e-9,
            yield_strength: None,
            ultimate_strength: None,
            fatigue_strength: None,
        }
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
        for (field, strength) in [
            ("material.yield_strength", self.yield_strength),
            ("material.ultimate_strength", self.ultimate_strength),
            ("material.fatigue_strength.amplitude", self.fatigue_strength.as_ref().map(|f| f.amplitude)),
        ] {
            strength.map_or(Ok(()), |strength| positive(field, strength))?;
        }
        match &self.fatigue_strength {
            Some(FatigueStrength { source, .. }) if source.trim().is_empty() => {
                Err(ImpellerError::Parameter {
                    field: "material.fatigue_strength.source",
                    value: format!("\"{source}\""),
                    requirement: "must say where the strength comes from",
                })
            }
            _ => Ok(()),
        }
    }

    /// Converts the material to that of a package.
    pub fn to_solid(&self) -> material::Material {
        let Self { youngs_modulus, poissons_ratio, density, .. } = *self;
        material::Material {
            youngs_modulus,
            poissons_ratio,
            density,
            yield_strength: self.yield_strength,
            ultimate_strength: self.ultimate_strength,
            fatigue_strength: self.fatigue_strength.clone(),
        }
    }
}
