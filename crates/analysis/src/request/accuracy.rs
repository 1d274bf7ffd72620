//! What is asked for in place of knobs: an accuracy, or a budget.

use serde::{Deserialize, Serialize};

/// An accuracy to reach.
///
/// Of a sweep: the error of the steady response at the pilot speeds, that is the largest over the sensors of the error of its root
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
