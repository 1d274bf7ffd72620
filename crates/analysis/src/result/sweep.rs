//! All speeds of a sweep together.

use serde::{Deserialize, Serialize};

use crate::request::Sensor;
use crate::result::errors::ErrorEstimate;
use crate::result::plan::{Estimate, Spent};
use crate::result::point::Point;
use crate::result::reduction::{ReductionReport, StiffeningVerdict};
use crate::result::refinement::Refinement;
use crate::result::validity::{ValidityMeasure, ValidityVerdict};
use rubmap_wheel::dynamics::sector::Units;
use rubmap_wheel::response::campbell::{Crossing, DrivenCrossing};
use rubmap_wheel::response::coincidence::Coincidence;
use rubmap_wheel::response::settling::Verdict;

/// Spectra side by side over Ω, as downloaded.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct InteractionMap {
    /// Speeds, rad/s.
    pub speeds_rad_s: Vec<f64>,
    /// Engine orders of the columns.
    pub engine_orders: Vec<f64>,
    /// Amplitudes, `[speed][engine order]`; a row is null where that speed has no result.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub amplitude: Vec<Option<Vec<f64>>>,
    /// Sensor whose spectra the map shows.
    pub sensor: Sensor,
    /// Nodal diameter that the map is restricted to, if asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub nodal_diameter: Option<u32>,
    /// Units of the model.
    pub units: Units,
    /// Credentials, one per finished speed, in the order of the speeds.
    pub points: Vec<Point>,
    /// The worst verdict on K(Ω) of `points`; absent where none has one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stiffening: Option<StiffeningVerdict>,
    /// Estimated errors of the amplitudes, once the job is successful; absent without control runs.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub errors: Option<ErrorEstimate>,
    /// Speeds that `refine` has added; absent without it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub refinement: Option<Refinement>,
    /// Expected cost of the sweep; absent before its speeds are queued.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub plan: Option<Estimate>,
    /// Cost of the finished speeds.
    #[serde(default)]
    pub spent: Spent,
    /// The whole request as resolved.
    pub settings: crate::request::SweepRequest,
    /// Version of the code.
    pub version: String,
}

/// One critical speed of a sweep: a peak of the steady response over Ω.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct CriticalSpeed {
    /// Ω of the peak, rad/s.
    pub speed_rad_s: f64,
    /// Index of the speed in the sweep.
    pub index: u32,
    /// Whether the peak lies at an end of the range or beside a speed without a result, so that the true peak may be beyond.
    pub at_edge: bool,
    /// How far the true peak may be from `speed_rad_s` because only the speeds of the sweep were computed, rad/s: the distance
    /// to the farther one of the two neighbouring speeds. A speed without a result, like the end of the range, bounds
    /// nothing: with `at_edge` this is the distance to the other neighbour, and the peak may be farther away on the open side.
    pub speed_error_rad_s: f64,
    /// Whether the speeds of the sweep resolve the peak: on both sides the response at the neighbouring speed is at least 90
    /// % of the peak's, from an interval no more than three times as wide as the other; or the neighbouring speed is
    /// within 5e-4 of the peak's, which is then known to that sharpness even where the response jumps (at the fold of a
    /// backbone curve). Otherwise the true peak may be higher. Never with `at_edge`.
    pub resolved: bool,
    /// Whether the peak is a maximum on a branch of periodic responses: the peak and the speeds on both sides were solved for and are stable, and the
    /// neighbours are at least 90 % as high. `refine` then goes on until the peak is known to 1e-5 of its speed. Otherwise the peak is the highest of
    /// the speeds.
    #[serde(default)]
    pub on_branch: bool,
    /// Steady response: root mean square about the mean, in the model's unit of length.
    pub rms: f64,
    /// Half the peak-to-peak displacement at the peak.
    pub half_peak_to_peak: f64,
    /// Prominence: height above the higher of the two neighbouring valleys, in the same measure as `rms`.
    pub prominence: f64,
    /// How far the error of the natural frequencies may have moved the peak, rad/s: the largest relative difference of the reduced
    /// sector's ten lowest ones of any nodal diameter from the full sector's, times the speed.
    #[serde(default)]
    pub frequency_error_rad_s: f64,
    /// Estimated relative error of the steady response at this speed; absent without control runs.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub amplitude_error: Option<f64>,
    /// Engine order of the largest spectral amplitude; absent where no line up to `max_engine_order` stands above round-off.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub dominant_engine_order: Option<f64>,
    /// Nodal diameter that carries the dominant engine order; absent without one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub dominant_nodal_diameter: Option<u32>,
    /// Steady-state verdict of the peak's speed.
    pub settling: Verdict,
    /// Nearest prediction of the linear criterion.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub nearest_crossing: Option<Crossing>,
    /// Peak speed minus the nearest prediction's, rad/s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub distance_rad_s: Option<f64>,
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

/// Critical speeds of a sweep beside the linear prediction.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct CriticalSpeeds {
    /// The sensor whose response is judged.
    pub sensor: Sensor,
    /// Peaks in ascending speed.
    pub critical_speeds: Vec<CriticalSpeed>,
    /// All crossings of the first two families and n = 1, 2, 3 within the sweep's range.
    pub linear_crossings: Vec<Crossing>,
    /// Crossings that the lobes can drive.
    pub driven_crossings: Vec<DrivenCrossing>,
    /// Coincidences of travelling waves of the wheel with those of an elastic casing; absent where the casing is rigid.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub casing_coincidences: Vec<Coincidence>,
    /// Indices of the speeds that gave no amplitude.
    pub missing: Vec<u32>,
    /// Speeds that `refine` has added; absent without it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub refinement: Option<Refinement>,
    /// Expected cost of the sweep.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub plan: Option<Estimate>,
    /// Cost of the finished speeds of the sweep.
    #[serde(default)]
    pub spent: Spent,
    /// Report of the reduction: what it found about the model.
    pub reduction: ReductionReport,
    /// The whole request as resolved.
    pub settings: crate::request::SweepRequest,
    /// Units of the model.
    pub units: Units,
    /// Version of the code.
    pub version: String,
}
