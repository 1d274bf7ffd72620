//! Level of the whole wheel over speed, with the verdict that it leads to.

use serde::{Deserialize, Serialize};

use crate::result::point::PointStatus;
use crate::result::verdict::{LimitKind, Standing, SweepVerdict};

/// Level of the wheel over speed, over all contact nodes, components and blades, beside the verdict on the sweep.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct SweepLevel {
    /// Verdict on the sweep, with its ranges, limits and critical speeds.
    pub verdict: SweepVerdict,
    /// Finished speeds, slowest first.
    pub speeds: Vec<LevelSpeed>,
}

/// Level of the wheel at one speed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct LevelSpeed {
    /// Index of the speed in the sweep.
    pub index: u32,
    /// Rotational speed, rad/s.
    pub speed_rad_s: f64,
    /// How the run ended; only completed speeds have values.
    pub status: PointStatus,
    /// Values of the speed that are known, limited or not.
    pub values: Vec<LevelValue>,
}

/// Value of one quantity at a speed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct LevelValue {
    /// Quantity.
    pub quantity: LimitKind,
    /// Value at the speed.
    pub value: f64,
    /// Error v·e of the value v, which lies between v/(1 + e) and v (1 + e); absent where no control run gives an error.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub error: Option<f64>,
    /// Standing against the limit of the request; absent where it gives none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub standing: Option<Standing>,
}

impl LevelSpeed {
    /// Value of a quantity, if it is known.
    pub fn value(&self, quantity: LimitKind) -> Option<&LevelValue> {
        self.values.iter().find(|value| value.quantity == quantity)
    }
}

impl SweepLevel {
    /// Limit of the request for a quantity.
    pub fn limit(&self, quantity: LimitKind) -> Option<f64> {
        quantity.limit(&self.verdict.settings.limits?)
    }

    /// Quantity that decides: the limited one whose worst value in a range is of most concern; the tip motion where nothing is limited.
    pub fn deciding(&self) -> LimitKind {
        let worst = self.verdict.ranges.iter().flat_map(|range| &range.limits).map(|worst| &worst.judged);
        worst.max_by(|a, b| a.concern(b)).map_or(LimitKind::TipMotion, |judged| judged.limit)
    }
}
