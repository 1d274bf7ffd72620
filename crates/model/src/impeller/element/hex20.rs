//! 20-node serendipity hexahedron with full, 3 × 3 × 3 integration.

use nalgebra::Vector3;

use super::hexahedron::Hexahedron;
use rubmap_solid::natural::Natural;
use rubmap_solid::shape::hexahedron;

/// 20-node hexahedron, nodes in the order of [`EDGES`](super::EDGES), shape functions of [`hexahedron::quadratic`].
#[derive(Debug, Clone)]
pub struct Hex20([[f64; 3]; 20]);

impl From<[[f64; 3]; 20]> for Hex20 {
    fn from(positions: [[f64; 3]; 20]) -> Self {
        Self(positions)
    }
}

impl Hexahedron<20> for Hex20 {
    const STRESS_POINTS: usize = 3;

    fn positions(&self) -> &[[f64; 3]; 20] {
        &self.0
    }

    fn shape_functions(xi: Natural) -> [f64; 20] {
        hexahedron::quadratic(xi)
    }

    fn shape_derivatives(xi: Natural) -> [Vector3<f64>; 20] {
        hexahedron::quadratic_derivatives(xi)
    }
}
