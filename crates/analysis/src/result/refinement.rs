//! Refinement of a sweep around its critical speeds.

use serde::{Deserialize, Serialize};

/// Refinement of a sweep: the speeds that `refine` has added, and the critical speeds that it leaves unresolved.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct Refinement {
    /// Number of speeds added.
    pub added: u32,
    /// Number of rounds in which speeds were added.
    pub rounds: u32,
    /// Whether every critical speed, of the wheel and of any sensor, is resolved. False while the job runs.
    pub complete: bool,
    /// Critical speeds that are not resolved, those of the wheel first, then sensor by sensor, in ascending speed; left out while the job runs.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub unresolved: Vec<Unresolved>,
}

/// A critical speed that `refine` leaves unresolved.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct Unresolved {
    /// Index of the sensor in the request; absent for a critical speed of the wheel.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sensor: Option<u32>,
    /// Ω of the peak, rad/s.
    pub speed_rad_s: f64,
    /// Reason for which the critical speed stays unresolved.
    pub reason: Unresolvable,
}

/// Reason for which a critical speed stays unresolved.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(rename_all = "snake_case")]
pub enum Unresolvable {
    /// Peak at an end of the range, beyond which the response may rise further: ask for a wider range.
    EndOfRange,
    /// Peak beside a speed without a result, as close to it as would resolve a peak.
    BesideMissing,
    /// Speeds too coarse: as many were added as may be, or there is no number between them.
    TooCoarse,
}
