//! Lowest modes of a sparse Hermitian pencil by block shift-invert Lanczos, residuals checked.

use faer::sparse::SparseColMat;
use faer::{Mat, MatRef, c64};

use super::hermitian::{eigenpairs, generalised_eigenpairs};
use super::sparse_cholesky::SparseCholesky;
use super::sparse_product::sparse_product;

/// Settings of the iteration.
#[derive(Debug, Clone, Copy)]
pub struct LanczosOptions {
    /// Accepted ‖Kx − λMx‖/‖Kx‖ of every returned pair. 1e-8 in x is 1e-16 in λ; 1e-9 leaves a margin.
    pub tolerance: f64,
    /// Vectors advanced together; also the multiplicity of an eigenvalue found without luck.
    pub block: usize,
    /// At most this many block steps before giving up, or enough for four times the modes asked for.
    pub max_block_steps: usize,
}

impl Default for LanczosOptions {
    fn default() -> Self {
        Self { tolerance: 1e-9, block: 8, max_block_steps: 200 }
    }
}

/// Lowest eigenpairs of K x = λ M x.
#[derive(Debug, Clone)]
pub struct LowestModes {
    /// λ ascending.
    pub values: Vec<f64>,
    /// `n × count`, M-orthonormal columns.
    pub vectors: Mat<c64>,
    /// Largest ‖Kx − λMx‖/‖Kx‖ among them.
    pub largest_residual: f64,
    /// Block steps taken; 0 where the pencil was small enough for a dense solution.
    pub block_steps: usize,
}

/// Why no modes were returned.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum LanczosError {
    /// The tolerance was not reached.
    #[error("residual {residual:.1e} after {block_steps} block steps")]
    NotConverged {
        /// Largest residual at the end.
        residual: f64,
        /// Block steps done.
        block_steps: usize,
    },
    /// A mode without mass: M is singular on more of the space than the modes asked for leave out.
    #[error("a mode without mass")]
    Massless,
    /// A dense decomposition inside the iteration failed.
    #[error("a dense eigenvalue decomposition failed")]
    DenseFailed,
    /// The caller's `keep_going` said no.
    #[error("stopped")]
    Stopped,
}

/// Pencils up to this size are solved densely: the Krylov space would be most of the whole space.
const DENSE_SIZE: usize = 200;

/// The `count` lowest eigenpairs of K x = λ M x, with `factor` the Cholesky factor of K and M positive semidefinite.
///
/// Lanczos on L⁻¹ M L⁻ᴴ (largest θ = 1/λ first) with full reorthogonalisation; x = L⁻ᴴ y. `keep_going` is asked
/// before every block step. Deterministic.
pub fn lowest_modes(
    k: &SparseColMat<usize, c64>,
    m: &SparseColMat<usize, c64>,
    factor: &SparseCholesky<'_, c64>,
    count: usize,
    options: &LanczosOptions,
    keep_going: &dyn Fn() -> bool,
) -> Result<LowestModes, LanczosError> {
    let n = k.nrows();
    assert!(count <= n, "{count} modes of {n} unknowns");
    if n <= DENSE_SIZE.max(2 * count) {
        return dense(k, m, count, options.tolerance);
    }
    let permuted_mass = factor.symbolic().permute(m);
    let mut basis = Basis::new(n, options.block);
    let limit = options.max_block_steps.max(4 * count / options.block);
    let mut last = f64::INFINITY;
    for step in 1..=limit {
        if !keep_going() {
            return Err(LanczosError::Stopped);
        }
        let mut image = basis.last_block().to_owned();
        factor.lower_adjoint_solve_in_place(image.as_mut());
        let mut image = sparse_product(&permuted_mass, image.as_ref());
        factor.lower_solve_in_place(image.as_mut());
        let remainder = basis.project(image);
        let full = basis.columns() + options.block > n;
        // The dense projection costs more than a step once it is large: look at it every other step.
        if full || (basis.columns() >= 2 * count && step % 2 == 0) {
            let ritz = basis.ritz(count, &remainder)?;
            if ritz.largest_error <= options.tolerance * 0.1 || full {
                match assemble(k, m, factor, &basis, ritz, step, options.tolerance) {
                    Err(LanczosError::NotConverged { residual, .. }) if !full && step < limit => {
                        last = residual
                    }
                    ended => return ended,
                }
            } else {
                last = ritz.largest_error;
            }
        }
        basis.extend(remainder);
    }
    Err(LanczosError::NotConverged { residual: last, block_steps: limit })
}

/// The dense solution, on M x = θ K x like the iteration: the lowest modes are then accurate to round-off even where
/// M is nearly singular.
fn dense(
    k: &SparseColMat<usize, c64>,
    m: &SparseColMat<usize, c64>,
    count: usize,
    tolerance: f64,
) -> Result<LowestModes, LanczosError> {
    let pairs = generalised_eigenpairs(m.to_dense().as_ref(), k.to_dense().as_ref())
        .map_err(|_| LanczosError::DenseFailed)?;
    let n = k.nrows();
    let theta: Vec<f64> = (0..count).map(|j| pairs.values[n - 1 - j]).collect();
    let vectors = Mat::from_fn(n, count, |i, j| pairs.vectors[(i, n - 1 - j)]);
    accept(k, m, theta, vectors, 0, tolerance)
}

