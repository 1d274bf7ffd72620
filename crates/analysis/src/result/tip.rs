//! Motion of the blade tips.

use serde::{Deserialize, Serialize};

use crate::request::Component;

/// The tip that moves most over the window: of all components (radial, tangential, axial) of all contact nodes of all blades.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct TipResponse {
    /// Largest root mean square of a component about its mean, from some 128 instants of a revolution.
    pub rms: f64,
    /// Half the peak-to-peak displacement of the component with the largest root mean square, from the instants of `rms`.
    pub half_peak_to_peak: f64,
    /// Largest half peak-to-peak displacement of all components of all tips; absent where it is `half_peak_to_peak`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub largest_half_peak_to_peak: Option<f64>,
    /// Contact node of the tip.
    pub contact_node: u32,
    /// Blade of the tip; in a scene that repeats around the wheel, one of those that move alike.
    pub sector: u32,
    /// Component that moves most.
    pub component: Component,
    /// Half the peak-to-peak displacement over the clearance of the node; absent where nothing can be touched, or without clearance.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub over_clearance: Option<f64>,
    /// Half the peak-to-peak displacement over the length of the contact line; absent for a single node.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub over_chord: Option<f64>,
}

impl TipResponse {
    /// Largest half peak-to-peak displacement of all components of all tips, which limits are held against.
    pub fn peak_motion(&self) -> f64 {
        self.largest_half_peak_to_peak.unwrap_or(self.half_peak_to_peak)
    }
}
