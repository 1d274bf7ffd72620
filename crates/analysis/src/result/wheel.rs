//! Critical speeds of the wheel as a whole.

use serde::{Deserialize, Serialize};

use crate::request::{Sensor, SweepRequest};
use crate::result::refinement::Refinement;
use crate::result::sweep::CriticalSpeed;
use crate::result::tip::TipResponse;
use crate::result::validity::{ValidityMeasure, ValidityVerdict};
use rubmap_wheel::dynamics::sector::Units;
use rubmap_wheel::response::settling::Verdict;

/// Critical speeds of the wheel as a whole, the most severe first, with the views of the sensors beside them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct WheelCriticalSpeeds {
    /// Peaks over Ω of the largest root mean square of any tip.
    pub critical_speeds: Vec<WheelCriticalSpeed>,
    /// Critical speeds that each sensor sees, in the order of the request.
    pub sensors: Vec<SensorView>,
    /// Indices of the speeds without a result, which may hide a peak.
    pub missing: Vec<u32>,
    /// Speeds that `refine` has added; absent without it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub refinement: Option<Refinement>,
    /// Units of the model.
    pub units: Units,
    /// The whole request as resolved.
    pub settings: SweepRequest,
    /// Version of the code.
    pub version: String,
}

/// One critical speed of the wheel as a whole.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct WheelCriticalSpeed {
    /// Ω of the peak, rad/s.
    pub speed_rad_s: f64,
    /// Index of the speed in the sweep.
    pub index: u32,
    /// Severity by which critical speeds are ranked, half the peak-to-peak displacement of the tip on one scale for all speeds: over the clearance;
    /// if a node has none, over the length of the contact line; for a single contact node, the displacement itself.
    pub severity: f64,
    /// Tip that moves most at the speed.
    pub tip: TipResponse,
    /// Mean sum of all contact forces; absent for scenes without contact.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mean_force: Option<f64>,
    /// Largest sum of all contact forces; absent for scenes without contact.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub peak_force: Option<f64>,
    /// Largest share of its clearance that the outward motion of a node takes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub clearance_consumption: Option<f64>,
    /// Prominence: by how much the level rises above the higher one of the valleys beside the peak.
    pub prominence: f64,
    /// Whether the peak lies at an end of the range or beside a speed without a result.
    pub at_edge: bool,
    /// How far the true peak may be from `speed_rad_s` because only the speeds of the sweep were computed, rad/s; see the critical speeds of the
    /// sensors.
    pub speed_error_rad_s: f64,
    /// Whether the neighbouring speeds resolve the peak.
    pub resolved: bool,
    /// Whether the peak is a maximum on a branch of periodic responses; see the critical speeds of the sensors.
    #[serde(default)]
    pub on_branch: bool,
    /// Estimated relative error of the steady response at this speed; absent without control runs.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub amplitude_error: Option<f64>,
    /// Steady-state verdict of the speed.
    pub settling: Verdict,
    /// Largest utilisation at the peak's speed; absent where no stress was recorded or strengths are not known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub utilisation: Option<f64>,
    /// Whether linear theory holds at the peak's speed; absent for speeds that an earlier version computed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub validity: Option<ValidityVerdict>,
    /// Measures that were not checked for `validity`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub validity_lacking: Vec<ValidityMeasure>,
}

/// Critical speeds that one sensor sees.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct SensorView {
    /// Sensor that was recorded.
    pub sensor: Sensor,
    /// Critical speeds that the sensor sees.
    pub critical_speeds: Vec<CriticalSpeed>,
}
