//! Frequencies over speed.

use serde::{Deserialize, Serialize};

use crate::result::reduction::ReductionReport;
use rubmap_wheel::response::campbell::{Crossing, DrivenCrossing};
use rubmap_wheel::response::waves::{Table, Wave};

/// Result of a modal analysis.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct Campbell {
    /// Speeds, rad/s.
    pub speeds_rad_s: Vec<f64>,
    /// `[speed][nodal diameter][family]`: natural frequencies in the rotating frame without Coriolis forces, Hz. A family is the rank of
    /// a frequency at its speed, in ascending order: modes that cross swap their families there.
    pub frequencies_hz: Vec<Vec<Vec<f64>>>,
    /// Those with Coriolis forces, if asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub waves: Option<WaveTables>,
    /// `[superharmonic][speed][nodal diameter][family]`: |−f + i·n·Ω/2π| in the absolute frame, Hz (Eq. 11); with Coriolis
    /// forces f is the backward wave's.
    pub absolute_frequencies_hz: Vec<AbsoluteFrequencies>,
    /// The linear criterion's critical speeds within the range.
    pub crossings: Vec<Crossing>,
    /// Those crossings that the lobes can drive.
    pub driven_crossings: Vec<DrivenCrossing>,
    /// What the reduction found about the model.
    pub reduction: ReductionReport,
    /// The whole request as resolved.
    pub settings: crate::request::ModalAnalysisRequest,
    /// Wall time, s.
    pub wall_time_s: f64,
    /// Version of the code.
    pub version: String,
}

impl Campbell {
    /// Natural frequencies as they are met, `[speed][nodal diameter][family]`: of waves of either direction where Coriolis
    /// forces split them, otherwise one table.
    pub fn branches(&self) -> Vec<(Option<Wave>, &Table)> {
        match &self.waves {
            None => vec![(None, &self.frequencies_hz)],
            Some(WaveTables { forward_hz, backward_hz }) => {
                vec![(Some(Wave::Forward), forward_hz), (Some(Wave::Backward), backward_hz)]
            }
        }
    }
}

/// Natural frequencies in the rotating frame that Coriolis forces split, `[speed][nodal diameter][family]`, Hz. A single
/// nodal diameter (0, and N/2 of an even number of sectors) stands: it has the same frequencies in both tables.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct WaveTables {
    /// Of waves that travel with the rotation.
    pub forward_hz: Vec<Vec<Vec<f64>>>,
    /// Of waves that travel against it.
    pub backward_hz: Vec<Vec<Vec<f64>>>,
}

/// Absolute-frame frequencies for one superharmonic number.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct AbsoluteFrequencies {
    /// n in |−f + i·n·Ω/2π|.
    pub superharmonic: u32,
    /// `[speed][nodal diameter][family]`, Hz.
    pub frequencies_hz: Vec<Vec<Vec<f64>>>,
}
