//! Contact of one speed: forces per contact node and blade, and how much of the clearance motion takes.

use serde::{Deserialize, Serialize};

use crate::request::SweepRequest;
use rubmap_wheel::dynamics::sector::Units;

/// Contact over the window of one speed, in short. Forces are means over the interval between two samples (`samples_per_revolution`): the force of a
/// single step is an impulse over an arbitrary time.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct ContactSummary {
    /// Mean over the window of the sum of all contact forces on the wheel.
    pub mean_force: f64,
    /// Largest sum of all contact forces on the wheel.
    pub peak_force: f64,
    /// Largest force on one node of one blade.
    pub peak_node_force: f64,
    /// Contact node with the largest force; absent without contact.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub peak_contact_node: Option<u32>,
    /// Blade with the largest force on one node; absent without contact.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub peak_sector: Option<u32>,
    /// Blade with the largest impulse; absent without contact.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub worst_sector: Option<u32>,
    /// Number of times that a gap closes on the wheel, per revolution.
    pub closings_per_revolution: f64,
    /// Largest share of its running clearance that the outward motion of a node takes; 1 reaches the undeformed casing, and is reported for nodes
    /// without clearance and for those that are pressed in.
    pub clearance_consumption: f64,
    /// Contact node with the largest clearance consumption.
    pub clearance_contact_node: u32,
    /// Largest clearance consumption of a linear calculation, which knows no contact: of the steady response to the forces at engine orders; absent
    /// where the scene has none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub linear_clearance_consumption: Option<f64>,
    /// Intervals per revolution over which forces are averaged.
    pub samples_per_revolution: u32,
}

/// Contact over the window of one speed in full, `[sector][contact node]`. Where the scene repeats around the wheel only the sectors of
/// one part are listed: sector s stands for s + part, s + 2·part, …
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct ContactForces {
    /// Largest force, mean over the interval between two samples.
    pub peak_force: Vec<Vec<f64>>,
    /// Contact impulse ∫λ dt of a revolution, force·time.
    pub impulse_per_revolution: Vec<Vec<f64>>,
    /// Share of the steps with a force.
    pub contact_share: Vec<Vec<f64>>,
    /// Number of times that the gap closes in a revolution.
    pub closings_per_revolution: Vec<Vec<f64>>,
    /// Clearance consumption: largest outward displacement along the normal over the node's clearance.
    pub clearance_consumption: Vec<Vec<f64>>,
    /// Clearance consumption of a linear calculation, which knows no contact, `[contact node]`; empty where the scene has no forces at engine orders.
    pub linear_clearance_consumption: Vec<f64>,
}

/// Contact over speed and contact node, as downloaded: the worst blade of every node.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct ForceMap {
    /// Speeds, rad/s.
    pub speeds_rad_s: Vec<f64>,
    /// Contact at each speed; null where that speed is not completed.
    pub rows: Vec<Option<ForceRow>>,
    /// Units of the model.
    pub units: Units,
    /// The whole request as resolved.
    pub settings: SweepRequest,
    /// Version of the code.
    pub version: String,
}

/// Contact at one speed of a [`ForceMap`]; lists are `[contact node]`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct ForceRow {
    /// Contact on the wheel as a whole.
    pub summary: ContactSummary,
    /// Largest force on any blade.
    pub peak_force: Vec<f64>,
    /// Largest impulse per revolution on any blade.
    pub impulse_per_revolution: Vec<f64>,
    /// Blade with the largest impulse; null without contact.
    pub worst_sector: Vec<Option<u32>>,
    /// Largest share of time in contact of any blade.
    pub contact_share: Vec<f64>,
    /// Largest number of closings per revolution of any blade.
    pub closings_per_revolution: Vec<f64>,
    /// Largest clearance consumption of any blade.
    pub clearance_consumption: Vec<f64>,
    /// Clearance consumption of a linear calculation, which knows no contact; empty where the scene has no forces at engine orders.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub linear_clearance_consumption: Vec<f64>,
}
