//! Hexahedra −1 ≤ ξ, η, ζ ≤ 1.

use nalgebra::Vector3;

use crate::natural::{CORNERS, EDGES, Natural};

/// Trilinear shape functions.
pub fn linear(xi: Natural) -> [f64; 8] {
    CORNERS.map(|c| (0..3).map(|d| 0.5 * (1.0 + c[d] * xi[d])).product())
}

/// Derivatives of [`linear`].
pub fn linear_derivatives(xi: Natural) -> [Vector3<f64>; 8] {
    CORNERS.map(|c| {
        let f: [f64; 3] = std::array::from_fn(|d| 0.5 * (1.0 + c[d] * xi[d]));
        Vector3::from_fn(|d, _| 0.5 * c[d] * f[(d + 1) % 3] * f[(d + 2) % 3])
    })
}

/// Serendipity shape functions of 20 nodes.
///
/// Corners `N = (1 + ξ_a ξ)(1 + η_a η)(1 + ζ_a ζ)(ξ_a ξ + η_a η + ζ_a ζ − 2)/8`, mid-edge nodes
/// `N = (1 − ξ²)(1 + η_a η)(1 + ζ_a ζ)/4` along ξ and alike along η and ζ. Complete to second degree in ξ, η, ζ: a
/// parallelepiped with centred mid-edge nodes represents any quadratic displacement exactly.
pub fn quadratic(xi: Natural) -> [f64; 20] {
    std::array::from_fn(|a| match CORNERS.get(a) {
        Some(c) => {
            let f: [f64; 3] = std::array::from_fn(|d| c[d] * xi[d]);
            (1.0 + f[0]) * (1.0 + f[1]) * (1.0 + f[2]) * (f[0] + f[1] + f[2] - 2.0) / 8.0
        }
        None => {
            let c = middle(EDGES[a - 8]);
            (0..3).map(|d| factor(c[d], xi[d]).0).product::<f64>() / 4.0
        }
    })
}

/// Derivatives of [`quadratic`].
pub fn quadratic_derivatives(xi: Natural) -> [Vector3<f64>; 20] {
    std::array::from_fn(|a| match CORNERS.get(a) {
        Some(c) => {
            let f: [f64; 3] = std::array::from_fn(|d| c[d] * xi[d]);
            let sum = f[0] + f[1] + f[2] - 2.0;
            Vector3::from_fn(|d, _| {
                let (p, q) = (f[(d + 1) % 3], f[(d + 2) % 3]);
                c[d] * (1.0 + p) * (1.0 + q) * (sum + 1.0 + f[d]) / 8.0
            })
        }
        None => {
            let c = middle(EDGES[a - 8]);
            let f: [(f64, f64); 3] = std::array::from_fn(|d| factor(c[d], xi[d]));
            Vector3::from_fn(|d, _| f[d].1 * f[(d + 1) % 3].0 * f[(d + 2) % 3].0 / 4.0)
        }
    })
}

/// Factor of a function in one direction and its derivative: `1 + c ξ` at an end, `1 − ξ²` in the middle.
fn factor(c: f64, xi: f64) -> (f64, f64) {
    if c == 0.0 { (1.0 - xi * xi, -2.0 * xi) } else { (1.0 + c * xi, c) }
}

/// Natural coordinates of a mid-edge node.
fn middle(edge: [usize; 2]) -> Natural {
    std::array::from_fn(|d| 0.5 * (CORNERS[edge[0]][d] + CORNERS[edge[1]][d]))
}
