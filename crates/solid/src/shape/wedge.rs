//! Wedges: the triangle ξ, η ≥ 0, ξ + η ≤ 1 along −1 ≤ ζ ≤ 1.

use nalgebra::Vector3;

use crate::natural::{Natural, WEDGE_EDGES};

/// Barycentric coordinates of the triangle, each with its derivative.
fn barycentric(xi: Natural) -> [(f64, Vector3<f64>); 3] {
    [(1.0 - xi[0] - xi[1], Vector3::new(-1.0, -1.0, 0.0)), (xi[0], Vector3::x()), (xi[1], Vector3::y())]
}

/// Linear shape functions `L(1 ± ζ)/2`.
pub(super) fn linear(xi: Natural) -> [(f64, Vector3<f64>); 6] {
    let l = barycentric(xi);
    std::array::from_fn(|a| {
        let ((l, dl), side) = (l[a % 3], side(a));
        let end = 0.5 * (1.0 + side * xi[2]);
        (l * end, dl * end + Vector3::z() * (0.5 * side * l))
    })
}

/// Serendipity shape functions: corners `L(1 ± ζ)(2L − 2 ± ζ)/2`, middles of the triangles' edges `2 L_a L_b (1 ± ζ)`, of those along ζ
/// `L(1 − ζ²)`.
pub(super) fn quadratic(xi: Natural) -> [(f64, Vector3<f64>); 15] {
    let (l, z) = (barycentric(xi), xi[2]);
    std::array::from_fn(|a| {
        if a < 6 {
            let ((l, dl), side) = (l[a % 3], side(a));
            let (end, inner) = (1.0 + side * z, 2.0 * l - 2.0 + side * z);
            let along = 0.5 * l * side * (inner + end);
            (0.5 * l * end * inner, dl * (0.5 * end * (inner + 2.0 * l)) + Vector3::z() * along)
        } else if a < 12 {
            let [(p, dp), (q, dq)] = WEDGE_EDGES[a - 6].map(|corner| l[corner % 3]);
            let side = side(WEDGE_EDGES[a - 6][0]);
            let end = 1.0 + side * z;
            (2.0 * p * q * end, (dp * q + dq * p) * (2.0 * end) + Vector3::z() * (2.0 * p * q * side))
        } else {
            let (l, dl) = l[a - 12];
            (l * (1.0 - z * z), dl * (1.0 - z * z) - Vector3::z() * (2.0 * l * z))
        }
    })
}

/// Side of a corner: −1 on the triangle ζ = −1, else 1.
fn side(corner: usize) -> f64 {
    if corner < 3 { -1.0 } else { 1.0 }
}
