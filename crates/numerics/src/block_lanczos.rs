//! Extreme eigenpairs of a Hermitian operator by block Lanczos with full reorthogonalisation.

use faer::{Mat, MatRef, c64};

use super::hermitian::{EigenError, eigenpairs};

/// Ritz pairs, largest θ first.
#[derive(Debug, Clone)]
pub struct Ritz {
    /// θ.
    pub values: Vec<f64>,
    /// Coefficients in the basis, one pair a column.
    pub coefficients: Mat<c64>,
    /// ‖A y − θ y‖/θ of each pair.
    pub errors: Vec<f64>,
}

/// The orthonormal Krylov basis of a Hermitian operator A and the operator projected on it.
///
/// The caller applies A: it asks for [`last_block`](Self::last_block), hands its image to
/// [`absorb`](Self::absorb), looks at the [`ritz`](Self::ritz) pairs and goes on with [`extend`](Self::extend).
#[derive(Debug, Clone)]
pub struct BlockLanczos {
    block: usize,
    vectors: Mat<c64>,
    columns: usize,
    /// Vectors there is memory for.
    room: usize,
    projected: Mat<c64>,
    /// A times the last block, orthogonalised against the basis.
    remainder: Mat<c64>,
}

impl BlockLanczos {
    /// Starts with `block` ≤ `n` fixed vectors without structure. They are real, so a real operator keeps a real basis.
    pub fn new(n: usize, block: usize) -> Self {
        let start = pseudo_random(n, block);
        let vectors = start.qr().compute_thin_Q();
        Self { block, vectors, columns: block, room: block, projected: Mat::new(), remainder: Mat::new() }
    }

    /// Vectors of the basis.
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// Whether another block would not fit into the whole space.
    pub fn is_full(&self) -> bool {
        self.columns + self.block > self.vectors.nrows()
    }

    /// The vectors whose image is due, `n × block`.
    pub fn last_block(&self) -> MatRef<'_, c64> {
        self.vectors.subcols(self.columns - self.block, self.block)
    }

    /// The vectors of `pairs`, `n × count`, orthonormal.
    pub fn assemble(&self, coefficients: MatRef<'_, c64>) -> Mat<c64> {
        self.vectors.subcols(0, self.columns) * coefficients
    }

    /// Records the image of the last block.
    ///
    /// In exact arithmetic it reaches back two blocks only; these are taken out first, so that one pass over the whole
    /// basis leaves it orthogonal to round-off.
    pub fn absorb(&mut self, mut image: Mat<c64>) {
        let near = self.columns.min(2 * self.block);
        let recent = self.vectors.subcols(self.columns - near, near);
        let first = recent.adjoint() * &image;
        image -= recent * &first;
        let known = self.vectors.subcols(0, self.columns);
        let mut coefficients = known.adjoint() * &image;
        image -= known * &coefficients;
        let mut recent = coefficients.subrows_mut(self.columns - near, near);
        recent += &first;
        let old = self.projected.nrows();
        self.projected.resize_with(self.columns, self.columns, |_, _| c64::new(0.0, 0.0));
        for j in 0..self.block {
            for i in 0..self.columns {
                self.projected[(i, old + j)] = coefficients[(i, j)];
                self.projected[(old + j, i)] = coefficients[(i, j)].conj();
            }
        }
        self.remainder = image;
    }

    /// The `count` Ritz pairs of largest θ, after [`absorb`](Self::absorb).
    pub fn ritz(&self, count: usize) -> Result<Ritz, EigenError> {
        let eigen = eigenpairs(self.projected.as_ref())?;
        let n = self.columns;
        let coefficients = Mat::from_fn(n, count, |i, m| eigen.vectors[(i, n - 1 - m)]);
        let values: Vec<f64> = (0..count).map(|m| eigen.values[n - 1 - m]).collect();
        // A y − θ y = remainder · (last block of coefficients).
        let gram = self.remainder.adjoint() * &self.remainder;
        let tail = coefficients.subrows(n - self.block, self.block);
        let square = |m: usize| (tail.col(m).adjoint() * &gram * tail.col(m)).re.max(0.0);
        let errors = (0..count).map(|m| square(m).sqrt() / values[m]).collect();
        Ok(Ritz { values, coefficients, errors })
    }

    /// Takes what was new in the last image as the next block. Where it has lost rank (an invariant subspace is
    /// complete), the decomposition supplies other directions, which further passes make orthogonal to the basis.
    pub fn extend(&mut self) {
        let remainder = std::mem::replace(&mut self.remainder, Mat::new());
        let known = self.vectors.subcols(0, self.columns);
        let factor = remainder.qr();
        let size = |j: usize| factor.thin_R()[(j, j)].norm();
        let largest = (0..self.block).map(size).fold(0.0, f64::max);
        let mut next = factor.compute_thin_Q();
        if (0..self.block).any(|j| size(j) <= 1e-6 * largest) || largest <= 1e-12 * self.projected.norm_max()
        {
            for _ in 0..2 {
                let overlap = known.adjoint() * &next;
                next -= known * &overlap;
                next = next.qr().compute_thin_Q();
            }
        }
        let (n, old) = (self.vectors.nrows(), self.columns);
        if old + self.block > self.room {
            self.room = old + old / 2 + self.block;
            self.vectors.reserve(n, self.room);
        }
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
    use super::*;

    /// A diagonal operator whose spectrum 1/j² has every eigenvalue twice, as nodal diameters have in real form.
    #[test]
    fn finds_every_copy_of_double_eigenvalues() {
        let n = 600;
        let value = |i: usize| 1.0 / ((i / 2 + 1) as f64).powi(2);
        let mut lanczos = BlockLanczos::new(n, 4);
        let ritz = loop {
            let block = lanczos.last_block();
            lanczos.absorb(Mat::from_fn(n, 4, |i, j| block[(i, j)] * value(i)));
            if lanczos.columns() >= 20 {
                let ritz = lanczos.ritz(12).unwrap();
                if ritz.errors.iter().all(|&error| error < 1e-9) {
                    break ritz;
                }
            }
            lanczos.extend();
        };
        assert!(lanczos.columns() < 150, "{} vectors", lanczos.columns());
        let vectors = lanczos.assemble(ritz.coefficients.as_ref());
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
        let mut lanczos = BlockLanczos::new(9, 3);
        while {
            let block = lanczos.last_block().to_owned();
            lanczos.absorb(Mat::from_fn(9, 3, |i, j| block[(i, j)] * (i + 1) as f64));
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
