//! Accuracy or budget, asked for in place of knobs.

use serde::{Deserialize, Serialize};

/// An accuracy to reach.
///
/// For a sweep: the error of the steady response at the pilot speeds, unless `of` says otherwise, that is the largest over the sensors of the error
/// of its root mean square and, where trajectories can be compared, of the error of its lines at integer engine orders (root of the sum of squares),
/// both relative to the largest sensor's. For a modal analysis: the largest relative error of the ten lowest natural frequencies of any nodal
/// diameter.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct Accuracy {
    /// Relative error to stay below.
    #[cfg_attr(feature = "schema", schema(minimum = 1e-9, maximum = 0.5))]
    pub target: f64,
    /// Quantity of a sweep whose error is meant.
    #[serde(default, skip_serializing_if = "AccuracyOf::is_response")]
    pub of: AccuracyOf,
    /// Longest wall time of the choice, s: reductions that are not stored and pilot runs. A job that has not chosen by then fails; the next one with
    /// the same scene goes on from what was computed.
    #[serde(default = "an_hour")]
    #[cfg_attr(feature = "schema", schema(default = 3600.0, minimum = 1.0, maximum = 1e7))]
    pub seconds: f64,
}

/// Default time for a choice, s: long enough for a climb on a sector of 120,000 DOF, short enough to be waited for.
fn an_hour() -> f64 {
    3600.0
}

/// Quantity whose error is to stay below a target.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(rename_all = "snake_case")]
pub enum AccuracyOf {
    /// Steady response at the sensors.
    #[default]
    Response,
    /// Largest von Mises stress over the last revolution, which converges more slowly with the modes; needs `record.stress`.
    Stress,
}

impl AccuracyOf {
    fn is_response(&self) -> bool {
        *self == Self::Response
    }
}

/// Budget of time to keep to.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct Budget {
    /// Wall time of the whole job on an otherwise idle machine, s: reductions that are not stored, pilot runs, all speeds and
    /// those that are simulated again.
    #[cfg_attr(feature = "schema", schema(minimum = 1.0, maximum = 1e7))]
    pub seconds: f64,
}
