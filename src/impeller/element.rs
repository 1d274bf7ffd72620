//! The 8-node hexahedron with incompatible modes (Wilson; Taylor, Beresford and Wilson, IJNME 10, 1976).
//!
//! Displacement `u = Σ N_a u_a + Σ P_b α_b` with the trilinear `N_a` and P = 1−ξ², 1−η², 1−ζ². The bubble
//! gradients are taken with the Jacobian of the element's centre, `∂P_b/∂x = (det J₀ / det J) J₀⁻ᵀ ∂P_b/∂ξ`, so
//! that `∫ ∂P_b/∂x dV = 0` on any element and constant strain is exact (patch test). α is condensed out element
//! by element: `K = K_uu − K_uα K_αα⁻¹ K_αu`, `α = −K_αα⁻¹ K_αu u`.
//!
//! Mass and geometric stiffness use the trilinear functions alone, as is usual for this element; both are then
//! free of Ω and of the elastic constants.

use nalgebra::{Matrix3, SMatrix, SVector, Vector3};

use super::material::Material;

/// Corner positions of an element.
pub type Corners = [[f64; 3]; 8];
/// A matrix over the 24 displacements of an element, node by node, (x, y, z) each.
pub type Matrix24 = SMatrix<f64, 24, 24>;
/// The 24 displacements of an element.
pub type Vector24 = SVector<f64, 24>;
/// `σ_xx, σ_yy, σ_zz, σ_xy, σ_yz, σ_zx` (engineering shear strains go with them).
pub type Stress = SVector<f64, 6>;
/// Stresses at the 2 × 2 × 2 Gauss points, in the order of [`gauss_points`].
pub type GaussStresses = [Stress; 8];

type Matrix9x24 = SMatrix<f64, 9, 24>;
type Matrix6x24 = SMatrix<f64, 6, 24>;
type Matrix6x9 = SMatrix<f64, 6, 9>;

/// Natural coordinates of the corners.
pub const CORNERS: [[f64; 3]; 8] = [
    [-1.0, -1.0, -1.0],
    [1.0, -1.0, -1.0],
    [1.0, 1.0, -1.0],
    [-1.0, 1.0, -1.0],
    [-1.0, -1.0, 1.0],
    [1.0, -1.0, 1.0],
    [1.0, 1.0, 1.0],
    [-1.0, 1.0, 1.0],
];

/// The 2 × 2 × 2 Gauss points (unit weights), in the order of [`CORNERS`].
pub fn gauss_points() -> [[f64; 3]; 8] {
    let g = 1.0 / 3.0_f64.sqrt();
    CORNERS.map(|corner| corner.map(|c| c * g))
}

/// `N_a(ξ) = Π (1 + ξ_a ξ)/2`.
fn shape_functions(xi: [f64; 3]) -> [f64; 8] {
    CORNERS.map(|c| (0..3).map(|d| 0.5 * (1.0 + c[d] * xi[d])).product())
}

/// `∂N_a/∂ξ`.
fn shape_derivatives(xi: [f64; 3]) -> [Vector3<f64>; 8] {
    CORNERS.map(|c| {
        let f = [0, 1, 2].map(|d| 0.5 * (1.0 + c[d] * xi[d]));
        Vector3::new(0.5 * c[0] * f[1] * f[2], 0.5 * c[1] * f[2] * f[0], 0.5 * c[2] * f[0] * f[1])
    })
}

/// `J = Σ x_a ⊗ ∂N_a/∂ξ`, `J_ij = ∂x_i/∂ξ_j`.
fn jacobian(x: &Corners, dn: &[Vector3<f64>; 8]) -> Matrix3<f64> {
    x.iter().zip(dn).map(|(x, dn)| Vector3::from(*x) * dn.transpose()).sum()
}

/// det J at a point of the element.
pub fn jacobian_determinant(x: &Corners, xi: [f64; 3]) -> f64 {
    jacobian(x, &shape_derivatives(xi)).determinant()
}

/// J⁻ᵀ and det J; a singular J gives zeros and 0 (meshes are checked before anything is integrated).
fn inverse_transpose(j: &Matrix3<f64>) -> (Matrix3<f64>, f64) {
    let determinant = j.determinant();
    (j.try_inverse().unwrap_or_default().transpose(), determinant)
}

/// The strain columns of a displacement function with gradient `g`, for directions x, y, z.
fn strain_columns(g: &Vector3<f64>) -> SMatrix<f64, 6, 3> {
    let (x, y, z) = (g.x, g.y, g.z);
    #[rustfmt::skip]
    let b = SMatrix::<f64, 6, 3>::new(
        x, 0.0, 0.0,
        0.0, y, 0.0,
        0.0, 0.0, z,
        y, x, 0.0,
        0.0, z, y,
        z, 0.0, x,
    );
    b
}

