//! Factors of small dense matrices, compiled in this crate once for each kind of numbers, and not again wherever they are called.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::{LltError, cholesky_in_place, cholesky_in_place_scratch};
use faer::linalg::solvers::{DenseSolveCore, Solve};
use faer::traits::ComplexField;
use faer::traits::ext::ComplexFieldExt;
use faer::{Mat, MatMut, MatRef, Par, Side, c64};

use super::hermitian::{self, EigenError, Eigenpairs};

/// Numbers of dense matrices: real or complex, in double precision.
pub trait Dense: ComplexField<Real = f64> {
    /// Inverse by LU with partial pivoting.
    fn inverse(a: MatRef<'_, Self>) -> Mat<Self>;

    /// Lower Cholesky factor L of A = L Lᴴ; none of a matrix that is not positive definite.
    fn lower_factor(a: MatRef<'_, Self>) -> Option<Mat<Self>>;

    /// Inverse by Cholesky; none of a matrix that is not positive definite.
    fn definite_inverse(a: MatRef<'_, Self>) -> Option<Mat<Self>>;

    /// Solution of A X = B by Cholesky; none of a matrix that is not positive definite.
    fn definite_solve(a: MatRef<'_, Self>, b: MatRef<'_, Self>) -> Option<Mat<Self>>;

    /// Replaces the lower triangle by that of the Cholesky factor.
    ///
    /// # Errors
    /// Row of the first pivot that is not positive.
    fn factor_in_place(a: MatMut<'_, Self>) -> Result<(), usize>;

    /// Number of negative eigenvalues of a Hermitian matrix, from the blocks of its Bunch–Kaufman factor.
    fn negative_eigenvalues(a: MatRef<'_, Self>) -> usize;

    /// All eigenpairs of a Hermitian matrix, by ascending eigenvalue, XᴴX = I.
    ///
    /// faer's divide and conquer deflates against an absolute threshold (seen with 0.24.4: a matrix of norm 2.5e-9 came
    /// back with eigenvectors good to seven digits), so the matrix is brought to norm one first, by a power of two.
    ///
    /// # Errors
    /// [`EigenError`].
    fn eigenpairs(a: MatRef<'_, Self>) -> Result<Eigenpairs<Self>, EigenError>;

    /// All eigenvalues of a Hermitian matrix, ascending.
    ///
    /// # Errors
    /// [`EigenError`].
    fn eigenvalues(a: MatRef<'_, Self>) -> Result<Vec<f64>, EigenError>;

    /// All eigenpairs of K x = λ M x, both `n × n` Hermitian, M positive definite.
    ///
    /// Uses M = L Lᴴ to reach the standard problem L⁻¹ K L⁻ᴴ; several times cheaper than QZ and keeps λ real.
    ///
    /// # Errors
    /// [`EigenError`].
    fn generalised_eigenpairs(
        k: MatRef<'_, Self>,
        m: MatRef<'_, Self>,
    ) -> Result<Eigenpairs<Self>, EigenError>;

    /// Eigenvalues of K x = λ M x, ascending.
    ///
    /// # Errors
    /// [`EigenError`].
    fn generalised_eigenvalues(k: MatRef<'_, Self>, m: MatRef<'_, Self>) -> Result<Vec<f64>, EigenError>;
}

macro_rules! dense {
    ($($number:ty),*) => {$(
        impl Dense for $number {
            fn inverse(a: MatRef<'_, Self>) -> Mat<Self> {
                a.partial_piv_lu().inverse()
            }

            fn lower_factor(a: MatRef<'_, Self>) -> Option<Mat<Self>> {
                Some(a.llt(Side::Lower).ok()?.L().to_owned())
            }

            fn definite_inverse(a: MatRef<'_, Self>) -> Option<Mat<Self>> {
                Some(a.llt(Side::Lower).ok()?.inverse())
            }

            fn definite_solve(a: MatRef<'_, Self>, b: MatRef<'_, Self>) -> Option<Mat<Self>> {
                Some(a.llt(Side::Lower).ok()?.solve(b))
            }

            fn factor_in_place(a: MatMut<'_, Self>) -> Result<(), usize> {
                cholesky(a)
            }

            fn negative_eigenvalues(a: MatRef<'_, Self>) -> usize {
                negative(a)
            }

            fn eigenpairs(a: MatRef<'_, Self>) -> Result<Eigenpairs<Self>, EigenError> {
                hermitian::eigenpairs(a)
            }

            fn eigenvalues(a: MatRef<'_, Self>) -> Result<Vec<f64>, EigenError> {
                hermitian::eigenvalues(a)
            }

            fn generalised_eigenpairs(
                k: MatRef<'_, Self>,
                m: MatRef<'_, Self>,
            ) -> Result<Eigenpairs<Self>, EigenError> {
                hermitian::generalised_eigenpairs(k, m)
            }

            fn generalised_eigenvalues(
                k: MatRef<'_, Self>,
                m: MatRef<'_, Self>,
            ) -> Result<Vec<f64>, EigenError> {
                hermitian::generalised_eigenvalues(k, m)
            }
        }
    )*};
}

dense!(f64, c64);

/// Eigenpair of a real matrix, which may be complex: value and vector.
#[derive(Debug, Clone)]
pub struct Eigenpair {
    /// Eigenvalue.
    pub value: c64,
    /// Eigenvector.
    pub vector: Vec<c64>,
}

/// All eigenpairs of a real matrix; none where the iteration did not converge.
pub fn real_eigenpairs(a: MatRef<'_, f64>) -> Option<Vec<Eigenpair>> {
    let pairs = a.eigen().ok()?;
    let vectors = pairs.U().col_iter().map(|vector| vector.iter().copied().collect());
    let values = pairs.S().column_vector().iter().copied();
    Some(values.zip(vectors).map(|(value, vector)| Eigenpair { value, vector }).collect())
}

fn cholesky<T: ComplexField>(matrix: MatMut<'_, T>) -> Result<(), usize> {
    let scratch = cholesky_in_place_scratch::<T>(matrix.nrows(), Par::Seq, faer::prelude::default());
    let stack = &mut MemBuffer::new(scratch);
    let factored = cholesky_in_place(
        matrix,
        faer::prelude::default(),
        Par::Seq,
        MemStack::new(stack),
        faer::prelude::default(),
    );
    factored.map(|_| ()).map_err(|LltError::NonPositivePivot { index }| index)
}

/// Number of negative eigenvalues of a Hermitian matrix, from the blocks of its Bunch–Kaufman factor.
fn negative<T: ComplexField<Real = f64>>(matrix: MatRef<'_, T>) -> usize {
    let factor = matrix.lblt(Side::Lower);
    let (diagonal, below) = (factor.B_diag().column_vector(), factor.B_subdiag().column_vector());
    let mut negative = 0;
    let mut i = 0;
    while i < matrix.nrows() {
        let (a, coupling) = (diagonal[i].real(), below[i].abs());
        if coupling == 0.0 {
            negative += usize::from(a < 0.0);
            i += 1;
        } else {
            let b = diagonal[i + 1].real();
            negative += if a * b < coupling * coupling {
                1
            } else if a < 0.0 {
                2
            } else {
                0
            };
            i += 2;
        }
    }
    negative
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inertia_of_an_indefinite_matrix() {
        // U diag(λ) Uᴴ with known signs; zero diagonal entries force 2 × 2 blocks.
        let n = 12;
        let start =
            Mat::from_fn(n, n, |i, j| c64::new(((i * 3 + j * j) as f64).sin(), ((i + 5 * j) as f64).cos()));
        let u = start.qr().compute_thin_Q();
        for negative in 0..=n {
            let scaled = Mat::from_fn(n, n, |i, j| {
                u[(i, j)] * (j as f64 + 1.0) * if j < negative { -1.0 } else { 1.0 }
            });
            assert_eq!(c64::negative_eigenvalues((scaled * u.adjoint()).as_ref()), negative);
        }
        let swap =
            Mat::from_fn(4, 4, |i, j| c64::new(0.0, if i + j == 3 { i as f64 - j as f64 } else { 0.0 }));
        assert_eq!(c64::negative_eigenvalues(swap.as_ref()), 2);
    }
}
