//! Second-order bending of a sector in a few shapes, everything else following statically.
//!
//! ```text
//! v_a = −K_c⁻¹ g_a,   A_ab = 2 V₄ + g_aᵀ v_b,   g_a = G(u_j, u_k), twice for j ≠ k       over v = 0 on the faces, ΨᵀK v = 0
//! C_ja = Ψ_jᵀ M v_a,   Γ_ab = v_aᵀ M v_b
//! ```
//!
//! M is that of the free displacements: what couples them to the cyclic faces, where v is 0, is left out.
//!
//! V₃ and V₄ are those of the shapes, V = V₃ + V₄ + ½ vᵀKv + vᵀg its minimum over v to fourth order in p: exact, for v is of second order.
//! The loads K u of the shapes do no work on v, as in [`super::relax`].

use faer::{ColRef, Mat, MatMut};
use nalgebra::Vector3;

use super::sector::HeldSector;
use rubmap_numerics::dense::Dense;
use rubmap_numerics::sparse_cholesky::SparseCholesky;
use rubmap_solid::green_lagrange::BUBBLES;
use rubmap_wheel::dynamics::bending::{EnergyForm, products};

/// Share of the largest eigenvalue of the shapes' energies below which a combination of them does no work.
const IDLE: f64 = 1e-12;

/// Second-order bending of some shapes.
#[derive(Debug)]
pub(super) struct Condensed {
    pub(super) potential: EnergyForm,
    pub(super) inertia: EnergyForm,
    /// Displacements v_a of all nodes, by product.
    pub(super) second_order: Vec<Vec<Vector3<f64>>>,
}

/// Condenses the shapes, displacements of all nodes.
pub(super) fn condense(
    sector: &HeldSector,
    factor: &SparseCholesky<'_, f64>,
    shapes: &[Vec<Vector3<f64>>],
) -> Condensed {
    let held = held(sector, factor, shapes);
    let of_elements = sector.of_elements(|_, nodes, element| {
        let still = [Vector3::zeros(); BUBBLES];
        let values: Vec<_> =
            shapes.iter().map(|shape| element.values(&HeldSector::at(nodes, shape), &still)).collect();
        element.energy_products(&values)
    });
    let count = products(shapes.len()).count();
    let (mut cubic, mut quartic) = (Mat::zeros(shapes.len(), count), Mat::<f64>::zeros(count, count));
    for (of_cubic, of_quartic) in of_elements {
        for a in 0..count {
            (0..shapes.len()).for_each(|j| cubic[(j, a)] += of_cubic[(j, a)]);
            (0..count).for_each(|b| quartic[(b, a)] += of_quartic[(b, a)]);
        }
    }
    let (mut loads, mut follows) = (Vec::with_capacity(count), Vec::with_capacity(count));
    for (j, k) in products(shapes.len()) {
        let twice = if j == k { 1.0 } else { 2.0 };
        let (mut free, mut beta) = sector.second_order_force(&shapes[j], &shapes[k]);
        free.iter_mut().for_each(|f| *f *= twice);
        beta.iter_mut().flatten().for_each(|f| *f *= twice);
        let mut moved = free.clone();
        factor.solve_in_place(MatMut::from_column_major_slice_mut(&mut moved, free.len(), 1));
        let along = &held * (held.transpose() * ColRef::from_slice(&free));
        moved.iter_mut().zip(along.iter()).for_each(|(v, along)| *v = along - *v);
        let inner: Vec<[Vector3<f64>; BUBBLES]> = (sector.elements.iter().zip(&beta))
            .map(|((_, element), force)| element.solve_bubbles(force).map(|beta| -beta))
            .collect();
        loads.push((free, beta));
        follows.push((moved, inner));
    }
    for (a, (free, beta)) in loads.iter().enumerate() {
        for (b, (moved, inner)) in follows.iter().enumerate() {
            let of_free: f64 = free.iter().zip(moved).map(|(f, v)| f * v).sum();
            let of_beta: f64 = beta.iter().flatten().zip(inner.iter().flatten()).map(|(f, v)| f.dot(v)).sum();
            quartic[(a, b)] += of_free + of_beta;
        }
    }
    let quartic = symmetric(&quartic);
    let moved: Mat<f64> = Mat::from_fn(sector.rows.len(), count, |row, a| follows[a].0[row]);
    let gathered: Vec<Vec<f64>> = shapes.iter().map(|shape| sector.gathered(shape)).collect();
    let gathered: Mat<f64> = Mat::from_fn(sector.rows.len(), shapes.len(), |row, j| gathered[j][row]);
    let mass_moved = &sector.mass * &moved;
    let gamma = symmetric(&(moved.transpose() * &mass_moved));
    Condensed {
        inertia: EnergyForm::new(&(gathered.transpose() * &mass_moved), &gamma),
        potential: EnergyForm::new(&cubic, &quartic),
        second_order: follows.iter().map(|(moved, _)| sector.spread(moved)).collect(),
    }
}

/// Symmetric part of a square matrix.
fn symmetric(of: &Mat<f64>) -> Mat<f64> {
    Mat::from_fn(of.nrows(), of.ncols(), |a, b| 0.5 * (of[(a, b)] + of[(b, a)]))
}

/// Vectors that the loads K u of the shapes deform, orthonormal in K.
pub(super) fn held(
    sector: &HeldSector,
    factor: &SparseCholesky<'_, f64>,
    shapes: &[Vec<Vector3<f64>>],
) -> Mat<f64> {
    let loads: Vec<Vec<f64>> = shapes.iter().map(|shape| sector.linear_force(shape)).collect();
    let load: Mat<f64> = Mat::from_fn(sector.rows.len(), shapes.len(), |row, j| loads[j][row]);
    let mut moved = load.clone();
    factor.solve_in_place(moved.as_mut());
    let energies: Mat<f64> = load.transpose() * &moved;
    let Ok(pairs) = Dense::eigenpairs(energies.as_ref()) else { return Mat::zeros(load.nrows(), 0) };
    let largest = pairs.values.last().copied().unwrap_or(0.0);
    let working: Vec<usize> =
        (0..pairs.values.len()).filter(|&at| pairs.values[at] > IDLE * largest).collect();
    Mat::from_fn(load.nrows(), working.len(), |row, at| {
        let (value, of) = (pairs.values[working[at]], pairs.vectors.col(working[at]));
        (0..shapes.len()).map(|j| moved[(row, j)] * of[j]).sum::<f64>() / value.sqrt()
    })
}
