//! Asymmetry to start from, as it is asked for.

use serde::{Deserialize, Serialize};

use crate::effects::asked::Plain;

/// Asymmetry that `symmetry: probe` starts from.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields, default)]
pub struct Probe {
    /// Displacement of the asymmetry relative to the smallest clearance, 1e-12 to 1e-3.
    pub amplitude: f64,
    /// Seed of the phases of the asymmetry.
    pub seed: u64,
}

impl Default for Probe {
    fn default() -> Self {
        Self { amplitude: 1e-6, seed: 0 }
    }
}

impl Plain for Option<Probe> {}
