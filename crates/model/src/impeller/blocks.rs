//! Structured blocks of hexahedra of either order, numbered as they are added and conforming where they meet.
//!
//! A block's points are addressed by half-indices: even ones are the corners of its elements, a point with one odd
//! index is the middle of an edge. Middles of faces and of elements are not nodes of a serendipity hexahedron and are
//! left out. The mid-edge nodes come from the same position function as the corners, so they lie on the true
//! geometry.

use rubmap_solid::natural::{CORNERS, EDGES};

use super::mesh::{ElementOrder, Elements, HexMesh};

/// Half-indices of a block's points, or of a point within an element (0, 1 or 2).
pub(super) type HalfIndex = [usize; 3];

/// Nodes of a block that has been added to a mesh.
#[derive(Debug)]
pub(super) struct Block {
    /// Number of points in each direction.
    points: [usize; 3],
    /// Node of each point, the first index fastest.
    nodes: Vec<Option<usize>>,
}

impl Block {
    /// Node at a point, if the element order has one there.
    pub(super) fn node(&self, half: HalfIndex) -> Option<usize> {
        self.nodes[self.place(half)]
    }

    fn place(&self, [i, j, k]: HalfIndex) -> usize {
        i + self.points[0] * (j + self.points[1] * k)
    }

    /// Iterates over all nodes with their points, the first index fastest.
    pub(super) fn iter(&self) -> impl Iterator<Item = (HalfIndex, usize)> {
        points(self.points).zip(&self.nodes).filter_map(|(half, node)| node.map(|node| (half, node)))
    }

    /// Nodes of the element whose first corner is `first`.
    fn element<const N: usize>(&self, first: HalfIndex) -> Option<[usize; N]> {
        let mut element = [0; N];
        for (node, offset) in element.iter_mut().zip(local_points()) {
            *node = self.node([0, 1, 2].map(|d| first[d] + offset[d]))?;
        }
        Some(element)
    }
}

/// Points of a block, the first index fastest.
fn points([n_i, n_j, n_k]: [usize; 3]) -> impl Iterator<Item = HalfIndex> {
    (0..n_k).flat_map(move |k| (0..n_j).flat_map(move |j| (0..n_i).map(move |i| [i, j, k])))
}

/// Points of an element's nodes from its first corner: the corners, then the middles of [`EDGES`].
fn local_points() -> impl Iterator<Item = HalfIndex> {
    let corner = |a: usize| CORNERS[a].map(|c| if c > 0.0 { 2 } else { 0 });
    let middle = move |[a, b]: [usize; 2]| [0, 1, 2].map(|d| (corner(a)[d] + corner(b)[d]) / 2);
    (0..CORNERS.len()).map(corner).chain(EDGES.into_iter().map(middle))
}

/// Mesh that grows block by block.
#[derive(Debug)]
pub(super) struct BlockMesher {
    order: ElementOrder,
    mesh: HexMesh,
}

impl BlockMesher {
    /// Mesh without blocks.
    pub(super) fn new(order: ElementOrder) -> Self {
        let elements = match order {
            ElementOrder::Linear => Elements::Linear(Vec::new()),
            ElementOrder::Quadratic => Elements::Quadratic(Vec::new()),
        };
        Self { order, mesh: HexMesh { nodes: Vec::new(), elements } }
    }

    /// Adds a block of `size` elements, right-handed in its three directions.
    ///
    /// `shared` names the node of an earlier block at a point, `position` places all others. Nodes and elements are
    /// numbered with the first index fastest.
    pub(super) fn add(
        &mut self,
        size: [usize; 3],
        shared: impl Fn(HalfIndex) -> Option<usize>,
        position: impl Fn(HalfIndex) -> [f64; 3],
    ) -> Block {
        let counts = size.map(|n| 2 * n + 1);
        let nodes = points(counts)
            .map(|half| {
                let is_node = self.order.has_node(half);
                is_node.then(|| {
                    shared(half).unwrap_or_else(|| {
                        self.mesh.nodes.push(position(half));
                        self.mesh.nodes.len() - 1
                    })
                })
            })
            .collect();
        let block = Block { points: counts, nodes };
        let firsts = points(size).map(|cell| cell.map(|c| 2 * c));
        match &mut self.mesh.elements {
            Elements::Linear(list) => list.extend(firsts.filter_map(|first| block.element(first))),
            Elements::Quadratic(list) => list.extend(firsts.filter_map(|first| block.element(first))),
        }
        block
    }

    /// Mesh of all blocks.
    pub(super) fn finish(self) -> HexMesh {
        self.mesh
    }
}

/// Number of nodes of a block of this size in elements, as a float: hostile sizes must not overflow.
pub(super) fn node_count(order: ElementOrder, [a, b, c]: [f64; 3]) -> f64 {
    let corners = (a + 1.0) * (b + 1.0) * (c + 1.0);
    match order {
        ElementOrder::Linear => corners,
        ElementOrder::Quadratic => {
            corners + a * (b + 1.0) * (c + 1.0) + (a + 1.0) * b * (c + 1.0) + (a + 1.0) * (b + 1.0) * c
        }
    }
}
