//! Natural coordinates: the cube −1 ≤ ξ, η, ζ ≤ 1, the tetrahedron, the pyramid and the wedge, their corners and edges.

/// Natural coordinates (ξ, η, ζ).
pub type Natural = [f64; 3];

/// Corners of the cube, in the order of a hexahedron's first eight nodes.
pub const CORNERS: [Natural; 8] = [
    [-1.0, -1.0, -1.0],
    [1.0, -1.0, -1.0],
    [1.0, 1.0, -1.0],
    [-1.0, 1.0, -1.0],
    [-1.0, -1.0, 1.0],
    [1.0, -1.0, 1.0],
    [1.0, 1.0, 1.0],
    [-1.0, 1.0, 1.0],
];

/// Corners at both ends of each edge of a hexahedron, in the order of its mid-edge nodes (C3D20): around the face ζ = −1,
/// around the face ζ = +1, then along ζ.
pub const EDGES: [[usize; 2]; 12] =
    [[0, 1], [1, 2], [2, 3], [3, 0], [4, 5], [5, 6], [6, 7], [7, 4], [0, 4], [1, 5], [2, 6], [3, 7]];

/// Corners of the tetrahedron.
pub(crate) const TETRAHEDRON_CORNERS: [Natural; 4] =
    [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// Edges of the tetrahedron, in the order of the mid-edge nodes of C3D10.
pub(crate) const TETRAHEDRON_EDGES: [[usize; 2]; 6] = [[0, 1], [1, 2], [2, 0], [0, 3], [1, 3], [2, 3]];

/// Corners of the pyramid: its base at ζ = 0, counter-clockwise seen from the apex, then the apex.
pub(crate) const PYRAMID_CORNERS: [Natural; 5] =
    [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// Edges of the pyramid, in the order of the mid-edge nodes of C3D13: around the base, then up to the apex.
pub(crate) const PYRAMID_EDGES: [[usize; 2]; 8] =
    [[0, 1], [1, 2], [2, 3], [3, 0], [0, 4], [1, 4], [2, 4], [3, 4]];

/// Corners of the wedge.
pub(crate) const WEDGE_CORNERS: [Natural; 6] =
    [[0.0, 0.0, -1.0], [1.0, 0.0, -1.0], [0.0, 1.0, -1.0], [0.0, 0.0, 1.0], [1.0, 0.0, 1.0], [0.0, 1.0, 1.0]];

/// Edges of the wedge, in the order of the mid-edge nodes of C3D15.
pub(crate) const WEDGE_EDGES: [[usize; 2]; 9] =
    [[0, 1], [1, 2], [2, 0], [3, 4], [4, 5], [5, 3], [0, 3], [1, 4], [2, 5]];
