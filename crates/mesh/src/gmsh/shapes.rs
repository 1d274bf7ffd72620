//! Types of elements by Gmsh's numbers, and its order of the nodes on edges.

use rubmap_solid::element::ElementKind;
use rubmap_solid::topology::Topology;

use crate::error::MeshProblem;

/// Type of element.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Shape {
    /// Number of nodes.
    pub(super) nodes: usize,
    /// Dimension.
    pub(super) dimension: u64,
    /// Kind of a solid element; none of those that are left out.
    pub(super) solid: Option<ElementKind>,
}

impl Shape {
    /// Shape of a type.
    pub(super) fn of(number: i64) -> Result<Self, MeshProblem> {
        if let Some(&(_, kind)) = SOLIDS.iter().find(|(solid, _)| *solid == number) {
            return Ok(Self { nodes: kind.nodes(), dimension: 3, solid: Some(kind) });
        }
        let (dimension, nodes) = if number == 15 {
            (0, 1)
        } else if let Some(nodes) = nodes_of(number, &LINES) {
            (1, nodes)
        } else if let Some(nodes) = nodes_of(number, &TRIANGLES).or(nodes_of(number, &QUADRANGLES)) {
            (2, nodes)
        } else {
            return Err(refused(number));
        };
        Ok(Self { nodes, dimension, solid: None })
    }

    /// Name of a type that is left out, such as `3-node triangle`.
    pub(super) fn name(self, number: i64) -> String {
        match self.dimension {
            0 => "point".to_owned(),
            1 => format!("{}-node line", self.nodes),
            _ if nodes_of(number, &TRIANGLES).is_some() => format!("{}-node triangle", self.nodes),
            _ => format!("{}-node quadrangle", self.nodes),
        }
    }
}

/// Number of nodes of a type in a list of types.
fn nodes_of(number: i64, types: &[(i64, usize)]) -> Option<usize> {
    types.iter().find(|(listed, _)| *listed == number).map(|&(_, nodes)| nodes)
}

/// Refusal of a type.
fn refused(number: i64) -> MeshProblem {
    const INCOMPLETE: &str = "mesh with Mesh.SecondOrderIncomplete=1, which puts no nodes on faces";
    const LOWER: &str = "mesh with Mesh.ElementOrder=2 and Mesh.SecondOrderIncomplete=1";
    let (what, advice) = match number {
        12 => ("a 27-node hexahedron".to_owned(), INCOMPLETE),
        13 => ("an 18-node wedge".to_owned(), INCOMPLETE),
        14 => ("a 14-node pyramid".to_owned(), INCOMPLETE),
        29 => ("a 20-node tetrahedron".to_owned(), LOWER),
        30 => ("a 35-node tetrahedron".to_owned(), LOWER),
        31 => ("a 56-node tetrahedron".to_owned(), LOWER),
        92 => ("a 64-node hexahedron".to_owned(), LOWER),
        93 => ("a 125-node hexahedron".to_owned(), LOWER),
        _ => (format!("an element of Gmsh's type {number}"), LOWER),
    };
    MeshProblem::NotCarried { what, advice }
}

/// Solid elements by their types.
const SOLIDS: [(i64, ElementKind); 8] = [
    (4, ElementKind::C3D4),
    (5, ElementKind::C3D8I),
    (6, ElementKind::C3D6),
    (7, ElementKind::C3D5),
    (11, ElementKind::C3D10),
    (17, ElementKind::C3D20),
    (18, ElementKind::C3D15),
    (19, ElementKind::C3D13),
];

/// Numbers of nodes of lines by their types, which are those of Gmsh's `GmshDefines.h`.
const LINES: [(i64, usize); 10] =
    [(1, 2), (8, 3), (26, 4), (27, 5), (28, 6), (62, 7), (63, 8), (64, 9), (65, 10), (66, 11)];

/// Numbers of nodes of triangles by their types.
#[rustfmt::skip]
const TRIANGLES: [(i64, usize); 18] = [
    (2, 3), (9, 6), (20, 9), (21, 10), (22, 12), (23, 15), (24, 15), (25, 21), (42, 28), (43, 36), (44, 45), (45, 55),
    (46, 66), (52, 18), (53, 21), (54, 24), (55, 27), (56, 30),
];

/// Numbers of nodes of quadrangles by their types.
#[rustfmt::skip]
const QUADRANGLES: [(i64, usize); 19] = [
    (3, 4), (10, 9), (16, 8), (36, 16), (37, 25), (38, 36), (39, 12), (40, 16), (41, 20), (47, 49), (48, 64), (49, 81),
    (50, 100), (51, 121), (57, 24), (58, 28), (59, 32), (60, 36), (61, 40),
];

/// Nodes of a solid element in CalculiX's order, given in Gmsh's.
pub(super) fn reordered(kind: ElementKind, nodes: &[u64]) -> Vec<u64> {
    let (corners, middles) = nodes.split_at(kind.corners().min(nodes.len()));
    let on = |&[a, b]: &[usize; 2]| {
        let is = |edge: &&[usize; 2]| **edge == [a, b] || **edge == [b, a];
        edges(kind).iter().zip(middles).find(|(edge, _)| is(edge)).map(|(_, &middle)| middle)
    };
    let middles_in_order = Topology::of(kind).edges.iter().filter_map(on);
    corners.iter().copied().chain(middles_in_order).collect()
}

/// Corners at both ends of each edge, in Gmsh's order of the nodes on edges. Corners themselves have the same order as CalculiX's.
fn edges(kind: ElementKind) -> &'static [[usize; 2]] {
    match kind.corners() {
        4 => &[[0, 1], [1, 2], [2, 0], [3, 0], [2, 3], [1, 3]],
        5 => &[[0, 1], [0, 3], [0, 4], [1, 2], [1, 4], [2, 3], [2, 4], [3, 4]],
        6 => &[[0, 1], [0, 2], [0, 3], [1, 2], [1, 4], [2, 5], [3, 4], [3, 5], [4, 5]],
        _ => {
            &[[0, 1], [0, 3], [0, 4], [1, 2], [1, 5], [2, 3], [2, 6], [3, 7], [4, 5], [4, 7], [5, 6], [6, 7]]
        }
    }
}
