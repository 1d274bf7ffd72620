//! What `refine` has added to a sweep.

use serde::{Deserialize, Serialize};

/// What `refine` has added to a sweep.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct Refinement {
    /// Speeds added.
    pub added: u32,
    /// Rounds in which they were.
    pub rounds: u32,
    /// Whether every critical speed, of any sensor, is resolved. False while the job runs.
    pub complete: bool,
    /// The critical speeds that are not, sensor by sensor in ascending speed; left out while the job runs.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub unresolved: Vec<Unresolved>,
}

/// A critical speed that `refine` leaves unresolved.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct Unresolved {
    /// Index of the sensor in the request.
    pub sensor: u32,
    /// Ω of the peak, rad/s.
    pub speed_rad_s: f64,
    /// Why.
    pub reason: Unresolvable,
}

/// Why a critical speed stays unresolved.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(rename_all = "snake_case")]
pub enum Unresolvable {
    /// It lies at an end of the range, beyond which the response may rise further: ask for a wider range.
    EndOfRange,
    /// It lies beside a speed without a result, as close to it as would resolve a peak.
    BesideMissing,
    /// As many speeds were added as may be, or there is no number between the speeds.
    TooCoarse,
}
