//! Operation of a machine and the limits that it must keep: what the verdict of a sweep is measured by.

use serde::{Deserialize, Serialize};

use crate::request::speeds::SpeedUnit;

/// Operation of the machine.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct Operation {
    /// Ranges of speed in which the machine runs.
    #[cfg_attr(feature = "schema", schema(min_items = 1, max_items = 100))]
    pub ranges: Vec<OperatingRange>,
}

/// Range of speed in which the machine runs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct OperatingRange {
    /// Name of the range, unlike that of any other.
    #[cfg_attr(feature = "schema", schema(max_length = 100))]
    pub name: String,
    /// Lowest speed of the range.
    pub from: f64,
    /// Highest speed of the range.
    pub to: f64,
    /// Unit of `from` and `to`.
    pub unit: SpeedUnit,
    /// Asked distance of critical speeds from the ends of the range, in per cent of the end's speed. Limits count within it as they do inside the
    /// range.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(feature = "schema", schema(minimum = 0, maximum = 100))]
    pub separation_percent: Option<f64>,
}

/// Limits that the response must keep; none has a default.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct Limits {
    /// Share of its running clearance that the outward displacement of a tip may take (`contact.clearance_consumption` of a speed); at 1 it
    /// reaches the round casing.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub clearance_consumption: Option<f64>,
    /// Half the peak-to-peak displacement that any tip may have, in the model's unit of length.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tip_motion: Option<f64>,
    /// Utilisation of the material, of which nothing is left at 1; asks for `record.stress`, and needs strengths in the model.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub utilisation: Option<f64>,
    /// Largest contact force on one node of one blade, in the model's unit of force, as a mean over the interval between two samples.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub node_force: Option<f64>,
}
