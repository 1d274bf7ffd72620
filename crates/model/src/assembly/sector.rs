//! Meshed sector: all that its matrices follow from.

use rubmap_solid::frame::{AxisFrame, Basis};
use rubmap_solid::mesh::SectorMesh;
use rubmap_solid::rule::MassRule;

/// Tip node that may touch the casing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TipNode {
    /// Index of the node.
    pub node: usize,
    /// Outward unit normal in (r, θ, z) components at the node.
    pub normal: [f64; 3],
}

/// Mesh of one sector with its materials, supports and contact nodes.
#[derive(Debug, Clone)]
pub struct MeshedSector {
    /// Nodes, elements, materials, axis and cyclic pairs, clamped ones included.
    pub mesh: SectorMesh,
    /// Whether the (r, θ, z) displacements of each node are clamped.
    pub clamped: Vec<[bool; 3]>,
    /// Contact nodes from leading to trailing edge.
    pub contact: Vec<TipNode>,
    /// Rule by which mass is integrated.
    pub mass: MassRule,
}

impl MeshedSector {
    /// Frame of the axis of rotation.
    ///
    /// # Panics
    /// If the mesh's axis has no direction.
    pub(crate) fn axis(&self) -> AxisFrame {
        let (origin, direction) = self.mesh.axis;
        match AxisFrame::new(origin, direction) {
            Some(frame) => frame,
            None => panic!("the axis of a meshed sector has a direction"),
        }
    }

    /// Unit vectors r, θ, z at each node.
    pub(super) fn frames(&self) -> Vec<Basis> {
        let axis = self.axis();
        self.mesh.nodes.iter().map(|&at| axis.cylindrical(axis.coordinates(at)[1])).collect()
    }
}
