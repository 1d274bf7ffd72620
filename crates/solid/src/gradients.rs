//! Displacement gradients at an element's integration points.

use nalgebra::{Matrix3, SMatrix, Vector3};

use crate::blocks::Blocks;
use crate::element::ElementKind;
use crate::material::Lame;
use crate::natural::Natural;
use crate::rule::points;
use crate::shape::derivatives;

/// Recovery of the incompatible modes: amplitudes of the three modes in x, y, z (mode by mode) from the displacements of the eight
/// corners (node by node).
pub(crate) type Recovery = SMatrix<f64, 9, 24>;

/// Jacobian `J_ij = ∂x_i/∂ξ_j`.
pub fn jacobian(kind: ElementKind, positions: &[[f64; 3]], xi: Natural) -> Matrix3<f64> {
    let derivatives = derivatives(kind, xi);
    positions.iter().zip(&derivatives).map(|(&x, dn)| Vector3::from(x) * dn.transpose()).sum()
}

/// Gradients of an element's functions at its integration points.
#[derive(Debug)]
pub(crate) struct Gradients {
    /// Gradients at each point: those of the nodes' functions in x, y, z, then those of the incompatible modes, if the element has some.
    pub(crate) at_points: Vec<Vec<Vector3<f64>>>,
    /// Volume that each point stands for.
    pub(crate) volumes: Vec<f64>,
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
                let ratio =
                    if kind == ElementKind::QM6 { [centre.determinant(), determinant] } else { [1.0; 2] };
                at_point.extend(
                    (0..3).map(|b| centre_turn.column(b) * (-2.0 * point.xi[b] * ratio[0] / ratio[1])),
                );
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

    /// Elastic stiffness of all functions, those of incompatible modes behind those of the nodes, from `S_ab = ∫ ∇N_a ⊗ ∇N_b dV`:
    /// `K_ab = λ S_ab + μ S_abᵀ + μ tr(S_ab) 1`.
    pub(crate) fn elastic(&self, constants: Lame) -> Blocks {
        let functions = self.at_points.first().map_or(0, Vec::len);
        let mut blocks = Blocks::zeros(functions);
        for (gradients, &volume) in self.at_points.iter().zip(&self.volumes) {
            for a in 0..functions {
                let weighted = gradients[a] * volume;
                for b in 0..=a {
                    blocks[(a, b)] += weighted * gradients[b].transpose();
                }
            }
        }
        let Lame { lambda, mu } = constants;
        for a in 0..functions {
            for b in 0..=a {
                let s = blocks[(a, b)];
                let block = s * lambda + (s.transpose() + Matrix3::identity() * s.trace()) * mu;
                blocks[(a, b)] = block;
                blocks[(b, a)] = block.transpose();
            }
        }
        blocks
    }

    /// Recovery of the amplitudes of incompatible modes, which follow the corners statically: `α = −K_αα⁻¹ K_αu u`.
    pub(crate) fn recovery(elastic: &Blocks) -> Recovery {
        let entry = |row: usize, column: usize| elastic[(row / 3, column / 3)][(row % 3, column % 3)];
        let k_aa = SMatrix::<f64, 9, 9>::from_fn(|i, j| entry(24 + i, 24 + j));
        let k_au = Recovery::from_fn(|i, j| entry(24 + i, j));
        // K_αα is definite on any element with det J > 0; the fallback leaves the plain trilinear element.
        k_aa.cholesky().map_or_else(Recovery::zeros, |factor| -factor.solve(&k_au))
    }
}

fn inverse_transpose(jacobian: &Matrix3<f64>) -> Matrix3<f64> {
    jacobian.try_inverse().unwrap_or_default().transpose()
}
