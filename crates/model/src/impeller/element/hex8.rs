//! 8-node hexahedron with incompatible modes (Wilson; Taylor, Beresford and Wilson, IJNME 10, 1976).

use nalgebra::{Matrix3, SMatrix, SVector, Vector3};

use super::blocks::Blocks;
use super::hexahedron::{Hexahedron, elastic_blocks, inverse_transpose};
use crate::impeller::material::{Material, Stress};
use rubmap_solid::gauss::{GaussPoint, gauss_points};
use rubmap_solid::natural::Natural;
use rubmap_solid::shape::hexahedron;

/// 8-node hexahedron with incompatible modes.
///
/// Displacement `u = Σ N_a u_a + Σ P_b α_b` with the trilinear `N_a` and P = 1−ξ², 1−η², 1−ζ². The bubble
/// gradients are taken with the Jacobian of the element's centre, `∂P_b/∂x = (det J₀ / det J) J₀⁻ᵀ ∂P_b/∂ξ`, so
/// that `∫ ∂P_b/∂x dV = 0` on any element and constant strain is exact (patch test). α is condensed out element
/// by element: `K = K_uu − K_uα K_αα⁻¹ K_αu`, `α = −K_αα⁻¹ K_αu u`.
///
/// Mass and geometric stiffness use the trilinear functions alone, as is usual for this element; both are then
/// free of Ω and of the elastic constants.
#[derive(Debug, Clone)]
pub struct Hex8([[f64; 3]; 8]);

impl From<[[f64; 3]; 8]> for Hex8 {
    fn from(positions: [[f64; 3]; 8]) -> Self {
        Self(positions)
    }
}

impl Hex8 {
    /// Gradients of the eight functions, then of the three bubbles, and det J.
    fn all_gradients(&self, xi: Natural) -> ([Vector3<f64>; 11], f64) {
        let (nodes, determinant) = self.gradients(xi);
        let (centre, centre_determinant) = inverse_transpose(&self.jacobian([0.0; 3]));
        let gradients = std::array::from_fn(|f| match nodes.get(f) {
            Some(gradient) => *gradient,
            None => centre.column(f - 8) * (-2.0 * xi[f - 8] * centre_determinant / determinant),
        });
        (gradients, determinant)
    }

    /// Stiffness of nodes and bubbles, and the recovery R with `α = R u`.
    fn parts(&self, material: &Material) -> (Blocks<11>, SMatrix<f64, 9, 24>) {
        let points = gauss_points(Self::STRESS_POINTS).iter().map(|point| {
            let (gradients, determinant) = self.all_gradients(point.xi);
            (gradients, determinant * point.weight)
        });
        let full = elastic_blocks(points, material);
        let entry = |row: usize, column: usize| full[row / 3][column / 3][(row % 3, column % 3)];
        let k_aa = SMatrix::<f64, 9, 9>::from_fn(|i, j| entry(24 + i, 24 + j));
        let k_au = SMatrix::<f64, 9, 24>::from_fn(|i, j| entry(24 + i, j));
        // K_αα is definite on any element with det J > 0; the fallback leaves the plain trilinear element.
        let recovery = k_aa.cholesky().map_or_else(SMatrix::zeros, |factor| -factor.solve(&k_au));
        (full, recovery)
    }
}

impl Hexahedron<8> for Hex8 {
    const STRESS_POINTS: usize = 2;

    fn positions(&self) -> &[[f64; 3]; 8] {
        &self.0
    }

    fn shape_functions(xi: Natural) -> [f64; 8] {
        hexahedron::linear(xi)
    }

    fn shape_derivatives(xi: Natural) -> [Vector3<f64>; 8] {
        hexahedron::linear_derivatives(xi)
    }

    fn stiffness(&self, material: &Material) -> Blocks<8> {
        let (full, recovery) = self.parts(material);
        let mut k = Box::new([[Matrix3::zeros(); 8]; 8]);
        for a in 0..8 {
            for b in 0..=a {
                let mut block = full[a][b];
                for bubble in 0..3 {
                    block += full[a][8 + bubble] * recovery.fixed_view::<3, 3>(3 * bubble, 3 * b);
                }
                k[a][b] = block;
                k[b][a] = block.transpose();
            }
        }
        k
    }

    fn stresses(&self, material: &Material, u: &[Vector3<f64>; 8]) -> Vec<Stress> {
        let (_, recovery) = self.parts(material);
        let alpha = recovery * SVector::<f64, 24>::from_fn(|d, _| u[d / 3][d % 3]);
        let stress = |point: &GaussPoint| {
            let (gradients, _) = self.all_gradients(point.xi);
            let value = |f: usize| {
                u.get(f)
                    .copied()
                    .unwrap_or_else(|| alpha.fixed_rows::<3>(3 * f.saturating_sub(8)).into_owned())
            };
            material.stress(&gradients.iter().enumerate().map(|(f, g)| value(f) * g.transpose()).sum())
        };
        gauss_points(Self::STRESS_POINTS).iter().map(stress).collect()
    }
}
