//! The asymmetry to start from, as it is asked for.

use serde::{Deserialize, Serialize};

use crate::effects::asked::Plain;

/// The asymmetry that `symmetry: probe` starts from.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields, default)]
pub struct Probe {
    /// Its displacement relative to the smallest clearance, 1e-12 to 1e-3.
    pub amplitude: f64,
    /// Seed of its phases.
    pub seed: u64,
}

impl Default for Probe {
    fn default() -> Self {
        Self { amplitude: 1e-6, seed: 0 }
    }
}

impl Plain for Option<Probe> {}
