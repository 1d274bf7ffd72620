//! The mesh of one sector.

use crate::element::ElementKind;
use crate::material::Material;

/// Nodes and elements of one sector, in the user's Cartesian coordinates.
#[derive(Debug, Clone, PartialEq)]
pub struct SectorMesh {
    /// Number N of sectors in the wheel.
    pub sectors: usize,
    /// Ids of the nodes in the user's model, in the order of its node table.
    pub node_ids: Vec<u64>,
    /// Positions of the nodes.
    pub nodes: Vec<[f64; 3]>,
    /// Axis of rotation: a point on it, and its unit vector.
    pub axis: ([f64; 3], [f64; 3]),
    /// Pairs (low node, high node) of places in `nodes`, clamped ones included: the high node is the low node turned by 2π/N.
    pub cyclic: Vec<(u32, u32)>,
    /// Elements of the sector.
    pub elements: Vec<Element>,
    /// Sets of elements, each of one material.
    pub sets: Vec<ElementSet>,
}

/// Finite element.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Element {
    /// Number of the element in the user's model.
    pub id: u64,
    /// Kind of the element.
    pub kind: ElementKind,
    /// Index of the element's set in [`SectorMesh::sets`].
    pub set: u32,
    /// Indices of the element's nodes in [`SectorMesh::nodes`], in CalculiX's order.
    pub nodes: Vec<u32>,
}

/// Elements of one material.
#[derive(Debug, Clone, PartialEq)]
pub struct ElementSet {
    /// Name of the set in the user's model.
    pub name: String,
    /// Material of the set's elements.
    pub material: Material,
}

impl SectorMesh {
    /// Positions of an element's nodes.
    pub fn positions(&self, element: &Element) -> Vec<[f64; 3]> {
        element.nodes.iter().map(|&node| self.nodes[node as usize]).collect()
    }
}
