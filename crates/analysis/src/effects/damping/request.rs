//! Modal damping, as it is asked for.

use serde::{Deserialize, Serialize};

use crate::effects::asked::Plain;
use crate::request::families::FamiliesBy;

/// Modal damping of the reduced wheel.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct Damping {
    /// Ratio ζ of every mode not listed in `family_ratios`; 0 ≤ ζ < 1.
    pub modal_ratio: f64,
    /// Ratios of the first modal families, the same in every nodal diameter.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[cfg_attr(feature = "schema", schema(max_items = 100))]
    pub family_ratios: Vec<f64>,
    /// Meaning of a family in `family_ratios`.
    #[serde(default, skip_serializing_if = "FamiliesBy::is_shape")]
    pub families_by: FamiliesBy,
}

impl Plain for Option<Damping> {}
