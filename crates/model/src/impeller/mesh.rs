//! Hexahedral mesh of one sector and its connection to the rest of the wheel.

use rubmap_solid::element::ElementKind;
use rubmap_solid::mesh::{Element, ElementSet, SectorMesh as SolidMesh};
use rubmap_solid::rule::MassRule;
use serde::{Deserialize, Serialize};

use super::material::Material;
use crate::assembly::{MeshedSector, TipNode};

/// Name of the only element set.
const SET: &str = "WHEEL";

/// Nodes and hexahedra, in Cartesian coordinates; z is the axis of rotation.
#[derive(Debug, Clone, Default)]
pub struct HexMesh {
    /// Cartesian positions of the nodes.
    pub nodes: Vec<[f64; 3]>,
    /// Hexahedra of one order.
    pub elements: Elements,
}

/// Node indices of each element. Corners first: the face ζ = −1 counter-clockwise seen from inside, then the face ζ = +1, as in CalculiX's
/// C3D8 and C3D20.
#[derive(Debug, Clone)]
pub enum Elements {
    /// 8-node hexahedra.
    Linear(Vec<[usize; 8]>),
    /// 20-node serendipity hexahedra: the mid-edge nodes follow the corners in the order of
    /// [`EDGES`](rubmap_solid::natural::EDGES).
    Quadratic(Vec<[usize; 20]>),
}

impl Default for Elements {
    fn default() -> Self {
        Self::Linear(Vec::new())
    }
}

impl Elements {
    /// Number of elements.
    pub fn len(&self) -> usize {
        match self {
            Self::Linear(elements) => elements.len(),
            Self::Quadratic(elements) => elements.len(),
        }
    }

    /// Whether there are no elements.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Nodes of an element, corners first: 8 or 20.
    pub fn nodes_of(&self, element: usize) -> &[usize] {
        match self {
            Self::Linear(elements) => &elements[element],
            Self::Quadratic(elements) => &elements[element],
        }
    }
}

/// Order of the displacement functions of a mesh's hexahedra.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(rename_all = "snake_case")]
pub enum ElementOrder {
    /// 8-node hexahedra with incompatible modes: for coarse meshes.
    #[default]
    Linear,
    /// 20-node serendipity hexahedra.
    Quadratic,
}

impl ElementOrder {
    /// Half-index in the middle of `elements` elements; if there is no node, that of the corner before it.
    pub(super) fn middle(self, elements: usize) -> usize {
        match self {
            Self::Linear => elements / 2 * 2,
            Self::Quadratic => elements,
        }
    }

    /// Whether a point of the grid of half-indices is a node: corners, and middles of edges if quadratic.
    pub(super) fn has_node(self, half: [usize; 3]) -> bool {
        let odd = half.iter().filter(|h| *h % 2 == 1).count();
        match self {
            Self::Linear => odd == 0,
            Self::Quadratic => odd <= 1,
        }
    }
}

/// Mesh of one sector with its supports, its cyclic faces and its contact nodes.
#[derive(Debug, Clone)]
pub struct SectorMesh {
    /// Number N of sectors in the wheel.
    pub sectors: usize,
    /// Nodes and elements.
    pub mesh: HexMesh,
    /// Whether the (r, θ, z) displacements of each node are clamped.
    pub clamped: Vec<[bool; 3]>,
    /// Pairs (low node, high node); the high node is the low node turned by +2π/N.
    pub cyclic: Vec<(usize, usize)>,
    /// Contact nodes from leading to trailing edge.
    pub contact: Vec<TipNode>,
}

impl HexMesh {
    /// Corner positions of an element.
    pub fn corners(&self, element: usize) -> [[f64; 3]; 8] {
        let nodes = self.elements.nodes_of(element);
        std::array::from_fn(|corner| self.nodes[nodes[corner]])
    }

    /// Angle θ of a node about the z axis; 0 on the axis.
    pub fn angle(&self, node: usize) -> f64 {
        let [x, y, _] = self.nodes[node];
        y.atan2(x)
    }

    /// Positions of an element's nodes.
    pub fn positions<const N: usize>(&self, nodes: &[usize; N]) -> [[f64; 3]; N] {
        nodes.map(|node| self.nodes[node])
    }
}

impl SectorMesh {
    /// Sector of one material; ids of nodes and elements count from 1.
    pub fn made_of(&self, material: &Material) -> MeshedSector {
        let elements = &self.mesh.elements;
        let kind = match elements {
            Elements::Linear(_) => ElementKind::QM6,
            Elements::Quadratic(_) => ElementKind::C3D20,
        };
        let element = |e: usize| Element {
            id: e as u64 + 1,
            kind,
            set: 0,
            nodes: elements.nodes_of(e).iter().map(|&node| node as u32).collect(),
        };
        let mesh = SolidMesh {
            sectors: self.sectors,
            node_ids: (1..=self.mesh.nodes.len() as u64).collect(),
            nodes: self.mesh.nodes.clone(),
            axis: ([0.0; 3], [0.0, 0.0, 1.0]),
            cyclic: self.cyclic.iter().map(|&(low, high)| (low as u32, high as u32)).collect(),
            elements: (0..elements.len()).map(element).collect(),
            sets: vec![ElementSet { name: SET.to_owned(), material: material.to_solid() }],
        };
        MeshedSector {
            mesh,
            clamped: self.clamped.clone(),
            contact: self.contact.clone(),
            mass: MassRule::Consistent,
        }
    }
}
