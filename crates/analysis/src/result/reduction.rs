//! What a reduction found and cost, and how far K(Ω) can be trusted.

use serde::{Deserialize, Serialize};

/// How trustworthy K(Ω) = K0 + Ω²K1 + Ω⁴K2 is between the given speeds (docs/method.md, Centrifugal stiffening).
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(rename_all = "snake_case")]
pub enum StiffeningVerdict {
    /// One stiffness matrix: no stiffening in the model.
    Absent,
    /// Linear in Ω² as on the undeformed geometry.
    Sound,
    /// Shows signs of stiffness taken on the deformed geometry; usable with the stated error.
    Suspect,
    /// Not to be relied on: frequencies between the given speeds are not smooth, K(Ω) is indefinite there, or K(Ω) is not that of the
    /// given speeds by mass and positions.
    Unsound,
}

impl StiffeningVerdict {
    /// What numbers that rest on K(Ω) are worth, where that is not what they seem.
    pub fn warning(self) -> Option<&'static str> {
        match self {
            Self::Absent | Self::Sound => None,
            Self::Suspect => Some(
                "K(Ω) is suspect: between the speeds at which the stiffness is given, frequencies and amplitudes are off; the \
                 reduction estimates by how much",
            ),
            Self::Unsound => Some(
                "K(Ω) is unsound: between the speeds at which the stiffness is given, or at all of them, frequencies, critical speeds \
                 and amplitudes are not to be relied on; `stiffening` of the model says why",
            ),
        }
    }
}

/// What the stiffness matrices of a model tell about K(Ω) by themselves. Preliminary: how far frequencies between the given speeds
/// are off, and with it the verdict, the first reduction finds.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct PreliminaryStiffening {
    /// Verdict; what is suspect may prove to be unsound.
    pub verdict: StiffeningVerdict,
    /// ‖Ω1²K1‖/‖K0‖.
    pub linear_ratio: f64,
    /// ‖Ω1⁴K2‖/‖K0‖.
    pub quadratic_ratio: f64,
    /// The finding in words, with what to do.
    pub message: String,
}

/// The check of the stiffness interpolation.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct StiffeningReport {
    /// The verdict.
    pub verdict: StiffeningVerdict,
    /// ‖Ω1²K1‖/‖K0‖.
    pub linear_ratio: f64,
    /// ‖Ω1⁴K2‖/‖K0‖.
    pub quadratic_ratio: f64,
    /// Estimated largest relative error of a first-family frequency between the given speeds.
    pub frequency_error: f64,
    /// The finding in words, with what to do.
    pub message: String,
}

/// The largest difference between a frequency of the reduced and of the full sector.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct LargestDifference {
    /// |reduced/full − 1|.
    pub relative: f64,
    /// Nodal diameter it occurs in.
    pub nodal_diameter: u32,
    /// Mode it occurs in, counted from 1.
    pub mode: u32,
    /// Frequency of that mode in the full sector, Hz.
    pub full_hz: f64,
}

/// The lowest frequencies of the reduced sector beside the full sector's at one speed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct FrequencyDifference {
    /// Ω, rad/s.
    pub speed_rad_s: f64,
    /// Where they differ most; null where every nodal diameter is left out.
    pub largest: Option<LargestDifference>,
    /// Nodal diameters left out because the full sector's stiffness is not positive definite at this speed.
    pub indefinite: Vec<u32>,
}

/// What the reduction of a model found and what it cost.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct ReductionReport {
    /// k.
    pub modes_per_speed: u32,
    /// Generalised coordinates kept per nodal diameter (contact DOF and modes of the basis).
    pub unknowns: Vec<u32>,
    /// Real unknowns of the whole reduced wheel.
    pub wheel_unknowns: u32,
    /// Largest relative residual ‖Kx − λMx‖/‖Kx‖ over all fixed-interface modes.
    pub largest_mode_residual: f64,
    /// Fixed-interface modes over all nodal diameters and speeds.
    pub modes: u32,
    /// How many of them are proven to be the lowest, none missed, by a count of eigenvalues (Sylvester's law of
    /// inertia) or because they are all there are. Fewer than `modes` only where round-off leaves no shift to count at.
    pub counted_modes: u32,
    /// The reduced model's ten lowest frequencies per nodal diameter beside the full sector's, at the given speeds
    /// and between them.
    pub full_model: Vec<FrequencyDifference>,
    /// Relative tolerance below which nearly dependent directions of the basis were dropped.
    pub basis_tolerance: f64,
    /// Stiffness interpolation check.
    pub stiffening: StiffeningReport,
    /// Wall time, s.
    pub wall_time_s: f64,
    /// Version of the code.
    pub version: String,
}

impl ReductionReport {
    /// Largest relative difference of the ten lowest frequencies of any nodal diameter, at any speed, from the full sector's.
    pub(crate) fn largest_difference(&self) -> f64 {
        let lines = self.full_model.iter().filter_map(|line| line.largest.as_ref());
        lines.fold(0.0, |largest, difference| largest.max(difference.relative))
    }
}
