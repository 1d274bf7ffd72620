//! Findings and cost of a reduction, and how far K(Ω) can be trusted.

use serde::{Deserialize, Serialize};

/// Verdict on how far K(Ω) = K0 + Ω²K1 + Ω⁴K2 can be trusted between the given speeds (docs/method.md, Centrifugal stiffening).
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(rename_all = "snake_case")]
pub enum StiffeningVerdict {
    /// One stiffness matrix: no stiffening in the model.
    Absent,
    /// Linear in Ω² as on the undeformed geometry.
    Sound,
    /// Signs of stiffness taken on the deformed geometry; usable with the stated error.
    Suspect,
    /// Not to be relied on: frequencies between the given speeds are not smooth, K(Ω) is indefinite there, or K(Ω) is not that of the
    /// given speeds by mass and positions.
    Unsound,
}

impl StiffeningVerdict {
    /// Warning about numbers that rest on K(Ω), where they are not what they seem.
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

/// Verdict on K(Ω) by the stiffness matrices of a model alone. Preliminary: how far frequencies between the given speeds are off, and with it the
/// verdict, the first reduction finds.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct PreliminaryStiffening {
    /// Preliminary verdict; a suspect K(Ω) may prove to be unsound.
    pub verdict: StiffeningVerdict,
    /// Relative size ‖Ω1²K1‖/‖K0‖ of the term in Ω².
    pub linear_ratio: f64,
    /// Relative size ‖Ω1⁴K2‖/‖K0‖ of the term in Ω⁴.
    pub quadratic_ratio: f64,
    /// The finding in words, with what to do.
    pub message: String,
}

/// Result of the check of the stiffness interpolation.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct StiffeningReport {
    /// Verdict on the stiffness interpolation.
    pub verdict: StiffeningVerdict,
    /// Relative size ‖Ω1²K1‖/‖K0‖ of the term in Ω².
    pub linear_ratio: f64,
    /// Relative size ‖Ω1⁴K2‖/‖K0‖ of the term in Ω⁴.
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
    /// Relative difference |reduced/full − 1| of the frequency.
    pub relative: f64,
    /// Nodal diameter in which the largest difference occurs.
    pub nodal_diameter: u32,
    /// Mode in which the largest difference occurs, counted from 1.
    pub mode: u32,
    /// Frequency of that mode in the full sector, Hz.
    pub full_hz: f64,
}

/// The lowest frequencies of the reduced sector beside the full sector's at one speed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct FrequencyDifference {
    /// Rotational speed Ω, rad/s.
    pub speed_rad_s: f64,
    /// Largest difference of any frequency; null where every nodal diameter is left out.
    #[cfg_attr(feature = "schema", schema(required))]
    pub largest: Option<LargestDifference>,
    /// Nodal diameters left out because the full sector's stiffness is not positive definite at this speed.
    pub indefinite: Vec<u32>,
}

/// Report of the reduction of a model: what it found, and its cost.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct ReductionReport {
    /// Fixed-interface modes kept per stiffness speed and nodal diameter, k.
    pub modes_per_speed: u32,
    /// Generalised coordinates kept per nodal diameter (contact DOF and modes of the basis).
    pub unknowns: Vec<u32>,
    /// Real unknowns of the whole reduced wheel.
    pub wheel_unknowns: u32,
    /// Largest relative residual ‖Kx − λMx‖/‖Kx‖ over all fixed-interface modes.
    pub largest_mode_residual: f64,
    /// Fixed-interface modes over all nodal diameters and speeds.
    pub modes: u32,
    /// Number of `modes` that are proven to be the lowest, none missed, by a count of eigenvalues (Sylvester's law of inertia) or because they are
    /// all there are. Fewer than `modes` only where round-off leaves no shift to count at.
    pub counted_modes: u32,
    /// Ten lowest frequencies per nodal diameter of the reduced model beside the full sector's, at the given speeds and between them.
    pub full_model: Vec<FrequencyDifference>,
    /// Relative tolerance below which nearly dependent directions of the basis were dropped.
    pub basis_tolerance: f64,
    /// Check of the stiffness interpolation.
    pub stiffening: StiffeningReport,
    /// Wall time of the reduction, s.
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
