//! Lowest modes of a sector with held faces.

use faer::sparse::SparseColMat;
use faer::{Mat, MatMut, c64};

use rubmap_numerics::block_lanczos::BlockLanczos;
use rubmap_numerics::hermitian::EigenError;
use rubmap_numerics::sparse_cholesky::SparseCholesky;
use rubmap_numerics::vector_block::VectorBlock;

/// Vectors that are iterated together.
const BLOCK: usize = 4;

/// Largest relative error of an eigenvalue's residual: the modes carry a motion here and are no result.
const ERROR: f64 = 1e-6;

/// Modes Φ with ΦᵀKΦ = 1, of lowest frequency first, at most `count`: the largest eigenpairs of L⁻¹ M L⁻ᵀ, K = L Lᵀ.
///
/// # Errors
/// Eigenvalue iteration that fails.
pub(super) fn lowest_modes(
    factor: &SparseCholesky<'_, f64>,
    mass: &SparseColMat<usize, f64>,
    count: usize,
) -> Result<Mat<f64>, EigenError> {
    let size = mass.nrows();
    let count = count.min(size);
    let mass = factor.symbolic().permute(mass);
    let block = BLOCK.min(size);
    let mut lanczos = BlockLanczos::new(size, block, true);
    let coefficients = loop {
        let mut image = dense(lanczos.last_block());
        factor.lower_adjoint_solve_in_place(image.as_mut());
        image = &mass * &image;
        factor.lower_solve_in_place(image.as_mut());
        let image = Mat::from_fn(size, image.ncols(), |i, j| c64::new(image[(i, j)], 0.0));
        lanczos.absorb(VectorBlock::of(image.as_ref(), true));
        let full = lanczos.is_full();
        if lanczos.columns() >= count + block || full {
            let found = lanczos.ritz(count.min(lanczos.columns()))?;
            if full || found.errors.iter().all(|&error| error < ERROR) {
                break found.coefficients;
            }
        }
        lanczos.extend();
    };
    let mut modes = Mat::zeros(size, coefficients.ncols());
    let mut first = 0;
    for vectors in lanczos.assemble(coefficients.as_ref(), BLOCK) {
        let mut permuted = dense(&vectors);
        factor.lower_adjoint_solve_in_place(permuted.as_mut());
        let into: MatMut<'_, f64> = modes.subcols_mut(first, vectors.count());
        factor.scatter(permuted.as_ref(), into);
        first += vectors.count();
    }
    Ok(modes)
}

fn dense(block: &VectorBlock) -> Mat<f64> {
    Mat::from_fn(block.size(), block.count(), |row, column| block.get(row, column).re)
}
