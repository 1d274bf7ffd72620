//! Shape functions `N_a(ξ)` and their derivatives `∂N_a/∂ξ`, nodes in CalculiX's order.

pub mod hexahedron;
mod pyramid;
mod tetrahedron;
mod wedge;

use nalgebra::Vector3;

use crate::element::ElementKind;
use crate::natural::Natural;

/// Shape functions `N_a(ξ)` of every node.
pub fn functions(kind: ElementKind, xi: Natural) -> Vec<f64> {
    use ElementKind::{C3D4, C3D5, C3D6, C3D8, C3D8I, C3D10, C3D13, C3D15, C3D20, C3D20R, QM6};
    match kind {
        C3D4 => tetrahedron::linear(xi).map(|(n, _)| n).into(),
        C3D10 => tetrahedron::quadratic(xi).map(|(n, _)| n).into(),
        C3D5 => pyramid::linear(xi).map(|(n, _)| n).into(),
        C3D13 => pyramid::quadratic(xi).map(|(n, _)| n).into(),
        C3D6 => wedge::linear(xi).map(|(n, _)| n).into(),
        C3D15 => wedge::quadratic(xi).map(|(n, _)| n).into(),
        C3D8 | C3D8I | QM6 => hexahedron::linear(xi).into(),
        C3D20 | C3D20R => hexahedron::quadratic(xi).into(),
    }
}

/// Derivatives `∂N_a/∂ξ` of every node.
pub fn derivatives(kind: ElementKind, xi: Natural) -> Vec<Vector3<f64>> {
    use ElementKind::{C3D4, C3D5, C3D6, C3D8, C3D8I, C3D10, C3D13, C3D15, C3D20, C3D20R, QM6};
    match kind {
        C3D4 => tetrahedron::linear(xi).map(|(_, dn)| dn).into(),
        C3D10 => tetrahedron::quadratic(xi).map(|(_, dn)| dn).into(),
        C3D5 => pyramid::linear(xi).map(|(_, dn)| dn).into(),
        C3D13 => pyramid::quadratic(xi).map(|(_, dn)| dn).into(),
        C3D6 => wedge::linear(xi).map(|(_, dn)| dn).into(),
        C3D15 => wedge::quadratic(xi).map(|(_, dn)| dn).into(),
        C3D8 | C3D8I | QM6 => hexahedron::linear_derivatives(xi).into(),
        C3D20 | C3D20R => hexahedron::quadratic_derivatives(xi).into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::topology::Topology;

    /// Functions are one at their own node and zero at all others; together one everywhere; derivatives those of differences.
    #[test]
    fn functions_are_those_of_their_nodes() {
        for kind in ElementKind::ALL {
            let nodes = Topology::of(kind).nodes();
            for (b, node) in nodes.iter().enumerate() {
                for (a, value) in functions(kind, *node).into_iter().enumerate() {
                    assert!((value - f64::from(u8::from(a == b))).abs() < 1e-14, "{kind:?} {a} at {b}");
                }
            }
            let xi = [0.21, 0.17, -0.33];
            assert!((functions(kind, xi).iter().sum::<f64>() - 1.0).abs() < 1e-14);
            for d in 0..3 {
                let at =
                    |h: f64| functions(kind, std::array::from_fn(|k| xi[k] + if k == d { h } else { 0.0 }));
                let (after, before) = (at(1e-5), at(-1e-5));
                for (a, exact) in derivatives(kind, xi).into_iter().enumerate() {
                    assert!(((after[a] - before[a]) / 2e-5 - exact[d]).abs() < 1e-9, "{kind:?} {a} {d}");
                }
            }
        }
    }
}
