//! Positions of the nodes of a sector, from which its sections are drawn.

use serde::{Deserialize, Serialize};

use rubmap_wheel::dynamics::sector::Units;

/// A sector as its package places it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct SectorGeometry {
    /// Free text of the user.
    pub name: String,
    /// Number N of identical sectors in the wheel.
    pub sectors: u32,
    /// Units of the model.
    pub units: Units,
    /// Nodes of the sector, those of the contact line among them, in no particular order.
    pub nodes: Vec<SectorNode>,
    /// Contact line, from the leading to the trailing edge.
    pub contact: Vec<ContactPlace>,
    /// Closed lines `[z, r]` around the area that the elements cover when they are turned into one plane; absent without elements.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub silhouette: Vec<Vec<[f64; 2]>>,
    /// Closed lines `[z, r]` around the low cyclic face, turned into the same plane: the wheel without its blades; absent without elements.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub disk: Vec<Vec<[f64; 2]>>,
}

/// A node of the sector.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct SectorNode {
    /// Node id in the user's model.
    pub id: u64,
    /// Part of the sector that the node belongs to.
    pub kind: NodeKind,
    /// Position `[r, θ, z]`: radius, angle in rad, axial coordinate.
    pub position: [f64; 3],
}

/// Part of its sector that a node belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(rename_all = "snake_case")]
pub enum NodeKind {
    /// Node inside the sector, or on a free surface.
    Internal,
    /// Node on the low cyclic face.
    Low,
    /// Node on the high cyclic face, where the next sector begins.
    High,
    /// Node on the contact line.
    Contact,
    /// Clamped node: all its displacements are zero.
    Clamped,
}

/// A node of the contact line.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
pub struct ContactPlace {
    /// Node id in the user's model.
    pub id: u64,
    /// Position `[r, θ, z]`: radius, angle in rad, axial coordinate.
    pub position: [f64; 3],
    /// Unit normal out of the blade into the casing, (r, θ, z) components.
    pub normal: [f64; 3],
    /// Distance of the casing along the normal at rest, length; absent where no scene gives it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub clearance: Option<f64>,
    /// Height of the casing inward of its clearance before the node, length, at 720 equal angles of the fixed frame from the package's x axis on;
    /// absent for a circular casing.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub heights: Vec<f64>,
}
