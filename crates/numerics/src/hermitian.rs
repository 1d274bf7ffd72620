//! Eigenproblems of small dense Hermitian matrices and definite pencils.

use faer::linalg::triangular_solve::{solve_lower_triangular_in_place, solve_upper_triangular_in_place};
use faer::traits::ComplexField;
use faer::traits::ext::ComplexFieldExt;
use faer::{Mat, MatRef, Par, Side};

/// Reason why a pencil has no decomposition.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum EigenError {
    /// Mass matrix M that is not positive definite.
    #[error("the mass matrix is not positive definite")]
    MassNotPositiveDefinite,
    /// Iteration of the dense solver that did not converge.
    #[error("the dense eigenvalue iteration did not converge")]
    NotConverged,
}

/// Eigenpairs: λ ascending, eigenvectors orthonormal (for a pencil, in the mass inner product: Xᴴ M X = I).
#[derive(Debug, Clone)]
pub struct Eigenpairs<T> {
    /// Eigenvalues λ_m, ascending.
    pub values: Vec<f64>,
    /// Eigenvectors, `n × n`, one a column.
    pub vectors: Mat<T>,
}

/// All eigenpairs of a Hermitian matrix, by ascending eigenvalue, XᴴX = I.
///
/// faer's divide and conquer deflates against an absolute threshold (seen with 0.24.4: a matrix of norm 2.5e-9 came
/// back with eigenvectors good to seven digits), so the matrix is brought to norm one first, by a power of two.
pub(crate) fn eigenpairs<T: ComplexField<Real = f64>>(a: MatRef<'_, T>) -> Result<Eigenpairs<T>, EigenError> {
    let scale = power_of_two(a.norm_max());
    let eigen =
        scaled(a, 1.0 / scale).self_adjoint_eigen(Side::Lower).map_err(|_| EigenError::NotConverged)?;
    let values = (0..a.nrows()).map(|i| eigen.S()[i].real() * scale).collect();
    Ok(Eigenpairs { values, vectors: eigen.U().to_owned() })
}

/// All eigenvalues of a Hermitian matrix, ascending.
pub(crate) fn eigenvalues<T: ComplexField<Real = f64>>(a: MatRef<'_, T>) -> Result<Vec<f64>, EigenError> {
    let scale = power_of_two(a.norm_max());
    let values = scaled(a, 1.0 / scale).self_adjoint_eigenvalues(Side::Lower);
    Ok(values.map_err(|_| EigenError::NotConverged)?.into_iter().map(|v| v * scale).collect())
}

/// A power of two near `norm`; 1 where there is none.
fn power_of_two(norm: f64) -> f64 {
    if norm.is_normal() { norm.log2().floor().clamp(-1000.0, 1000.0).exp2() } else { 1.0 }
}

fn scaled<T: ComplexField<Real = f64>>(a: MatRef<'_, T>, factor: f64) -> Mat<T> {
    Mat::from_fn(a.nrows(), a.ncols(), |i, j| a[(i, j)].mul_real(factor))
}

/// All eigenpairs of K x = λ M x, both `n × n` Hermitian, M positive definite.
///
/// Uses M = L Lᴴ to reach the standard problem L⁻¹ K L⁻ᴴ; several times cheaper than QZ and keeps λ real.
pub(crate) fn generalised_eigenpairs<T: ComplexField<Real = f64>>(
    k: MatRef<'_, T>,
    m: MatRef<'_, T>,
) -> Result<Eigenpairs<T>, EigenError> {
    let (lower, standard) = standard_form(k, m)?;
    let Eigenpairs { values, mut vectors } = eigenpairs(standard.as_ref())?;
    solve_upper_triangular_in_place(lower.adjoint(), vectors.as_mut(), Par::Seq);
    Ok(Eigenpairs { values, vectors })
}

