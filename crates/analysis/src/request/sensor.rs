//! Where responses are recorded.

use serde::{Deserialize, Serialize};

/// A displacement recorded during a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct Sensor {
    /// Contact node, counted from the leading edge from 0.
    pub contact_node: u32,
    /// Sector, counted from 0.
    #[serde(default)]
    pub sector: u32,
    /// Displacement component.
    pub component: Component,
}

/// Displacement component at a contact node.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(rename_all = "snake_case")]
pub enum Component {
    /// Outward from the axis.
    Radial,
    /// Towards +θ, the direction of rotation.
    Tangential,
    /// Along the axis.
    Axial,
    /// Along the node's outward contact normal.
    Normal,
}