/// The modes of the Ritz pairs, if their residuals are small enough.
fn assemble(
    k: &SparseColMat<usize, c64>,
    m: &SparseColMat<usize, c64>,
    factor: &SparseCholesky<'_, c64>,
    basis: &Basis,
    ritz: Ritz,
    block_steps: usize,
    tolerance: f64,
) -> Result<LowestModes, LanczosError> {
    let mut permuted = basis.vectors.subcols(0, basis.columns()) * &ritz.coefficients;
    factor.lower_adjoint_solve_in_place(permuted.as_mut());
    let mut vectors = Mat::zeros(permuted.nrows(), permuted.ncols());
    factor.scatter(permuted.as_ref(), vectors.as_mut());
    accept(k, m, ritz.theta, vectors, block_steps, tolerance)
}

/// Normalises the solutions of M x = θ K x (xᴴKx = 1) to unit mass and checks their residuals.
fn accept(
    k: &SparseColMat<usize, c64>,
    m: &SparseColMat<usize, c64>,
    theta: Vec<f64>,
    mut vectors: Mat<c64>,
    block_steps: usize,
    tolerance: f64,
) -> Result<LowestModes, LanczosError> {
    if theta.iter().any(|&theta| theta.is_nan() || theta <= 0.0) {
        return Err(LanczosError::Massless);
    }
    for (j, theta) in theta.iter().enumerate() {
        let scale = 1.0 / theta.sqrt();
        for i in 0..vectors.nrows() {
            vectors[(i, j)] *= scale;
        }
    }
    let values: Vec<f64> = theta.iter().map(|theta| 1.0 / theta).collect();
    let residual = largest_residual(k, m, &values, vectors.as_ref(), tolerance);
    if residual <= tolerance {
        Ok(LowestModes { values, vectors, largest_residual: residual, block_steps })
    } else {
        Err(LanczosError::NotConverged { residual, block_steps })
    }
}

/// Largest ‖Kx − λMx‖/‖Kx‖ over the columns, NaN if any is. What the round-off of Kx alone may leave, 64 ε ‖|K||x|‖,
/// counts as the tolerance and no more: no eigensolver can do better on a stiffness of high contrast.
fn largest_residual(
    k: &SparseColMat<usize, c64>,
    m: &SparseColMat<usize, c64>,
    values: &[f64],
    vectors: MatRef<'_, c64>,
    tolerance: f64,
) -> f64 {
    let kx = sparse_product(k, vectors);
    let mx = sparse_product(m, vectors);
    let magnitude = |value: &c64| c64::new(value.norm(), 0.0);
    let mut magnitudes = k.clone();
    magnitudes.val_mut().iter_mut().for_each(|value| *value = magnitude(value));
    let terms = Mat::from_fn(vectors.nrows(), vectors.ncols(), |i, j| magnitude(&vectors[(i, j)]));
    let terms = sparse_product(&magnitudes, terms.as_ref());
    let norm =
        |column: &dyn Fn(usize) -> c64| (0..kx.nrows()).map(|i| column(i).norm_sqr()).sum::<f64>().sqrt();
    let ratio = |j: usize| {
        let residual = norm(&|i| kx[(i, j)] - mx[(i, j)] * values[j]);
        let round_off = 64.0 * f64::EPSILON * norm(&|i| terms[(i, j)]);
        residual / norm(&|i| kx[(i, j)]).max(round_off / tolerance)
    };
    (0..values.len()).map(ratio).fold(0.0, |worst, r| if r <= worst { worst } else { r })
}

/// Ritz pairs of the current basis.
struct Ritz {
    /// Largest θ first.
    theta: Vec<f64>,
    /// Coefficients in the basis, one pair a column.
    coefficients: Mat<c64>,
    /// Largest estimated ‖A y − θ y‖/θ.
    largest_error: f64,
}

/// The orthonormal Krylov basis and the operator projected on it.
struct Basis {
    block: usize,
    vectors: Mat<c64>,
    columns: usize,
    projected: Mat<c64>,
}

impl Basis {
    fn new(n: usize, block: usize) -> Self {
        let start = pseudo_random(n, block);
        let vectors = start.qr().compute_thin_Q();
        Self { block, vectors, columns: block, projected: Mat::zeros(0, 0) }
    }

    fn columns(&self) -> usize {
        self.columns
    }

