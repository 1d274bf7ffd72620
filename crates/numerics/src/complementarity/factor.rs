//! Dense factors of a matrix on an active set; nothing is allocated once the reserve is there.

use super::ComplementarityError;

/// Solves with W restricted to an active set.
pub trait Factor: Default {
    /// Factorises W on the `active` indices from its entries W(i, j). After an error the factor is invalid.
    fn factorise(
        &mut self,
        entry: impl Fn(usize, usize) -> f64,
        active: &[usize],
    ) -> Result<(), ComplementarityError>;

    /// Solves in place.
    fn solve(&self, x: &mut [f64]);

    /// Round-off of g = q + Wλ, whose terms may be much larger than their sum where W is nearly singular.
    fn round_off(entry: impl Fn(usize, usize) -> f64, active: &[usize], lambda: &[f64]) -> f64;
}

/// Active indices whose factor is reserved beforehand; more of them at once make it grow, once.
const RESERVED: usize = 256;

/// Round-off of a sum relative to the magnitude of its terms.
const ROUND_OFF: f64 = 4.0 * f64::EPSILON;

/// Cholesky factor W = LLᵀ, for symmetric positive definite W.
#[derive(Debug, Clone)]
pub struct Cholesky {
    /// Factor L, packed row by row.
    lower: Vec<f64>,
}

impl Default for Cholesky {
    fn default() -> Self {
        Self { lower: Vec::with_capacity(RESERVED * (RESERVED + 1) / 2) }
    }
}

impl Factor for Cholesky {
    #[inline(always)]
    fn factorise(
        &mut self,
        entry: impl Fn(usize, usize) -> f64,
        active: &[usize],
    ) -> Result<(), ComplementarityError> {
        self.lower.clear();
        for (i, &row) in active.iter().enumerate() {
            for (j, &column) in active[..=i].iter().enumerate() {
                let mut value = entry(row, column);
                let (head, current) = self.lower.split_at(i * (i + 1) / 2);
                let other = if j < i { &head[j * (j + 1) / 2..][..=j] } else { current };
                for (a, b) in current[..j].iter().zip(other) {
                    value -= a * b;
                }
                let next = if j < i {
                    value / other[j]
                } else if value > 0.0 {
                    value.sqrt()
                } else {
                    return Err(ComplementarityError::NotPositiveDefinite { active: active.len() });
                };
                self.lower.push(next);
            }
        }
        Ok(())
    }

    #[inline(always)]
    fn solve(&self, x: &mut [f64]) {
        for i in 0..x.len() {
            let row = &self.lower[i * (i + 1) / 2..][..=i];
            let known: f64 = row[..i].iter().zip(&*x).map(|(l, x)| l * x).sum();
            x[i] = (x[i] - known) / row[i];
        }
        for i in (0..x.len()).rev() {
            let row = &self.lower[i * (i + 1) / 2..][..=i];
            x[i] /= row[i];
            let value = x[i];
            for (above, l) in x[..i].iter_mut().zip(row) {
                *above -= l * value;
            }
        }
    }

    /// Bound by |W(i, j)|² < W(i, i) W(j, j): the diagonal bounds every term.
    fn round_off(entry: impl Fn(usize, usize) -> f64, active: &[usize], lambda: &[f64]) -> f64 {
        let terms = active.iter().zip(lambda).map(|(&i, lambda)| entry(i, i) * lambda.abs());
        ROUND_OFF * terms.sum::<f64>()
    }
}

/// Factor PW = LU with partial pivoting, for any W.
#[derive(Debug, Clone)]
pub struct Lu {
    /// Factors L below the diagonal (its own is 1) and U, row-major.
    factor: Vec<f64>,
    /// Row that was exchanged with row k at step k.
    exchanged: Vec<usize>,
}

impl Default for Lu {
    fn default() -> Self {
        Self { factor: Vec::with_capacity(RESERVED * RESERVED), exchanged: Vec::with_capacity(RESERVED) }
    }
}

impl Factor for Lu {
    /// Refuses a block whose determinant is not positive: W is then no P-matrix.
    fn factorise(
        &mut self,
        entry: impl Fn(usize, usize) -> f64,
        active: &[usize],
    ) -> Result<(), ComplementarityError> {
        let n = active.len();
        self.factor.clear();
        self.exchanged.clear();
        for &row in active {
            self.factor.extend(active.iter().map(|&column| entry(row, column)));
        }
        let mut positive = true;
        for k in 0..n {
            let size = |row: usize| self.factor[row * n + k].abs();
            let largest = (k + 1..n).fold(k, |best, row| if size(row) > size(best) { row } else { best });
            self.exchanged.push(largest);
            let (above, below) = self.factor.split_at_mut((k + 1) * n);
            let pivots = &mut above[k * n..];
            if largest != k {
                pivots.swap_with_slice(&mut below[(largest - k - 1) * n..][..n]);
                positive = !positive;
            }
            let pivot = pivots[k];
            positive ^= pivot < 0.0;
            if pivot == 0.0 || !pivot.is_finite() {
                return Err(ComplementarityError::NotPMatrix { active: n });
            }
            for row in below.chunks_exact_mut(n) {
                let factor = row[k] / pivot;
                row[k] = factor;
                for (value, above) in row[k + 1..].iter_mut().zip(&pivots[k + 1..]) {
                    *value -= factor * above;
                }
            }
        }
        if positive { Ok(()) } else { Err(ComplementarityError::NotPMatrix { active: n }) }
    }

    #[inline(always)]
    fn solve(&self, x: &mut [f64]) {
        let n = x.len();
        for (k, &row) in self.exchanged.iter().enumerate() {
            x.swap(k, row);
        }
        for i in 1..n {
            let known: f64 = self.factor[i * n..][..i].iter().zip(&*x).map(|(l, x)| l * x).sum();
            x[i] -= known;
        }
        for i in (0..n).rev() {
            let row = &self.factor[i * n..][..n];
            let known: f64 = row[i + 1..].iter().zip(&x[i + 1..]).map(|(u, x)| u * x).sum();
            x[i] = (x[i] - known) / row[i];
        }
    }

    fn round_off(entry: impl Fn(usize, usize) -> f64, active: &[usize], lambda: &[f64]) -> f64 {
        let largest = |j: usize| active.iter().fold(0.0f64, |most, &i| most.max(entry(i, j).abs()));
        let terms = active.iter().zip(lambda).map(|(&j, lambda)| largest(j) * lambda.abs());
        ROUND_OFF * terms.sum::<f64>()
    }
}
