//! Dense factor of the tied boundary: the part that one nodal diameter adds to the sector's real factor.

use faer::linalg::triangular_solve::{solve_lower_triangular_in_place, solve_upper_triangular_in_place};
use faer::prelude::ReborrowMut;
use faer::sparse::SparseColMat;
use faer::{Mat, MatMut, Par, c64};

use super::untied::{Tie, UntiedSector};
use rubmap_numerics::dense::Dense;

/// Error: a matrix that is not positive definite.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct NotPositiveDefinite {
    /// Tied row at which elimination found the error.
    pub(super) row: usize,
}

/// Factor L_S of one nodal diameter: low face first, contact DOF last.
pub(super) struct TiedFactor {
    pub(super) tie: Tie,
    /// Number of rows of the face.
    face: usize,
    /// Lower triangle, (face + contact)².
    lower: Mat<c64>,
    /// Whether the contact DOF may be free: the stiffness is positive definite with them too.
    pub(super) free: Result<(), NotPositiveDefinite>,
}

impl TiedFactor {
    /// Factors S(i). Fails where the stiffness with fixed contact DOF is not positive definite.
    pub(super) fn new(
        untied: &UntiedSector,
        eliminated: &Mat<f64>,
        stiffness: &SparseColMat<usize, f64>,
        tie: Tie,
    ) -> Result<Self, NotPositiveDefinite> {
        let mut lower = tied_schur(untied, eliminated, &[(1.0, stiffness)], &tie);
        let f = untied.face();
        let below =
            |first: usize| move |failed: NotPositiveDefinite| NotPositiveDefinite { row: first + failed.row };
        let (mut face, _, mut coupling, mut contact) = lower.as_mut().split_at_mut(f, f);
        cholesky(face.rb_mut(), &tie).map_err(below(untied.interior()))?;
        // L_bf = S_bf L_ff⁻ᴴ
        solve_lower_triangular_in_place(
            face.as_ref().conjugate(),
            coupling.rb_mut().transpose_mut(),
            Par::Seq,
        );
        let update = &coupling * coupling.as_ref().adjoint();
        contact -= &update;
        let free = cholesky(contact.rb_mut(), &tie).map_err(below(untied.internal()));
        Ok(Self { face: f, tie, lower, free })
    }

    /// Solves x_F ← L_S⁻¹ x_F for the boundary rows `x`, with those of the contact DOF or without.
    pub(super) fn solve(&self, x: MatMut<'_, c64>) {
        let lower = self.lower.submatrix(0, 0, x.nrows(), x.nrows());
        solve_lower_triangular_in_place(lower, x, Par::Seq);
    }

    /// Static shapes of unit displacements of the contact DOF one by one, the face in equilibrium with them (S_ff x_f = −S_fb), the
    /// interior still zero: tied vectors, `interior` rows before the boundary's.
    pub(super) fn at_unit_contact(&self, interior: usize) -> Mat<c64> {
        let f = self.face;
        let b = self.lower.nrows() - f;
        let mut vectors = Mat::zeros(interior + f + b, b);
        vectors.subrows_mut(interior + f, b).diagonal_mut().fill(c64::new(1.0, 0.0));
        // S_fb = L_ff L_bfᴴ
        let mut face = vectors.subrows_mut(interior, f);
        face.copy_from(self.lower.submatrix(f, 0, b, f).adjoint() * faer::Scale(c64::new(-1.0, 0.0)));
        solve_upper_triangular_in_place(self.lower.submatrix(0, 0, f, f).adjoint(), face, Par::Seq);
        vectors
    }

    /// Solves x_F ← L_S⁻ᴴ x_F for the boundary rows `x`, with those of the contact DOF or without.
    pub(super) fn solve_adjoint(&self, x: MatMut<'_, c64>) {
        let lower = self.lower.submatrix(0, 0, x.nrows(), x.nrows());
        solve_upper_triangular_in_place(lower.adjoint(), x, Par::Seq);
    }
}

/// Tied Schur complement S(i) = Tᴴ (A_FF − A_FI A_II⁻¹ A_IF) T over (face, contact), both triangles, for A = Σ factor · matrix over
/// `terms`; `eliminated` is the Schur complement that elimination of its interior leaves. Rows without motion have 1 on the diagonal.
pub(super) fn tied_schur(
    untied: &UntiedSector,
    eliminated: &Mat<f64>,
    terms: &[(f64, &SparseColMat<usize, f64>)],
    tie: &Tie,
) -> Mat<c64> {
    let rows = untied.boundary(tie);
    let size = untied.face() + untied.contact();
    let interior = untied.interior();
    let mut schur = Mat::zeros(size, size);
    let mut add = |p: usize, q: usize, value: f64| {
        let ((row, left), (column, right)) = (rows[p], rows[q]);
        schur[(row, column)] += left.conj() * right * value;
    };
    for q in 0..rows.len() {
        let column = interior + q;
        for (scale, matrix) in terms {
            for (row, &value) in matrix.row_idx_of_col(column).zip(matrix.val_of_col(column)) {
                if row >= interior {
                    add(row - interior, q, scale * value);
                }
            }
        }
        let eliminated = eliminated.col(q);
        add(q, q, eliminated[q]);
        for p in q + 1..rows.len() {
            add(p, q, eliminated[p]);
            add(q, p, eliminated[p]);
        }
    }
    untied.held(tie).into_iter().for_each(|row| schur[(row - interior, row - interior)] = c64::ONE);
    schur
}

/// Factorises `matrix` in place, lower Cholesky factor, rows of errors counted from its first; in real arithmetic, four times cheaper,
/// where the nodal diameter is real.
pub(super) fn cholesky(mut matrix: MatMut<'_, c64>, tie: &Tie) -> Result<(), NotPositiveDefinite> {
    if !UntiedSector::is_real(tie) {
        return c64::factor_in_place(matrix).map_err(|row| NotPositiveDefinite { row });
    }
    let mut real = Mat::from_fn(matrix.nrows(), matrix.ncols(), |i, j| matrix[(i, j)].re);
    f64::factor_in_place(real.as_mut()).map_err(|row| NotPositiveDefinite { row })?;
    for j in 0..matrix.ncols() {
        for i in j..matrix.nrows() {
            matrix[(i, j)] = c64::new(real[(i, j)], 0.0);
        }
    }
    Ok(())
}
