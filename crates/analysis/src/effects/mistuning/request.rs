//! Mistuning, as it is asked for.

use serde::{Deserialize, Serialize};

/// Relative stiffness deviations of the sectors: given as `deviations`, or drawn with `spread` and `seed`. Twice the relative
/// deviation of a blade's frequency; within each modal family, the modes of one rank at the speed of the run (Feiner and Griffin,
/// J. Turbomachinery 124, 2002).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct Mistuning {
    /// δ of every sector, at most 0.25 either way: its stiffness is (1 + δ) times that of the tuned wheel.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub deviations: Option<Vec<f64>>,
    /// Standard deviation of normally distributed δ, 0 to 0.1; machined blades scatter by 0.01 to 0.04.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub spread: Option<f64>,
    /// Seed of the distribution; the same seed gives the same wheel.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub seed: Option<u64>,
}
