//! Rank-revealing orthonormal basis of nearly dependent vectors in a mass inner product.

use faer::{Mat, MatRef, c64};

use super::hermitian::eigenpairs;

/// An M-orthonormal basis of the span of the columns of `vectors`, given `gram` = Vᴴ M V.
///
/// Directions whose singular value (square root of the Gram matrix's eigenvalue) is below `tolerance` times the
/// largest are dropped. Columns come out by decreasing singular value. `None` if the Gram matrix has no
/// decomposition (values not finite).
pub fn orthonormal_basis(
    vectors: MatRef<'_, c64>,
    gram: MatRef<'_, c64>,
    tolerance: f64,
) -> Option<Mat<c64>> {
    let eigen = eigenpairs(gram).ok()?;
    let n = gram.nrows();
    let largest = if n == 0 { 0.0 } else { eigen.values[n - 1] };
    let kept: Vec<usize> =
        (0..n).rev().filter(|&c| eigen.values[c] > tolerance * tolerance * largest).collect();
    let scaled =
        Mat::from_fn(n, kept.len(), |i, j| eigen.vectors[(i, kept[j])] / eigen.values[kept[j]].sqrt());
    Some(vectors * scaled)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keeps_the_rank_and_not_the_copies() {
        let one =
            Mat::from_fn(20, 4, |i, j| c64::new(((i * (j + 3)) as f64).sin(), ((i + 2 * j) as f64).cos()));
        let thrice = Mat::from_fn(20, 12, |i, j| one[(i, j % 4)] * (1.0 + 1e-9 * j as f64));
        let gram = thrice.adjoint() * &thrice;
        let basis = orthonormal_basis(thrice.as_ref(), gram.as_ref(), 1e-5).unwrap();
        assert_eq!(basis.ncols(), 4);
        let identity = basis.adjoint() * &basis;
        assert!((identity - Mat::<c64>::identity(4, 4)).norm_max() < 1e-10);
    }
}
