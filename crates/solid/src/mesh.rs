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
    /// Their positions.
    pub nodes: Vec<[f64; 3]>,
    /// The axis of rotation: a point on it, and its unit vector.
    pub axis: ([f64; 3], [f64; 3]),
    /// Pairs (low node, high node) of places in `nodes`, clamped ones included: the high node is the low node turned by 2π/N.
    pub cyclic: Vec<(u32, u32)>,
    /// The elements.
    pub elements: Vec<Element>,
    /// What they are made of.
    pub sets: Vec<ElementSet>,
}

/// A finite element.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Element {
    /// Its number in the user's model.
    pub id: u64,
    /// What it is.
    pub kind: ElementKind,
    /// Place of its set in [`SectorMesh::sets`].
    pub set: u32,
    /// Places of its nodes in [`SectorMesh::nodes`], in CalculiX's order.
    pub nodes: Vec<u32>,
}

/// Elements of one material.
#[derive(Debug, Clone, PartialEq)]
pub struct ElementSet {
    /// Its name in the user's model.
    pub name: String,
    /// What its elements are made of.
    pub material: Material,
}

impl SectorMesh {
    /// Positions of an element's nodes.
    pub fn positions(&self, element: &Element) -> Vec<[f64; 3]> {
        element.nodes.iter().map(|&node| self.nodes[node as usize]).collect()
    }
}
