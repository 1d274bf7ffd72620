//! A change of clearances, as it is asked for.

use serde::{Deserialize, Serialize};

use crate::effects::asked::Plain;

/// Clearances that close and open during the run, all alike but for `along_chord`: from those of the casing through the points of `course`,
/// smoothly from one to the next, and as at the last one from then on; the window is behind it. Heating takes minutes, which nobody
/// simulates: a course of some tens of revolutions passes through the same clearances, and shows what is left behind.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct ClearanceChange {
    /// Points that the change passes through.
    #[cfg_attr(feature = "schema", schema(min_items = 1, max_items = 1000))]
    pub course: Vec<ClearanceAt>,
    /// Share of the change at every contact node, from -1 to 1; absent: the whole change at all of them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(feature = "schema", schema(max_items = 8192))]
    pub along_chord: Option<Vec<f64>>,
}

/// Point of a change of clearances.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct ClearanceAt {
    /// Time of the point in revolutions from the start: ascending, 0.05 at least from one point to the next and to the first.
    pub revolutions: f64,
    /// Change of all clearances at that time, in the model's unit of length: positive where they are larger, negative where they are smaller. A
    /// change beyond the clearance presses the casing into the tips.
    pub change: f64,
}

impl Plain for Option<ClearanceChange> {}
