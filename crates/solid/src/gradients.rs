//! Displacement gradients at an element's integration points.

use nalgebra::{Matrix3, SMatrix, Vector3};

use crate::element::ElementKind;
use crate::material::{Lame, lame_constants};
use crate::natural::Natural;
use crate::rule::points;
use crate::shape::derivatives;

/// Recovery of the incompatible modes: amplitudes of the three modes in x, y, z (mode by mode) from the displacements of the eight
/// corners (node by node).
pub(crate) type Recovery = SMatrix<f64, 9, 24>;

/// Jacobian `J_ij = ∂x_i/∂ξ_j`.
pub(crate) fn jacobian(kind: ElementKind, positions: &[[f64; 3]], xi: Natural) -> Matrix3<f64> {
    let derivatives = derivatives(kind, xi);
    positions.iter().zip(&derivatives).map(|(&x, dn)| Vector3::from(x) * dn.transpose()).sum()
}

/// Gradients of an element's functions at its integration points.
#[derive(Debug)]
pub(crate) struct Gradients {
    /// Gradients at each point: those of the nodes' functions in x, y, z, then those of the incompatible modes, if the element has some.
    pub(crate) at_points: Vec<Vec<Vector3<f64>>>,
    /// Volume that each point stands for.
    volumes: Vec<f64>,
}

impl Gradients {
    /// Gradients of an element whose Jacobian determinants are positive; the inverse of a singular Jacobian counts as zero.
    pub(crate) fn of(kind: ElementKind, positions: &[[f64; 3]]) -> Self {
        let centre = jacobian(kind, positions, [0.0; 3]);
        let centre_turn = inverse_transpose(&centre);
        let mut gradients = Self { at_points: Vec::new(), volumes: Vec::new() };
        for point in points(kind) {
            let jacobian = jacobian(kind, positions, point.xi);
            let (turn, determinant) = (inverse_transpose(&jacobian), jacobian.determinant());
            let mut at_point: Vec<Vector3<f64>> =
                derivatives(kind, point.xi).into_iter().map(|dn| turn * dn).collect();
            if kind.has_bubbles() {
                // Without the factor J0/J, C3D8I fails the patch test on crooked elements; CalculiX leaves it out.
                let factor = if kind == ElementKind::QM6 { centre.determinant() / determinant } else { 1.0 };
                at_point.extend((0..3).map(|b| centre_turn.column(b) * (-2.0 * point.xi[b] * factor)));
            }
            gradients.at_points.push(at_point);
            gradients.volumes.push(determinant * point.weight);
        }
        gradients
    }

    /// Integral `∫ ∇N dV` of a node's function.
    pub(crate) fn integral(&self, node: usize) -> Vector3<f64> {
        self.at_points.iter().zip(&self.volumes).map(|(at_point, volume)| at_point[node] * *volume).sum()
    }

    /// Recovery of the amplitudes of incompatible modes, which follow the corners statically: `α = −K_αα⁻¹ K_αu u`.
    pub(crate) fn recovery(&self, youngs_modulus: f64, poissons_ratio: f64) -> Recovery {
        let Lame { lambda, mu } = lame_constants(youngs_modulus, poissons_ratio);
        let block = |a: usize, b: usize| -> Matrix3<f64> {
            let products = self.at_points.iter().zip(&self.volumes);
            let s: Matrix3<f64> = products.map(|(g, volume)| g[a] * g[b].transpose() * *volume).sum();
            s * lambda + (s.transpose() + Matrix3::identity() * s.trace()) * mu
        };
        let mut k_aa = SMatrix::<f64, 9, 9>::zeros();
        let mut k_au = Recovery::zeros();
        for bubble in 0..3 {
            for other in 0..3 {
                k_aa.fixed_view_mut::<3, 3>(3 * bubble, 3 * other).copy_from(&block(8 + bubble, 8 + other));
            }
            for node in 0..8 {
                k_au.fixed_view_mut::<3, 3>(3 * bubble, 3 * node).copy_from(&block(8 + bubble, node));
            }
        }
        // K_αα is definite on any element with det J > 0; the fallback leaves the plain trilinear element.
        k_aa.cholesky().map_or_else(Recovery::zeros, |factor| -factor.solve(&k_au))
    }
}

fn inverse_transpose(jacobian: &Matrix3<f64>) -> Matrix3<f64> {
    jacobian.try_inverse().unwrap_or_default().transpose()
}
