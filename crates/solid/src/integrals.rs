//! Integrals over one element: elastic stiffness, mass, geometric stiffness, gyroscopic matrix.
//!
//! ```text
//! K_e = ∫ BᵀDB dV     M = ∫ ρ NᵀN dV     K_σ = ∫ ∇Nᵀ σ ∇N dV     G = 2 ∫ ρ Nᵀ[e×]N dV
//! ```
//!
//! Elements must be whole ([`crate::defect`]). Incompatible modes take part in elastic stiffness and stress alone, and are condensed
//! there: `K = K_uu − K_uα K_αα⁻¹ K_αu`. Mass and geometric stiffness have the functions of the nodes, so that they depend neither on the
//! material nor on speed.

use nalgebra::{DMatrix, Matrix3, Vector3};

use crate::blocks::Blocks;
use crate::element::ElementKind;
use crate::gradients::{Gradients, jacobian};
use crate::material::{Lame, Stress, tensor};
use crate::rule::{MassRule, mass_points};
use crate::shape::functions;

/// Elastic stiffness of an element of these node positions, per unit of displacement in x, y, z.
pub fn stiffness(kind: ElementKind, positions: &[[f64; 3]], constants: Lame) -> Blocks {
    let full = Gradients::of(kind, positions).elastic(constants);
    if !kind.has_bubbles() {
        return full;
    }
    let recovery = Gradients::recovery(&full);
    let nodes = positions.len();
    let mut condensed = Blocks::zeros(nodes);
    for a in 0..nodes {
        for b in 0..=a {
            let mut block = full[(a, b)];
            for bubble in 0..3 {
                block += full[(a, nodes + bubble)] * recovery.fixed_view::<3, 3>(3 * bubble, 3 * b);
            }
            condensed[(a, b)] = block;
            condensed[(b, a)] = block.transpose();
        }
    }
    condensed
}

/// Mass `m_ab = ∫ ρ N_a N_b dV`, the same in every direction, at the points of [`mass_points`].
pub fn mass(kind: ElementKind, positions: &[[f64; 3]], density: f64, rule: MassRule) -> DMatrix<f64> {
    let mut mass = DMatrix::zeros(positions.len(), positions.len());
    for point in mass_points(kind, rule) {
        let n = functions(kind, point.xi);
        let share = density * jacobian(kind, positions, point.xi).determinant() * point.weight;
        for (a, na) in n.iter().enumerate() {
            for (b, nb) in n.iter().enumerate() {
                mass[(a, b)] += na * nb * share;
            }
        }
    }
    mass
}

/// Geometric stiffness `k_ab = ∫ ∇N_a · σ · ∇N_b dV`, the same in every direction, with the stress at each point of
/// [`points`](crate::rule::points).
pub fn geometric_stiffness(kind: ElementKind, positions: &[[f64; 3]], stresses: &[Stress]) -> DMatrix<f64> {
    let nodes = positions.len();
    let gradients = Gradients::of(kind, positions);
    let mut k = DMatrix::zeros(nodes, nodes);
    for ((at_point, &volume), stress) in gradients.at_points.iter().zip(&gradients.volumes).zip(stresses) {
        let weighted = tensor(stress) * volume;
        for a in 0..nodes {
            let traction = weighted * at_point[a];
            for b in 0..=a {
                k[(a, b)] += traction.dot(&at_point[b]);
            }
        }
    }
    k.fill_upper_triangle_with_lower_triangle();
    k
}

/// Gyroscopic matrix per unit speed about the unit vector `axis`, `G_ab = 2 m_ab [e×]`, from the element's [`mass`]: Coriolis forces on the
/// left side of the equation of motion.
pub fn gyroscopic(mass: &DMatrix<f64>, axis: Vector3<f64>) -> Blocks {
    let twice_cross: Matrix3<f64> = axis.cross_matrix() * 2.0;
    Blocks::from_fn(mass.nrows(), |a, b| twice_cross * mass[(a, b)])
}

/// Centrifugal load per unit Ω², `f_a = Σ m_ab r_b` with r the distance of a node from the axis through `origin`: exactly `∫ ρ N_a r e_r dV`,
/// since position is interpolated like displacement.
pub fn centrifugal_load(
    mass: &DMatrix<f64>,
    positions: &[[f64; 3]],
    origin: Vector3<f64>,
    axis: Vector3<f64>,
) -> Vec<Vector3<f64>> {
    let from_axis = |x: &[f64; 3]| {
        let from_origin = Vector3::from(*x) - origin;
        from_origin - axis * axis.dot(&from_origin)
    };
    let arms: Vec<Vector3<f64>> = positions.iter().map(from_axis).collect();
    (0..positions.len()).map(|a| arms.iter().enumerate().map(|(b, arm)| arm * mass[(a, b)]).sum()).collect()
}
