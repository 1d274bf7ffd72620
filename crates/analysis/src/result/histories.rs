//! Histories of one speed, sample by sample.

use serde::{Deserialize, Serialize};

use crate::request::{Sensor, SweepRequest};
use crate::result::point::Point;
use rubmap_wheel::dynamics::sector::Units;
use rubmap_wheel::dynamics::states::WheelStates;

/// Histories of one speed over chosen revolutions, as downloaded. Sample j = 0, 1, … is at `revolutions[0]` + (j + 1) / `samples_per_revolution`
/// revolutions after the start. Histories that were not asked for are empty or absent.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct SpeedHistories {
    /// Index of the speed in the request.
    pub index: u32,
    /// Rotational speed Ω, rad/s.
    pub speed_rad_s: f64,
    /// Samples per revolution.
    pub samples_per_revolution: u32,
    /// Whole revolutions after which recording begins and ends.
    pub revolutions: [u32; 2],
    /// Histories of the sensors, in the order of the request.
    pub sensors: Vec<SensorHistory>,
    /// History of the contact; absent where nothing may touch.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub contact: Option<ContactHistory>,
    /// History of the energy of the whole wheel.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub energy: Option<EnergyHistory>,
    /// Credentials of the run.
    pub point: Point,
    /// Units of the model.
    pub units: Units,
    /// The whole request as resolved.
    pub settings: SweepRequest,
    /// Version of the code.
    pub version: String,
    /// States of the whole wheel, if they were asked for; stored apart from the rest.
    #[serde(skip)]
    pub states: Option<Box<WheelStates>>,
}

/// History of one sensor, `[sample]`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct SensorHistory {
    /// Sensor that was recorded.
    pub sensor: Sensor,
    /// Place where the sensor's node meets the casing; absent for a node that is not on the contact line, for a sensor that does not measure along
    /// its outward normal, and without a casing.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tip: Option<TipPlace>,
    /// Displacement, length.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub displacement: Vec<f64>,
    /// Velocity, length/time.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub velocity: Vec<f64>,
}

/// Place of a node of the contact line before the casing.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct TipPlace {
    /// Angle of the node from the package's x axis at the start of a revolution, rad: its own angle and that of its sector together.
    pub angle_rad: f64,
    /// Clearance of the node at this speed, length; where the scene changes its clearances, the last one.
    pub clearance: f64,
    /// Height of the fully grown casing inward of its clearance before the node, length, at 720 equal angles of the fixed frame from the package's x
    /// axis on; absent for a circular casing.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub heights: Vec<f64>,
}

/// Contact between the blades and the casing. All numbers of a sample are means over the interval since the sample before, so that their
/// sums are integrals over time.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct ContactHistory {
    /// Contact force, `[sector][contact node][sample]`. Where the scene repeats around the wheel, the sectors of one part.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub force: Vec<Vec<Vec<f64>>>,
    /// Number of contact nodes of the wheel that touch, `[sample]`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub nodes_in_contact: Vec<f64>,
    /// Length of the contact lines of all blades that touches, `[sample]`: every node stands for half the way to its neighbours.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub contact_length: Vec<f64>,
}

/// Energy balance since the start of the run, `[sample]`, force·length: mechanical = initial + all works − all losses. Lists of effects that the
/// scene does not name are empty.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct EnergyHistory {
    /// Mechanical energy at the start of the run, of wheel and elastic casing.
    pub initial: f64,
    /// Mechanical energy at the samples, of wheel and elastic casing.
    pub mechanical: Vec<f64>,
    /// Work of the contact forces on the wheel.
    pub contact_work: Vec<f64>,
    /// Energy lost to modal damping, and to modes that respond quasi-statically.
    pub damping_loss: Vec<f64>,
    /// Work of the forces at engine orders.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub excitation_work: Vec<f64>,
    /// Work of mistuning: minus the change of the energy that the stiffness deviations store.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub mistuning_work: Vec<f64>,
    /// Work of blades that stiffen as they bend: minus the change of their energy beyond the quadratic one.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub bending_work: Vec<f64>,
    /// Work of the contact forces on the elastic casing.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub casing_work: Vec<f64>,
    /// Energy lost in the casing's damping.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub casing_loss: Vec<f64>,
    /// Heat of friction; its work on the vibration is part of the work of contact.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub friction_heat: Vec<f64>,
}
