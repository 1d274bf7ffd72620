//! Reduction basis of one nodal diameter and the projection on it (Eqs 4–6).

use faer::sparse::SparseColMat;
use faer::{Mat, c64};

use super::untied::{Tie, UntiedSector};
use crate::dynamics::error::ModelError;
use rubmap_numerics::orthonormal::orthonormal_basis;

/// Basis Υ̂ of one nodal diameter as tied vectors: `[Ψ_s(0) Ψ*; I 0]`.
pub(super) struct Basis<'a> {
    untied: &'a UntiedSector,
    tie: Tie,
    vectors: Mat<c64>,
}

impl<'a> Basis<'a> {
    /// Basis from the static modes at rest (`n_i × n_b`) and the fixed-interface modes at every given speed (`n_i × k` each), made
    /// orthonormal in the `mass` inner product.
    pub(super) fn new(
        untied: &'a UntiedSector,
        mass: &SparseColMat<usize, f64>,
        tie: Tie,
        static_modes: &Mat<c64>,
        modes: &[&Mat<c64>],
        tolerance: f64,
    ) -> Result<Self, ModelError> {
        let (n_i, n_b) = (untied.internal(), untied.contact());
        let mut joint = Mat::zeros(n_i, modes.iter().map(|modes| modes.ncols()).sum());
        let mut first = 0;
        for modes in modes {
            joint.subcols_mut(first, modes.ncols()).copy_from(*modes);
            first += modes.ncols();
        }
        let gram = joint.adjoint() * untied.product(mass, &tie, joint.as_ref());
        let orthonormal = orthonormal_basis(joint.as_ref(), gram.as_ref(), tolerance)
            .ok_or(ModelError::MassNotPositiveDefinite { nodal_diameter: tie.harmonic })?;
        let mut vectors = Mat::zeros(n_i + n_b, n_b + orthonormal.ncols());
        vectors.submatrix_mut(0, 0, n_i, n_b).copy_from(static_modes);
        vectors.submatrix_mut(0, n_b, n_i, orthonormal.ncols()).copy_from(&orthonormal);
        vectors.submatrix_mut(n_i, 0, n_b, n_b).diagonal_mut().fill(c64::new(1.0, 0.0));
        Ok(Self { untied, tie, vectors })
    }

    /// Projects `matrix`, the untied Y, to Υ̂ᴴ Ŷ Υ̂, Hermitian to the last bit (Eq. 6).
    pub(super) fn project(&self, matrix: &SparseColMat<usize, f64>) -> Mat<c64> {
        let full = self.product(matrix);
        Mat::from_fn(full.nrows(), full.ncols(), |i, j| (full[(i, j)] + full[(j, i)].conj()) * 0.5)
    }

    /// Projects `transpose`, the untied Gᵀ = −G, to Υ̂ᴴ Ĝ Υ̂, skew-Hermitian to the last bit.
    pub(super) fn project_skew(&self, transpose: &SparseColMat<usize, f64>) -> Mat<c64> {
        let full = self.product(transpose);
        Mat::from_fn(full.nrows(), full.ncols(), |i, j| (full[(i, j)] - full[(j, i)].conj()) * 0.5)
    }

    /// Number of own DOF of the sector.
    pub(super) fn dofs(&self) -> usize {
        self.untied.place.len()
    }

    /// Row of own DOF `dof`.
    pub(super) fn row(&self, dof: usize) -> impl Iterator<Item = c64> + use<'_> {
        let (row, factor) = self.untied.tied_row(&self.tie, dof);
        (0..self.vectors.ncols()).map(move |column| self.vectors[(row, column)] * factor)
    }

    fn product(&self, transpose: &SparseColMat<usize, f64>) -> Mat<c64> {
        let image = self.untied.product(transpose, &self.tie, self.vectors.as_ref());
        self.vectors.adjoint() * image
    }
}
