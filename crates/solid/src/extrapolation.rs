//! Extrapolation from an element's integration points to its nodes, as CalculiX 2.20 does it: measured on its answers, from which the
//! matrix of every element was recovered to the digits that it prints.
//!
//! | element | what is laid through the values at the points |
//! |---|---|
//! | C3D4 | the one value |
//! | C3D5, C3D13 (not in CalculiX) | the linear function of least squares |
//! | C3D6 | straight along ζ, constant in the triangle (CalculiX's own node values alternate from node to node of one triangle, an error of its table) |
//! | C3D8, C3D8I, QM6 | the trilinear function |
//! | C3D10 | the linear function, at corners; elsewhere means of both ends of the edge |
//! | C3D15 | linear in the triangle, the straight line of least squares along ζ, at corners; elsewhere means of both ends |
//! | C3D20 | the twenty shape functions of the element, by least squares, at all nodes |
//! | C3D20R | the trilinear function, at corners; elsewhere means of both ends |
//!
//! A mean of both ends is the value of those functions in the middle of a straight edge of the reference shape, so it needs no code of its own.

use std::sync::LazyLock;

use nalgebra::DMatrix;

use crate::element::ElementKind;
use crate::natural::Natural;
use crate::rule::points;
use crate::shape::functions;
use crate::topology::Topology;

static MATRICES: LazyLock<Vec<DMatrix<f64>>> =
    LazyLock::new(|| ElementKind::ALL.iter().map(|&kind| made(kind)).collect());

/// Matrix from values at the integration points (columns) to values at the nodes (rows).
pub fn extrapolation(kind: ElementKind) -> &'static DMatrix<f64> {
    &MATRICES[kind as usize]
}

/// Matrix of functions fitted at the points and evaluated at the nodes: `N_nodes (N_pointsᵀ N_points)⁻¹ N_pointsᵀ`.
fn made(kind: ElementKind) -> DMatrix<f64> {
    let nodes = Topology::of(kind).nodes();
    let points: Vec<Natural> = points(kind).iter().map(|point| point.xi).collect();
    let values = |places: &[Natural]| {
        let rows: Vec<Vec<f64>> = places.iter().map(|&xi| fitted(kind, xi)).collect();
        DMatrix::from_fn(rows.len(), rows[0].len(), |row, column| rows[row][column])
    };
    let at_points = values(&points);
    let normal = at_points.tr_mul(&at_points);
    let Some(inverse) = normal.try_inverse() else {
        unreachable!("the functions are independent at the points")
    };
    values(&nodes) * inverse * at_points.transpose()
}

/// Values of the functions that are fitted, at a place.
fn fitted(kind: ElementKind, xi: Natural) -> Vec<f64> {
    let [x, y, z] = xi;
    match kind {
        ElementKind::C3D4 => vec![1.0],
        ElementKind::C3D6 => vec![1.0, z],
        ElementKind::C3D5 | ElementKind::C3D10 | ElementKind::C3D13 => vec![1.0, x, y, z],
        ElementKind::C3D15 => vec![1.0, x, y, z, x * z, y * z],
        ElementKind::C3D8 | ElementKind::C3D8I | ElementKind::QM6 | ElementKind::C3D20R => {
            vec![1.0, x, y, z, x * y, y * z, z * x, x * y * z]
        }
        ElementKind::C3D20 => functions(kind, xi),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Entries of CalculiX's matrices, recovered from node and point stresses of forty crooked elements each.
    #[test]
    fn the_matrices_are_calculixs() {
        let near = |a: f64, b: f64| assert!((a - b).abs() < 2e-5, "{a} {b}");
        for (kind, node, row) in [
            (ElementKind::C3D8, 0, vec![2.549_04, -0.683_01, -0.683_01, 0.183_01]),
            (ElementKind::C3D20R, 8, vec![0.933_01, 0.933_01, -0.25, -0.25]),
            (ElementKind::C3D10, 4, vec![0.809_02, 0.809_02, -0.309_02, -0.309_02]),
            (
                ElementKind::C3D15,
                0,
                vec![1.631_38, -0.326_28, -0.326_28, 0.555_56, -0.111_11, -0.111_11, -0.520_27],
            ),
            (ElementKind::C3D15, 12, vec![0.555_56, -0.111_11, -0.111_11, 0.555_56]),
            (ElementKind::C3D20, 0, vec![2.374_99, -0.312_47, -0.125_59, -0.312_46, -0.488_24, 0.314_81]),
            (
                ElementKind::C3D20,
                8,
                vec![0.326_28, 1.284_39, 0.326_28, -0.270_72, 0.055_56, -0.270_72, 0.111_11],
            ),
        ] {
            for (point, &expected) in row.iter().enumerate() {
                near(extrapolation(kind)[(node, point)], expected);
            }
        }
    }

    #[test]
    fn what_is_constant_stays_so() {
        for kind in ElementKind::ALL {
            for row in extrapolation(kind).row_iter() {
                assert!((row.sum() - 1.0).abs() < 1e-13, "{kind:?}");
            }
        }
    }
}
