//! What is asked for in place of knobs: an accuracy, or a budget.

use serde::{Deserialize, Serialize};

/// An accuracy to reach.
///
/// Of a sweep: the error of the steady response at the pilot speeds, unless `of` says otherwise, that is the largest over the sensors of the error of its root
/// mean square and, where trajectories can be compared, of the error of its lines at integer engine orders (root of the sum of
/// squares), both relative to the largest sensor's. Of a modal analysis: the largest relative error of the ten lowest natural
/// frequencies of any nodal diameter.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct Accuracy {
    /// Relative error.
    #[cfg_attr(feature = "schema", schema(minimum = 1e-9, maximum = 0.5))]
    pub target: f64,
    /// Of a sweep: whose error it is.
    #[serde(default, skip_serializing_if = "AccuracyOf::is_response")]
    pub of: AccuracyOf,
    /// Wall time of the choice at most, s: reductions that are not stored and pilot runs. What is not chosen by then fails the job; the
    /// next one with the same scene goes on from what was computed.
    #[serde(default = "an_hour")]
    #[cfg_attr(feature = "schema", schema(default = 3600.0, minimum = 1.0, maximum = 1e7))]
    pub seconds: f64,
}

/// Long enough for a climb on a sector of 120,000 DOF, short enough to be waited for.
fn an_hour() -> f64 {
    3600.0
}

/// Whose error is to stay below a target.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(rename_all = "snake_case")]
pub enum AccuracyOf {
    /// The steady response at the sensors.
    #[default]
    Response,
    /// The largest von Mises stress over the last revolution, which converges more slowly with the modes; needs `record.stress`.
    Stress,
}

impl AccuracyOf {
    fn is_response(&self) -> bool {
        *self == Self::Response
    }
}

/// A time to keep.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct Budget {
    /// Wall time of the whole job on an otherwise idle machine, s: reductions that are not stored, pilot runs, all speeds and
    /// those that are simulated again.
    #[cfg_attr(feature = "schema", schema(minimum = 1.0, maximum = 1e7))]
    pub seconds: f64,
}
