//! Tetrahedra ξ, η, ζ ≥ 0, ξ + η + ζ ≤ 1.

use nalgebra::Vector3;

use crate::natural::{Natural, TETRAHEDRON_EDGES};

/// Barycentric coordinates, all four, each with its derivative.
pub(super) fn linear(xi: Natural) -> [(f64, Vector3<f64>); 4] {
    [
        (1.0 - xi[0] - xi[1] - xi[2], Vector3::new(-1.0, -1.0, -1.0)),
        (xi[0], Vector3::x()),
        (xi[1], Vector3::y()),
        (xi[2], Vector3::z()),
    ]
}

/// Quadratic shape functions: corners `L(2L − 1)`, middles of edges `4 L_a L_b`.
pub(super) fn quadratic(xi: Natural) -> [(f64, Vector3<f64>); 10] {
    let l = linear(xi);
    std::array::from_fn(|a| match l.get(a) {
        Some((l, dl)) => (l * (2.0 * l - 1.0), dl * (4.0 * l - 1.0)),
        None => {
            let [(a, da), (b, db)] = TETRAHEDRON_EDGES[a - 4].map(|corner| l[corner]);
            (4.0 * a * b, (da * b + db * a) * 4.0)
        }
    })
}
