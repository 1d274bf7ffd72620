//! The cube −1 ≤ ξ, η, ζ ≤ 1: its coordinates, corners and edges.

/// Natural coordinates (ξ, η, ζ).
pub type Natural = [f64; 3];

/// Natural coordinates of the corners, in the order of an element's first eight nodes.
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

/// The corners at both ends of each edge, in the order of the mid-edge nodes (C3D20): around the face ζ = −1,
/// around the face ζ = +1, then along ζ.
pub const EDGES: [[usize; 2]; 12] =
    [[0, 1], [1, 2], [2, 3], [3, 0], [4, 5], [5, 6], [6, 7], [7, 4], [0, 4], [1, 5], [2, 6], [3, 7]];
