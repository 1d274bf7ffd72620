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
    /// Where it passes through.
    #[cfg_attr(feature = "schema", schema(min_items = 1, max_items = 1000))]
    pub course: Vec<ClearanceAt>,
    /// Share of the change at every contact node, from -1 to 1; absent: all of it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(feature = "schema", schema(max_items = 8192))]
    pub along_chord: Option<Vec<f64>>,
}

/// A point of the course.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct ClearanceAt {
    /// When, in revolutions from the start: ascending, 0.05 at least from one to the next and to the first.
    pub revolutions: f64,
    /// By how much all clearances are larger then, in the model's unit of length; negative where they are smaller. What goes beyond them
    /// presses into the tips.
    pub change: f64,
}

impl Plain for Option<ClearanceChange> {}
