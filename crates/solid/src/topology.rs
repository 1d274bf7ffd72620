//! Corners, edges and faces of each shape.

use crate::element::ElementKind;
use crate::natural::{
    CORNERS, EDGES, Natural, PYRAMID_CORNERS, PYRAMID_EDGES, TETRAHEDRON_CORNERS, TETRAHEDRON_EDGES,
    WEDGE_CORNERS, WEDGE_EDGES,
};

/// Corners, edges and faces of a shape, without regard to functions.
#[derive(Debug, Clone, Copy)]
pub struct Topology {
    /// Natural coordinates of the corners.
    pub corners: &'static [Natural],
    /// Corners at both ends of each edge, in the order of mid-edge nodes.
    pub edges: &'static [[usize; 2]],
    /// Corners of each face, counter-clockwise seen from outside.
    pub faces: &'static [&'static [usize]],
    /// Number of nodes.
    nodes: usize,
}

impl Topology {
    /// Topology of an element kind.
    pub fn of(kind: ElementKind) -> Self {
        let nodes = kind.nodes();
        match kind.corners() {
            4 => Self {
                corners: &TETRAHEDRON_CORNERS,
                edges: &TETRAHEDRON_EDGES,
                faces: &[&[0, 2, 1], &[0, 1, 3], &[1, 2, 3], &[2, 0, 3]],
                nodes,
            },
            5 => Self {
                corners: &PYRAMID_CORNERS,
                edges: &PYRAMID_EDGES,
                faces: &[&[0, 3, 2, 1], &[0, 1, 4], &[1, 2, 4], &[2, 3, 4], &[3, 0, 4]],
                nodes,
            },
            6 => Self {
                corners: &WEDGE_CORNERS,
                edges: &WEDGE_EDGES,
                faces: &[&[0, 2, 1], &[3, 4, 5], &[0, 1, 4, 3], &[1, 2, 5, 4], &[2, 0, 3, 5]],
                nodes,
            },
            _ => Self {
                corners: &CORNERS,
                edges: &EDGES,
                faces: &[
                    &[0, 3, 2, 1],
                    &[4, 5, 6, 7],
                    &[0, 1, 5, 4],
                    &[1, 2, 6, 5],
                    &[2, 3, 7, 6],
                    &[3, 0, 4, 7],
                ],
                nodes,
            },
        }
    }

    /// Natural coordinates of all nodes.
    pub fn nodes(self) -> Vec<Natural> {
        let middle =
            |&[a, b]: &[usize; 2]| std::array::from_fn(|d| 0.5 * (self.corners[a][d] + self.corners[b][d]));
        let middles = self.edges.iter().map(middle);
        self.corners.iter().copied().chain(middles).take(self.nodes).collect()
    }

    /// Local nodes of a face: corners counter-clockwise seen from outside, then, of a quadratic element, the middle of the edge
    /// behind each corner.
    pub fn face_nodes(self, face: usize) -> Vec<usize> {
        let corners = self.faces[face];
        let mut nodes = corners.to_vec();
        if self.nodes > self.corners.len() {
            for (k, &from) in corners.iter().enumerate() {
                let to = corners[(k + 1) % corners.len()];
                let edge = self.edges.iter().position(|edge| *edge == [from, to] || *edge == [to, from]);
                nodes.extend(edge.map(|edge| self.corners.len() + edge));
            }
        }
        nodes
    }
}