/// Eigenvalues of K x = λ M x, ascending.
pub(crate) fn generalised_eigenvalues<T: ComplexField<Real = f64>>(
    k: MatRef<'_, T>,
    m: MatRef<'_, T>,
) -> Result<Vec<f64>, EigenError> {
    let (_, standard) = standard_form(k, m)?;
    eigenvalues(standard.as_ref())
}

/// Matrices (L, L⁻¹ K L⁻ᴴ) with M = L Lᴴ.
fn standard_form<T: ComplexField<Real = f64>>(
    k: MatRef<'_, T>,
    m: MatRef<'_, T>,
) -> Result<(Mat<T>, Mat<T>), EigenError> {
    let lower = m.llt(Side::Lower).map_err(|_| EigenError::MassNotPositiveDefinite)?.L().to_owned();
    let mut half = k.to_owned();
    solve_lower_triangular_in_place(lower.as_ref(), half.as_mut(), Par::Seq);
    let mut standard = half.adjoint().to_owned();
    solve_lower_triangular_in_place(lower.as_ref(), standard.as_mut(), Par::Seq);
    Ok((lower, standard))
}

#[cfg(test)]
mod tests {
    use super::*;
    use faer::c64;

    /// Pencil with known λ: K = Yᴴ diag(λ) Y, M = Yᴴ Y for an invertible Y.
    #[test]
    fn finds_prescribed_eigenvalues_and_mass_orthonormal_vectors() {
        let lambda = [0.5, 2.0, 2.0, 7.0, 1e4];
        let y = Mat::from_fn(5, 5, |i, j| {
            c64::new(if i == j { 3.0 } else { 0.3 * (i as f64 - j as f64) }, 0.2 * (i * j) as f64)
        });
        let scaled = Mat::from_fn(5, 5, |i, j| y[(i, j)] * lambda[i]);
        let k = y.adjoint() * &scaled;
        let m = y.adjoint() * &y;
        let pairs = generalised_eigenpairs(k.as_ref(), m.as_ref()).unwrap();
        for (found, expected) in pairs.values.iter().zip(lambda) {
            // The pencil's condition (1e4 between eigenvalues, a few hundred in M) costs some six digits of 1e-16.
            assert!((found - expected).abs() < 1e-9 * expected.max(1.0), "{found} {expected}");
        }
        let identity = pairs.vectors.adjoint() * &m * &pairs.vectors;
        assert!((identity - Mat::<c64>::identity(5, 5)).norm_max() < 1e-11);
        assert_eq!(generalised_eigenvalues(k.as_ref(), m.as_ref()).unwrap().len(), 5);
    }

    /// Matrices of rank-one coupling of an arithmetic sequence, large enough for divide and conquer; tiny and huge norms.
    #[test]
    fn is_accurate_at_any_scale() {
        let n = 300;
        for scale in [1e-12, 1.0, 1e12] {
            let a = Mat::from_fn(n, n, |i, j| {
                let coupling = c64::new(1.0, (i as f64 - j as f64) * 0.01);
                scale * (coupling + if i == j { i as f64 * 1e-3 } else { 0.0 })
            });
            let pairs = eigenpairs(a.as_ref()).unwrap();
            let residual =
                &a * &pairs.vectors - Mat::from_fn(n, n, |i, j| pairs.vectors[(i, j)] * pairs.values[j]);
            assert!(residual.norm_max() < 1e-13 * a.norm_l2(), "{scale}: {:e}", residual.norm_max());
            for (a, b) in eigenvalues(a.as_ref()).unwrap().iter().zip(&pairs.values) {
                assert!((a - b).abs() < 1e-13 * scale * n as f64);
            }
        }
    }

    #[test]
    fn names_an_indefinite_mass() {
        let k = Mat::<f64>::identity(2, 2);
        let m = Mat::from_fn(2, 2, |i, j| if i == j { 1.0 - 2.0 * i as f64 } else { 0.0 });
        let error = generalised_eigenpairs(k.as_ref(), m.as_ref()).unwrap_err();
        assert_eq!(error, EigenError::MassNotPositiveDefinite);
    }
}
