//! The periodic response of a speed: how it was found, and whether it is stable.

use serde::{Deserialize, Serialize};

pub use rubmap_wheel::dynamics::steady::stability::Stability;

/// A Floquet multiplier: how a disturbance grows from one passage of the casing's lobes to the next.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct FloquetMultiplier {
    /// Real part of the multiplier.
    pub real: f64,
    /// Imaginary part of the multiplier.
    pub imaginary: f64,
    /// Modulus of the multiplier: below 1 the disturbance decays.
    pub modulus: f64,
    /// Residual of the multiplier's equation, relative to the disturbance.
    pub residual: f64,
    /// Distance, in engine orders, of the lines that the disturbance adds from those of the response and from all multiples of the orders per
    /// passage: |arg μ| / 2π of them.
    pub order_offset: f64,
    /// Nodal diameter that carries most of the disturbance.
    pub nodal_diameter: u32,
    /// Share of that nodal diameter in the disturbance, by energy.
    pub share: f64,
}

/// Report of a march that was to go on until its motion repeats.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct MarchReport {
    /// Revolutions that the march took.
    pub revolutions: u32,
    /// Period of the motion in revolutions: the last ones of the march, from which all numbers over the window are taken. Absent where the motion was
    /// not found to repeat.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub period_revolutions: Option<u32>,
    /// Share of the motion by which it may still change, by the rate at which its changes die out; absent where the motion was not found to repeat.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub remaining_change: Option<f64>,
    /// Reason for which all revolutions were taken.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reason: Option<String>,
}

/// Report of the search for the periodic response of a speed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct SteadyReport {
    /// Whether the numbers of the speed are those of the periodic response; otherwise the speed was marched.
    pub taken: bool,
    /// Reason for which the speed was marched.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reason: Option<String>,
    /// Residual ‖P(x) − x‖ / ‖x‖ of the response x, P being the return map over the shortest time after which the scene looks the same; absent where
    /// no response was found.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub residual: Option<f64>,
    /// Stability of the periodic response; absent where none was found. Where the scene takes a symmetry of the motion for granted, only disturbances
    /// that keep the symmetry count.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stability: Option<Stability>,
    /// Floquet multipliers of largest modulus over `lobe_passages`, largest first.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub multipliers: Vec<FloquetMultiplier>,
    /// Passages of a lobe after which the response repeats and over which the multipliers are taken; revolutions where the casing has no lobes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lobe_passages: Option<u32>,
    /// Multiple of the scene's damping from which the response was followed down to that of the scene; absent where the search from the beginning of
    /// the march found the response.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub followed_from_damping: Option<f64>,
    /// Half the peak-to-peak displacement of every sensor on the periodic response, whether taken or not.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub half_peak_to_peak: Vec<f64>,
    /// Revolutions of the wheel that the search took, with those of the multipliers and of the march that controls the response.
    pub revolutions: f64,
}
