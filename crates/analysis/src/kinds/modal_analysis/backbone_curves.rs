//! Backbone curves, as a result.

use serde::{Deserialize, Serialize};

use crate::request::Component;
use rubmap_wheel::dynamics::sector::Units;

/// Backbone curves of a modal analysis.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct Backbones {
    /// Speed Ω, rad/s.
    pub speed_rad_s: f64,
    /// Number of coordinates of a blade.
    pub coordinates: u32,
    /// Curves in ascending nodal diameter and family.
    pub curves: Vec<BackboneCurve>,
    /// Units of the model.
    pub units: Units,
    /// Id of the model.
    pub model: String,
    /// Version of the code.
    pub version: String,
}

/// Backbone curve of a mode, without damping, contact and Coriolis forces: of a wave that travels, or stands where the nodal diameter is single.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct BackboneCurve {
    /// Nodal diameter i.
    pub nodal_diameter: u32,
    /// Modal family, from 1.
    pub family: u32,
    /// Contact node that moves most in the mode.
    pub contact_node: u32,
    /// Component in which it moves most.
    pub component: Component,
    /// Share of the displacement of the contact nodes in the mode that the coordinates do not carry: it stays linear, so that a curve of which much is
    /// outside changes too little, and one with more than a third is not followed.
    pub outside_coordinates: f64,
    /// Points in ascending amplitude, the first without motion.
    pub points: Vec<BackbonePoint>,
    /// Resonances with other modes that the curve went past between two of its points.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub passed: Vec<String>,
    /// Whether the largest amplitude was reached.
    pub complete: bool,
    /// Reason for the end of the curve.
    pub end: String,
}

/// Point of a backbone curve.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct BackbonePoint {
    /// Displacement of the contact node in its component by the mode itself, at the frequency of the point.
    pub amplitude: f64,
    /// Frequency, Hz.
    pub frequency_hz: f64,
    /// Change of the frequency from that without motion, per cent.
    pub change_percent: f64,
    /// Change of the frequency by the second half of the harmonics, per cent: the error by those left out is smaller.
    pub harmonics_percent: f64,
}
