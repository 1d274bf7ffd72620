//! Common part of all hexahedra: geometry, stiffness, stress and mass from displacement functions.

use nalgebra::{Matrix3, SVector, Vector3};

use super::blocks::{Blocks, NodalMatrix};
use crate::impeller::material::{Material, Stress};
use rubmap_solid::gauss::{GaussPoint, gauss_points};
use rubmap_solid::material::Lame;
use rubmap_solid::natural::{CORNERS, Natural};

/// Hexahedron of N nodes at known Cartesian positions.
///
/// Integrals are valid where det J > 0, which [`Self::smallest_jacobian`] checks.
pub trait Hexahedron<const N: usize>: From<[[f64; 3]; N]> {
    /// Number of Gauss points in each direction at which stiffness is integrated and stress is evaluated.
    const STRESS_POINTS: usize;

    /// Positions of the nodes.
    fn positions(&self) -> &[[f64; 3]; N];

    /// Shape functions `N_a(ξ)`.
    fn shape_functions(xi: Natural) -> [f64; N];

    /// Derivatives `∂N_a/∂ξ` of the shape functions.
    fn shape_derivatives(xi: Natural) -> [Vector3<f64>; N];

    /// Jacobian matrix `J_ij = ∂x_i/∂ξ_j`.
    fn jacobian(&self, xi: Natural) -> Matrix3<f64> {
        let derivatives = Self::shape_derivatives(xi);
        self.positions().iter().zip(&derivatives).map(|(&x, dn)| Vector3::from(x) * dn.transpose()).sum()
    }

    /// Smallest det J over the corners and the integration points; NaN if any is NaN.
    fn smallest_jacobian(&self) -> f64 {
        let gauss = gauss_points(3).iter().map(|point| point.xi);
        let least = |least: f64, det: f64| if det < least || det.is_nan() { det } else { least };
        CORNERS.into_iter().chain(gauss).map(|xi| self.jacobian(xi).determinant()).fold(f64::INFINITY, least)
    }

    /// Gradients `∇N_a` in x, y, z, and det J.
    fn gradients(&self, xi: Natural) -> ([Vector3<f64>; N], f64) {
        let (turn, determinant) = inverse_transpose(&self.jacobian(xi));
        (Self::shape_derivatives(xi).map(|dn| turn * dn), determinant)
    }

    /// Elastic stiffness, per unit of displacement in x, y, z.
    fn stiffness(&self, material: &Material) -> Blocks<N> {
        let points = gauss_points(Self::STRESS_POINTS).iter().map(|point| {
            let (gradients, determinant) = self.gradients(point.xi);
            (gradients, determinant * point.weight)
        });
        elastic_blocks(points, material)
    }

    /// Stresses at the Gauss points of [`Self::STRESS_POINTS`] under the nodal displacements `u` (x, y, z).
    fn stresses(&self, material: &Material, u: &[Vector3<f64>; N]) -> Vec<Stress> {
        let stress = |point: &GaussPoint| {
            let (gradients, _) = self.gradients(point.xi);
            material.stress(&u.iter().zip(&gradients).map(|(u, g)| u * g.transpose()).sum())
        };
        gauss_points(Self::STRESS_POINTS).iter().map(stress).collect()
    }

    /// Consistent mass `m_ab = ∫ ρ N_a N_b dV` by 3 × 3 × 3 Gauss points.
    fn mass(&self, density: f64) -> NodalMatrix<N> {
        let mut mass = NodalMatrix::<N>::zeros();
        for point in gauss_points(3) {
            let n = SVector::<f64, N>::from(Self::shape_functions(point.xi));
            let determinant = self.jacobian(point.xi).determinant();
            mass += n * n.transpose() * (density * determinant * point.weight);
        }
        mass
    }

    /// Geometric stiffness `k_ab = ∫ ∇N_a · σ · ∇N_b dV`, with the `stresses` of [`Self::stresses`].
    fn geometric_stiffness(&self, stresses: &[Stress]) -> NodalMatrix<N> {
        let mut k = NodalMatrix::<N>::zeros();
        for (point, s) in gauss_points(Self::STRESS_POINTS).iter().zip(stresses) {
            let (gradients, determinant) = self.gradients(point.xi);
            let sigma = Matrix3::new(s[0], s[3], s[5], s[3], s[1], s[4], s[5], s[4], s[2]);
            let weighted = sigma * (determinant * point.weight);
            for a in 0..N {
                let traction = weighted * gradients[a];
                for b in 0..=a {
                    k[(a, b)] += traction.dot(&gradients[b]);
                }
            }
        }
        k.fill_upper_triangle_with_lower_triangle();
        k
    }
}

/// Elastic stiffness of displacement functions given by their gradients at weighted points.
pub(super) fn elastic_blocks<const F: usize>(
    points: impl Iterator<Item = ([Vector3<f64>; F], f64)>,
    material: &Material,
) -> Blocks<F> {
    let mut products = Box::new([[Matrix3::zeros(); F]; F]);
    for (gradients, weight) in points {
        for a in 0..F {
            let weighted = gradients[a] * weight;
            for b in 0..=a {
                products[a][b] += weighted * gradients[b].transpose();
            }
        }
    }
    let Lame { lambda, mu } = material.lame_constants();
    for a in 0..F {
        for b in 0..=a {
            let s = products[a][b];
            let block = s * lambda + (s.transpose() + Matrix3::identity() * s.trace()) * mu;
            products[a][b] = block;
            products[b][a] = block.transpose();
        }
    }
    products
}

/// Inverse transpose J⁻ᵀ and det J; zeros and 0 for a singular J (meshes are checked before anything is integrated).
pub(super) fn inverse_transpose(j: &Matrix3<f64>) -> (Matrix3<f64>, f64) {
    (j.try_inverse().unwrap_or_default().transpose(), j.determinant())
}
