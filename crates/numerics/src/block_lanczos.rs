//! Extreme eigenpairs of a Hermitian operator by block Lanczos with full reorthogonalisation.

use faer::linalg::triangular_solve::solve_lower_triangular_in_place;
use faer::{Mat, MatRef, Par, Side, c64};

use super::hermitian::{EigenError, eigenpairs};
use super::vector_block::VectorBlock;

/// Ritz pairs, largest θ first.
#[derive(Debug, Clone)]
pub struct Ritz {
    /// Ritz values θ.
    pub values: Vec<f64>,
    /// Coefficients in the basis, one pair a column.
    pub coefficients: Mat<c64>,
    /// Relative errors ‖A y − θ y‖/θ of each pair.
    pub errors: Vec<f64>,
}

/// The orthonormal Krylov basis of a Hermitian operator A and the operator projected on it.
///
/// The caller applies A: it asks for [`last_block`](Self::last_block), hands its image to
/// [`absorb`](Self::absorb), looks at the [`ritz`](Self::ritz) pairs and goes on with [`extend`](Self::extend).
#[derive(Debug, Clone)]
pub struct BlockLanczos {
    block: usize,
    vectors: Vec<VectorBlock>,
    projected: Mat<c64>,
    /// A times the last block, orthogonalised against the basis.
    remainder: Option<VectorBlock>,
}

impl BlockLanczos {
    /// Starts with `block` ≤ `n` fixed vectors without structure. They are real: the modes of a `real` operator stay so.
    pub fn new(n: usize, block: usize, real: bool) -> Self {
        let start = pseudo_random(n, block).qr().compute_thin_Q();
        let vectors = vec![VectorBlock::of(start.as_ref(), real)];
        Self { block, vectors, projected: Mat::new(), remainder: None }
    }

    /// Number of vectors in the basis.
    pub fn columns(&self) -> usize {
        self.block * self.vectors.len()
    }

    /// Whether another block would not fit into the whole space.
    pub fn is_full(&self) -> bool {
        self.columns() + self.block > self.last_block().size()
    }

    /// Block of the vectors whose image is due.
    pub fn last_block(&self) -> &VectorBlock {
        &self.vectors[self.vectors.len() - 1]
    }

    /// The vectors with these `coefficients` in the basis, at most `most` in each block.
    pub fn assemble(&self, coefficients: MatRef<'_, c64>, most: usize) -> Vec<VectorBlock> {
        let last = self.last_block();
        let count = coefficients.ncols();
        let part = |first: usize| {
            let columns = coefficients.subcols(first, most.min(count - first));
            let mut assembled = VectorBlock::zeros(columns.ncols(), last.size(), last.is_real());
            assembled.add(&self.vectors, columns);
            assembled
        };
        (0..count).step_by(most).map(part).collect()
    }

    /// Records the image of the last block.
    ///
    /// In exact arithmetic the image reaches back two blocks only; these are taken out first, so that one pass over the whole basis leaves
    /// it orthogonal to round-off.
    pub fn absorb(&mut self, mut image: VectorBlock) {
        let recent = self.vectors.len().saturating_sub(2);
        let first = take_out(&mut image, &self.vectors[recent..]);
        let mut coefficients = take_out(&mut image, &self.vectors);
        let mut near = coefficients.subrows_mut(self.block * recent, first.nrows());
        near += first;
        let (old, columns) = (self.projected.nrows(), self.columns());
        self.projected.resize_with(columns, columns, |_, _| c64::new(0.0, 0.0));
        for j in 0..self.block {
            for i in 0..columns {
                self.projected[(i, old + j)] = coefficients[(i, j)];
                self.projected[(old + j, i)] = coefficients[(i, j)].conj();
            }
        }
        self.remainder = Some(image);
    }

    /// The `count` Ritz pairs of largest θ, after [`absorb`](Self::absorb).
    pub fn ritz(&self, count: usize) -> Result<Ritz, EigenError> {
        let eigen = eigenpairs(self.projected.as_ref())?;
        let n = self.projected.nrows();
        let coefficients = Mat::from_fn(n, count, |i, m| eigen.vectors[(i, n - 1 - m)]);
        let values: Vec<f64> = (0..count).map(|m| eigen.values[n - 1 - m]).collect();
        // A y − θ y = remainder · (last block of coefficients).
        let Some(remainder) = &self.remainder else { unreachable!("an image was absorbed") };
        let gram = gram(remainder);
        let tail = coefficients.subrows(n - self.block, self.block);
        let square = |m: usize| (tail.col(m).adjoint() * &gram * tail.col(m)).re.max(0.0);
        let errors = (0..count).map(|m| square(m).sqrt() / values[m]).collect();
        Ok(Ritz { values, coefficients, errors })
    }

    /// Takes what was new in the last image as the next block. Where it has lost rank (an invariant subspace is
    /// complete), other directions are taken, which further passes make orthogonal to the basis.
    pub fn extend(&mut self) {
        let Some(remainder) = self.remainder.take() else { return };
        let negligible = 1e-12 * self.projected.norm_max();
        let sizes = gram(&remainder);
        let found_any = (0..self.block).any(|j| sizes[(j, j)].re > negligible * negligible);
        let next = found_any
            .then(|| orthonormalised(&remainder, 1e-6))
            .flatten()
            .and_then(|once| orthonormalised(&once, 0.5));
        self.vectors.push(next.unwrap_or_else(|| {
            let mut dense = Mat::zeros(remainder.size(), remainder.count());
            let mut next = remainder;
            for pass in 0..3 {
                if pass > 0 {
                    take_out(&mut next, &self.vectors);
                }
                next.copy_to(0, dense.as_mut());
                next = VectorBlock::of(dense.qr().compute_thin_Q().as_ref(), next.is_real());
            }
            next
        }));
    }
}