/// Strain operators of nodes and bubbles at one Gauss point, with det J.
fn strain_operators(x: &Corners, xi: [f64; 3]) -> (Matrix6x24, Matrix6x9, f64) {
    let dn = shape_derivatives(xi);
    let (jit, det) = inverse_transpose(&jacobian(x, &dn));
    let (jit0, det0) = inverse_transpose(&jacobian(x, &shape_derivatives([0.0; 3])));
    let mut b = Matrix6x24::zeros();
    for (a, dn) in dn.iter().enumerate() {
        b.fixed_view_mut::<6, 3>(0, 3 * a).copy_from(&strain_columns(&(jit * dn)));
    }
    let mut bubbles = Matrix6x9::zeros();
    for d in 0..3 {
        let mut dp = Vector3::zeros();
        dp[d] = -2.0 * xi[d];
        bubbles.fixed_view_mut::<6, 3>(0, 3 * d).copy_from(&strain_columns(&(jit0 * dp * (det0 / det))));
    }
    (b, bubbles, det)
}

/// `K_uu` and the recovery T with α = T u.
fn stiffness_parts(x: &Corners, material: &Material) -> (Matrix24, Matrix9x24) {
    let c = material.elasticity();
    let mut k_uu = Matrix24::zeros();
    let mut k_au = Matrix9x24::zeros();
    let mut k_aa = SMatrix::<f64, 9, 9>::zeros();
    for xi in gauss_points() {
        let (b, p, det) = strain_operators(x, xi);
        let cb = c * b * det;
        k_uu += b.transpose() * cb;
        k_au += p.transpose() * cb;
        k_aa += p.transpose() * (c * p) * det;
    }
    // K_αα is definite on any element with det J > 0; the fallback leaves the plain trilinear element.
    let recovery = k_aa.cholesky().map_or_else(Matrix9x24::zeros, |factor| -factor.solve(&k_au));
    (k_uu + k_au.transpose() * recovery, recovery)
}

/// Elastic stiffness with the incompatible modes condensed out.
pub fn stiffness(x: &Corners, material: &Material) -> Matrix24 {
    let (k, _) = stiffness_parts(x, material);
    0.5 * (k + k.transpose())
}

/// Nodal part of the consistent mass, `m_ab = ∫ ρ N_a N_b dV`, by 3 × 3 × 3 Gauss points (exact for any
/// hexahedron); the mass matrix is `m_ab` times the unit 3 × 3 block.
pub fn mass(x: &Corners, density: f64) -> SMatrix<f64, 8, 8> {
    let abscissae = [-(0.6_f64.sqrt()), 0.0, 0.6_f64.sqrt()];
    let weights = [5.0 / 9.0, 8.0 / 9.0, 5.0 / 9.0];
    let mut m = SMatrix::<f64, 8, 8>::zeros();
    for i in 0..3 {
        for j in 0..3 {
            for k in 0..3 {
                let xi = [abscissae[i], abscissae[j], abscissae[k]];
                let n = SVector::<f64, 8>::from(shape_functions(xi));
                let det = jacobian_determinant(x, xi);
                m += n * n.transpose() * (density * det * weights[i] * weights[j] * weights[k]);
            }
        }
    }
    m
}

/// Stresses at the Gauss points under the nodal displacements `u`: `σ = C (B u + B_α α)`.
pub fn stresses(x: &Corners, material: &Material, u: &Vector24) -> GaussStresses {
    let c = material.elasticity();
    let (_, recovery) = stiffness_parts(x, material);
    let alpha = recovery * u;
    gauss_points().map(|xi| {
        let (b, p, _) = strain_operators(x, xi);
        c * (b * u + p * alpha)
    })
}

/// Nodal part of the geometric stiffness, `k_ab = ∫ ∇N_a · σ · ∇N_b dV`; the matrix is `k_ab` times the unit 3 ×
/// 3 block.
pub fn geometric_stiffness(x: &Corners, stresses: &GaussStresses) -> SMatrix<f64, 8, 8> {
    let mut k = SMatrix::<f64, 8, 8>::zeros();
    for (xi, s) in gauss_points().into_iter().zip(stresses) {
        let dn = shape_derivatives(xi);
        let (jit, det) = inverse_transpose(&jacobian(x, &dn));
        let sigma = Matrix3::new(s[0], s[3], s[5], s[3], s[1], s[4], s[5], s[4], s[2]) * det;
        let gradients = dn.map(|dn| jit * dn);
        for a in 0..8 {
            let traction = sigma * gradients[a];
            for b in 0..8 {
                k[(a, b)] += traction.dot(&gradients[b]);
            }
        }
    }
    k
}

/// Expands a nodal 8 × 8 matrix to `m_ab` times the diagonal block `directions` (x, y, z).
pub fn expand_nodal(m: &SMatrix<f64, 8, 8>, directions: [f64; 3]) -> Matrix24 {
    let mut full = Matrix24::zeros();
    for a in 0..8 {
        for b in 0..8 {
            for (d, factor) in directions.iter().enumerate() {
                full[(3 * a + d, 3 * b + d)] = factor * m[(a, b)];
            }
        }
    }
    full
}
