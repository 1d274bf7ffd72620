//! The periodic response of a speed: how it was found, and whether it lasts.

use serde::{Deserialize, Serialize};

pub use rubmap_wheel::dynamics::steady::stability::Stability;

/// A Floquet multiplier: how a disturbance grows from one passage of the casing's lobes to the next.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct FloquetMultiplier {
    /// Real part.
    pub real: f64,
    /// Imaginary part.
    pub imaginary: f64,
    /// Modulus: it decays below 1.
    pub modulus: f64,
    /// What is left of its equation, relative to the disturbance.
    pub residual: f64,
    /// Distance, in engine orders, of the lines that it adds from those of the response and from all multiples of the orders per passage:
    /// |arg μ| / 2π of them.
    pub order_offset: f64,
    /// Nodal diameter that carries most of it.
    pub nodal_diameter: u32,
    /// Share of that nodal diameter, by energy.
    pub share: f64,
}

/// How a march ended that was to go on until its motion repeats.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct MarchReport {
    /// Revolutions that it took.
    pub revolutions: u32,
    /// Revolutions after which the motion is the same again: the last ones, which all numbers over the window are of. Absent where it was not
    /// found to repeat.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub period_revolutions: Option<u32>,
    /// Share of the motion by which it may still change, by the rate at which its changes die out; absent likewise.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub remaining_change: Option<f64>,
    /// Why all revolutions were taken.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reason: Option<String>,
}

/// What was found of the periodic response of a speed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct SteadyReport {
    /// Whether the numbers of the speed are those of the periodic response; otherwise it was marched.
    pub taken: bool,
    /// Why it was marched.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reason: Option<String>,
    /// ‖P(x) − x‖ / ‖x‖, P being the map over the shortest passage after which the scene looks the same; absent where no response was found.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub residual: Option<f64>,
    /// Whether it lasts; absent where none was found. Where the scene takes a symmetry of the motion for granted, only what keeps it
    /// counts.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stability: Option<Stability>,
    /// The largest multipliers over `lobe_passages`, largest first.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub multipliers: Vec<FloquetMultiplier>,
    /// Passages of a lobe after which it repeats and which the multipliers are of; a revolution where the casing has no lobes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lobe_passages: Option<u32>,
    /// Times the damping of the scene from which it was followed, where it was not found from where the march begins.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub followed_from_damping: Option<f64>,
    /// Half the peak-to-peak displacement of every sensor on it.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub half_peak_to_peak: Vec<f64>,
    /// Revolutions of the wheel that the search took, with those of the multipliers and of the march that controls it.
    pub revolutions: f64,
}