/// Takes V Vᴴ x out of the vectors x of `block`, for the vectors V of `known`; returns Vᴴ x.
fn take_out(block: &mut VectorBlock, known: &[VectorBlock]) -> Mat<c64> {
    let coefficients = block.products(known);
    block.add(known, (-&coefficients).as_ref());
    coefficients
}

fn gram(block: &VectorBlock) -> Mat<c64> {
    block.products(std::slice::from_ref(block))
}

/// The orthonormal block with the span of `block`, by the Cholesky factor of its Gram matrix; nothing where a diagonal entry of
/// the factor is at most `least` times the largest: the block has lost rank, or more digits than a second pass restores. Twice over
/// it is orthonormal to round-off (Yamamoto, Nakatsukasa, Yanagisawa and Fukaya, ETNA 44, 2015), in a fraction of the time of a
/// decomposition of the tall block.
fn orthonormalised(block: &VectorBlock, least: f64) -> Option<VectorBlock> {
    let factor = gram(block).llt(Side::Lower).ok()?;
    let lower = factor.L();
    let sizes = || (0..lower.ncols()).map(|j| lower[(j, j)].re);
    let largest = sizes().fold(0.0, f64::max);
    if !sizes().all(|size| size > least * largest) {
        return None;
    }
    let mut inverse = Mat::identity(lower.ncols(), lower.ncols());
    solve_lower_triangular_in_place(lower, inverse.as_mut(), Par::Seq);
    let mut orthonormal = VectorBlock::zeros(block.count(), block.size(), block.is_real());
    orthonormal.add(std::slice::from_ref(block), inverse.adjoint().to_owned().as_ref());
    Some(orthonormal)
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
    use super::*;

    /// The image of a diagonal operator.
    fn scaled(block: &VectorBlock, value: &dyn Fn(usize) -> f64) -> VectorBlock {
        let mut image = block.clone();
        for i in 0..block.size() {
            (0..block.count()).for_each(|j| image.set(i, j, block.get(i, j) * value(i)));
        }
        image
    }

    /// A diagonal operator whose spectrum 1/j² has every eigenvalue twice, as nodal diameters have in real form.
    #[test]
    fn finds_every_copy_of_double_eigenvalues() {
        let n = 600;
        let value = |i: usize| 1.0 / ((i / 2 + 1) as f64).powi(2);
        let mut lanczos = BlockLanczos::new(n, 4, false);
        let ritz = loop {
            lanczos.absorb(scaled(lanczos.last_block(), &value));
            if lanczos.columns() >= 20 {
                let ritz = lanczos.ritz(12).unwrap();
                if ritz.errors.iter().all(|&error| error < 1e-9) {
                    break ritz;
                }
            }
            lanczos.extend();
        };
        assert!(lanczos.columns() < 150, "{} vectors", lanczos.columns());
        let mut vectors = Mat::zeros(n, 12);
        for (part, block) in lanczos.assemble(ritz.coefficients.as_ref(), 5).iter().enumerate() {
            block.copy_to(0, vectors.subcols_mut(5 * part, block.count()));
        }
        for m in 0..12 {
            assert!((ritz.values[m] - value(m)).abs() < 1e-12);
            let residual: f64 = (0..n)
                .map(|i| (vectors[(i, m)] * (value(i) - ritz.values[m])).norm_sqr())
                .sum::<f64>()
                .sqrt();
            // The estimate is the residual.
            assert!((residual / ritz.values[m] - ritz.errors[m]).abs() < 1e-11);
        }
        assert!((vectors.adjoint() * &vectors - Mat::<c64>::identity(12, 12)).norm_max() < 1e-12);
    }

    #[test]
    fn fills_a_small_space() {
        for real in [false, true] {
            let mut lanczos = BlockLanczos::new(9, 3, real);
            while {
                lanczos.absorb(scaled(lanczos.last_block(), &|i| (i + 1) as f64));
                !lanczos.is_full()
            } {
                lanczos.extend();
            }
            let ritz = lanczos.ritz(9).unwrap();
            for (m, theta) in ritz.values.iter().enumerate() {
                assert!((theta - (9 - m) as f64).abs() < 1e-12);
            }
        }
    }

    /// Start that reaches two unknowns only: whatever follows must be other directions.
    #[test]
    fn goes_on_beyond_an_invariant_subspace() {
        let value = |i: usize| if i < 2 { 3.0 - i as f64 } else { 1.0 };
        let mut lanczos = BlockLanczos::new(8, 2, true);
        for _ in 0..3 {
            lanczos.absorb(scaled(lanczos.last_block(), &value));
            lanczos.extend();
        }
        lanczos.absorb(scaled(lanczos.last_block(), &value));
        let ritz = lanczos.ritz(8).unwrap();
        for (m, theta) in ritz.values.iter().enumerate() {
            assert!((theta - value(m)).abs() < 1e-12, "{m} {theta}");
        }
    }
}
