//! The 20-node serendipity hexahedron with full, 3 × 3 × 3 integration.

use nalgebra::Vector3;

use super::hexahedron::Hexahedron;
use super::natural::{CORNERS, EDGES, Natural};

/// A 20-node hexahedron, nodes in the order of [`EDGES`].
///
/// Corners `N = (1 + ξ_a ξ)(1 + η_a η)(1 + ζ_a ζ)(ξ_a ξ + η_a η + ζ_a ζ − 2)/8`, mid-edge nodes
/// `N = (1 − ξ²)(1 + η_a η)(1 + ζ_a ζ)/4` along ξ and alike along η and ζ. Complete to second degree in ξ, η, ζ: a
/// parallelepiped with centred mid-edge nodes represents any quadratic displacement exactly.
#[derive(Debug, Clone)]
pub struct Hex20([[f64; 3]; 20]);

impl From<[[f64; 3]; 20]> for Hex20 {
    fn from(positions: [[f64; 3]; 20]) -> Self {
        Self(positions)
    }
}

/// The factors of a function in one direction and their derivatives: `1 + c ξ` at an end, `1 − ξ²` in the middle.
fn factor(c: f64, xi: f64) -> (f64, f64) {
    if c == 0.0 { (1.0 - xi * xi, -2.0 * xi) } else { (1.0 + c * xi, c) }
}

/// Natural coordinates of a mid-edge node.
fn middle(edge: [usize; 2]) -> Natural {
    std::array::from_fn(|d| 0.5 * (CORNERS[edge[0]][d] + CORNERS[edge[1]][d]))
}

impl Hexahedron<20> for Hex20 {
    const STRESS_POINTS: usize = 3;

    fn positions(&self) -> &[[f64; 3]; 20] {
        &self.0
    }

    fn shape_functions(xi: Natural) -> [f64; 20] {
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

    fn shape_derivatives(xi: Natural) -> [Vector3<f64>; 20] {
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
}
