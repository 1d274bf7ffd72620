//! Forces at engine orders, as they are asked for.

use serde::{Deserialize, Serialize};

use crate::effects::asked::Plain;
use crate::request::sensor::Component;

/// Force A cos(k(φ + Ωt) + phase) on contact nodes of every sector, φ being the sector's angle, as a wheel feels it that turns through a steady field
/// of k periods. The force grows over `ramp_revolutions`, like the restriction.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct EngineOrderExcitation {
    /// Engine order k, 1 to the request's `max_engine_order`.
    #[cfg_attr(feature = "schema", schema(minimum = 1, maximum = 1000))]
    pub order: u32,
    /// Contact nodes, counted from the leading edge from 0; each gets the whole amplitude.
    #[cfg_attr(feature = "schema", schema(min_items = 1, max_items = 8192))]
    pub contact_nodes: Vec<u32>,
    /// Direction of the force.
    pub component: Component,
    /// Amplitude A, force.
    pub amplitude: f64,
    /// Phase of the force, rad.
    #[serde(default)]
    pub phase_rad: f64,
}

impl Plain for Vec<EngineOrderExcitation> {}
