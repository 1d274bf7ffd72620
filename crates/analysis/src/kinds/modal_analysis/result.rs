//! Frequencies over speed.

use serde::{Deserialize, Serialize};

use crate::result::reduction::ReductionReport;
use rubmap_wheel::response::campbell::{Crossing, DrivenCrossing};
use rubmap_wheel::response::veerings::Veering;
use rubmap_wheel::response::waves::{Table, Wave};

/// Result of a modal analysis.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct Campbell {
    /// Speeds, rad/s.
    pub speeds_rad_s: Vec<f64>,
    /// Natural frequencies in the rotating frame without Coriolis forces, `[speed][nodal diameter][family]`, Hz.
    pub frequencies_hz: Vec<Vec<Vec<f64>>>,
    /// Families as they were followed. Absent where a family is the rank of a frequency at its speed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub followed: Option<FollowedFamilies>,
    /// Natural frequencies with Coriolis forces, if asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub waves: Option<WaveTables>,
    /// Frequencies |−f + i·n·Ω/2π| in the absolute frame, `[superharmonic][speed][nodal diameter][family]`, Hz (Eq. 11); with Coriolis forces f is
    /// the backward wave's.
    pub absolute_frequencies_hz: Vec<AbsoluteFrequencies>,
    /// Critical speeds of the linear criterion within the range.
    pub crossings: Vec<Crossing>,
    /// Crossings that the lobes can drive.
    pub driven_crossings: Vec<DrivenCrossing>,
    /// Report of the reduction: what it found about the model.
    pub reduction: ReductionReport,
    /// The whole request as resolved.
    pub settings: crate::request::ModalAnalysisRequest,
    /// Wall time of the analysis, s.
    pub wall_time_s: f64,
    /// Version of the code.
    pub version: String,
}

impl Campbell {
    /// Tables of natural frequencies, `[speed][nodal diameter][family]`: one for each direction of travel where Coriolis forces split them, otherwise
    /// a single one.
    pub fn branches(&self) -> Vec<(Option<Wave>, &Table)> {
        match &self.waves {
            None => vec![(None, &self.frequencies_hz)],
            Some(WaveTables { forward_hz, backward_hz }) => {
                vec![(Some(Wave::Forward), forward_hz), (Some(Wave::Backward), backward_hz)]
            }
        }
    }
}

/// Families that were followed from rest by the shapes of their modes, over 24 steps up to the highest speed of the model's matrices whatever
/// speeds are asked for.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct FollowedFamilies {
    /// Ranks of the modes of the families among all modes without Coriolis forces, from 1, `[speed][nodal diameter][family]`.
    pub ranks: Vec<Vec<Vec<u32>>>,
    /// Modal assurance of the modes with the shapes that were followed, 0 to 1, `[speed][nodal diameter][family]`: below 0.75 a mode is a mixture of
    /// families, in the middle of a veering.
    pub assurance: Vec<Vec<Vec<f64>>>,
    /// Veerings and crossings of the families within the range, in ascending nodal diameter and speed.
    pub veerings: Vec<Veering>,
}

/// Natural frequencies in the rotating frame that Coriolis forces split, `[speed][nodal diameter][family]`, Hz. A single
/// nodal diameter (0, and N/2 of an even number of sectors) stands: it has the same frequencies in both tables.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct WaveTables {
    /// Frequencies of waves that travel with the rotation, Hz.
    pub forward_hz: Vec<Vec<Vec<f64>>>,
    /// Frequencies of waves that travel against the rotation, Hz.
    pub backward_hz: Vec<Vec<Vec<f64>>>,
}

/// Absolute-frame frequencies for one superharmonic number.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct AbsoluteFrequencies {
    /// Superharmonic number n in |−f + i·n·Ω/2π|.
    pub superharmonic: u32,
    /// Frequencies in the absolute frame, `[speed][nodal diameter][family]`, Hz.
    pub frequencies_hz: Vec<Vec<Vec<f64>>>,
}