    fn last_block(&self) -> MatRef<'_, c64> {
        self.vectors.subcols(self.columns - self.block, self.block)
    }

    /// Records the image of the last block in the projected operator; returns what is orthogonal to the basis.
    fn project(&mut self, mut image: Mat<c64>) -> Mat<c64> {
        let known = self.vectors.subcols(0, self.columns);
        let mut coefficients = known.adjoint() * &image;
        image -= known * &coefficients;
        let correction = known.adjoint() * &image;
        image -= known * &correction;
        coefficients += correction;
        let old = self.projected.nrows();
        self.projected.resize_with(self.columns, self.columns, |_, _| c64::new(0.0, 0.0));
        for j in 0..self.block {
            for i in 0..self.columns {
                self.projected[(i, old + j)] = coefficients[(i, j)];
                self.projected[(old + j, i)] = coefficients[(i, j)].conj();
            }
        }
        image
    }

    fn ritz(&self, count: usize, remainder: &Mat<c64>) -> Result<Ritz, LanczosError> {
        let eigen = eigenpairs(self.projected.as_ref()).map_err(|_| LanczosError::DenseFailed)?;
        let n = self.columns;
        let picked: Vec<usize> = (0..count).map(|m| n - 1 - m).collect();
        let theta: Vec<f64> = picked.iter().map(|&c| eigen.values[c]).collect();
        let coefficients = Mat::from_fn(n, count, |i, m| eigen.vectors[(i, picked[m])]);
        // A y − θ y = remainder · (last block of coefficients).
        let tail = remainder * coefficients.subrows(n - self.block, self.block);
        let error = |m: usize| tail.col(m).norm_l2() / theta[m];
        let largest_error = (0..count).map(error).fold(0.0, f64::max);
        Ok(Ritz { theta, coefficients, largest_error })
    }

    /// Orthonormalises `remainder` as the next block. Where it has lost rank (an invariant subspace is complete),
    /// the decomposition supplies other directions, which a second pass makes orthogonal to the basis.
    fn extend(&mut self, remainder: Mat<c64>) {
        let known = self.vectors.subcols(0, self.columns);
        let mut next = remainder.qr().compute_thin_Q();
        for _ in 0..2 {
            let overlap = known.adjoint() * &next;
            next -= known * &overlap;
            next = next.qr().compute_thin_Q();
        }
        let n = self.vectors.nrows();
        let old = self.columns;
        self.vectors.resize_with(n, old + self.block, |i, j| next[(i, j - old)]);
        self.columns += self.block;
    }
}

/// A fixed start block without structure (xorshift), the same on every run. It is real, so that the modes of a real
/// pencil come out real.
fn pseudo_random(n: usize, columns: usize) -> Mat<c64> {
    let mut state = 0x9E37_79B9_7F4A_7C15u64;
    let mut next = move || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1u64 << 53) as f64 - 0.5
    };
    Mat::from_fn(n, columns, |_, _| c64::new(next(), 0.0))
}

#[cfg(test)]
mod tests {
    use super::super::sparse_cholesky::SymbolicFactor;
    use super::*;
    use faer::sparse::Triplet;

    /// Fixed chain of n unit masses and springs: λ_m = 4 sin²(mπ/(2(n+1))); doubled on a block diagonal so that
    /// every eigenvalue is a pair.
    #[test]
    fn finds_every_copy_of_double_eigenvalues() {
        let n = 600;
        let mut k = Vec::new();
        for copy in 0..2 {
            for i in 0..n {
                let row = copy * n + i;
                k.push(Triplet::new(row, row, c64::new(2.0, 0.0)));
                if i + 1 < n {
                    k.push(Triplet::new(row + 1, row, c64::new(-1.0, 0.0)));
                    k.push(Triplet::new(row, row + 1, c64::new(-1.0, 0.0)));
                }
            }
        }
        let k = SparseColMat::try_new_from_triplets(2 * n, 2 * n, &k).unwrap();
        let m: Vec<_> = (0..2 * n).map(|i| Triplet::new(i, i, c64::new(1.0, 0.0))).collect();
        let m = SparseColMat::try_new_from_triplets(2 * n, 2 * n, &m).unwrap();
        let group: Vec<usize> = (0..2 * n).collect();
        let symbolic = SymbolicFactor::new(k.symbolic(), &group);
        let factor = SparseCholesky::new(&symbolic, &k).unwrap();
        let modes = lowest_modes(&k, &m, &factor, 20, &LanczosOptions::default(), &|| true).unwrap();
        for (index, value) in modes.values.iter().enumerate() {
            let mode = (index / 2 + 1) as f64;
            let exact = 4.0 * (mode * std::f64::consts::PI / (2.0 * (n as f64 + 1.0))).sin().powi(2);
            // ‖K‖/λ1 = 1.5e5 times round-off.
            assert!((value / exact - 1.0).abs() < 1e-10, "mode {index}: {value} {exact}");
        }
        assert!(modes.block_steps > 0 && modes.largest_residual < 1e-9);
        let gram = modes.vectors.adjoint() * (&m * &modes.vectors);
        assert!((gram - Mat::<c64>::identity(20, 20)).norm_max() < 1e-9);
    }
}
