//! The linear complementarity problem 0 ≤ λ ⊥ g = q + Wλ ≥ 0 for symmetric positive definite W, solved exactly.
//!
//! Block principal pivoting (Júdice and Pires, Computers & Operations Research 21, 1994): every candidate active set
//! is solved by a Cholesky factorisation, all violated indices change sides at once, and after a few steps without
//! progress single exchanges of the last violated index (Murty) guarantee an end. The search starts from the
//! previous solution's set, whose factor is kept: a contact that lasts costs one small solve a step.

/// A symmetric positive definite operator given by its entries.
pub trait SymmetricOperator {
    /// Rows (= columns).
    fn size(&self) -> usize;

    /// W(i, j).
    fn entry(&self, i: usize, j: usize) -> f64;

    /// `gap` = q + Wλ, λ given at the `active` indices and zero elsewhere. Entries that are positive whatever the signs of
    /// W's entries may keep the value of q instead: the solver needs to know no more of them.
    fn gaps(&self, active: &[usize], lambda: &[f64], q: &[f64], gap: &mut [f64]);
}

/// No solution was found.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum ComplementarityError {
    /// W restricted to an active set is not positive definite.
    #[error("the contact operator is not positive definite on {active} active nodes")]
    NotPositiveDefinite {
        /// Size of the active set.
        active: usize,
    },
    /// The pivoting did not end within its bound: round-off is larger than the tolerance.
    #[error("the contact problem was not solved in {pivots} pivoting steps")]
    NotSolved {
        /// Pivoting steps taken.
        pivots: usize,
    },
    /// No forces keep all gaps open: nodes are pressed against each other, which a singular W cannot resolve.
    #[error("no contact forces keep all gaps open: {penetration:.1e} of penetration is left")]
    Infeasible {
        /// Largest violation of a gap, length.
        penetration: f64,
    },
}

/// Work counters over the life of a solver.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct PivotStatistics {
    /// Problems that had a violated index to begin with.
    pub problems: u64,
    /// Candidate active sets examined.
    pub candidates: u64,
    /// Cholesky factorisations of an active block.
    pub factorisations: u64,
}

/// Solver with its workspace and the last active set.
#[derive(Debug, Clone)]
pub struct ActiveSetSolver {
    active: Vec<usize>,
    is_active: Vec<bool>,
    lambda: Vec<f64>,
    gap: Vec<f64>,
    violated: Vec<usize>,
    factored: Vec<usize>,
    factor: Vec<f64>,
    statistics: PivotStatistics,
}

/// Active indices whose factor is reserved beforehand; more of them at once make it grow, once.
const RESERVED: usize = 256;

/// Block exchanges without progress before single exchanges begin.
const GRACE: usize = 3;

impl ActiveSetSolver {
    /// A solver for problems of `size` indices.
    pub fn new(size: usize) -> Self {
        Self {
            active: Vec::with_capacity(size),
            is_active: vec![false; size],
            lambda: Vec::with_capacity(size),
            gap: vec![0.0; size],
            violated: Vec::with_capacity(size),
            factored: Vec::with_capacity(size),
            factor: Vec::with_capacity(RESERVED * (RESERVED + 1) / 2),
            statistics: PivotStatistics::default(),
        }
    }

    /// Solves for `q` (entries of +∞ never become active). An inactive g counts as satisfied from −`tolerance`;
    /// multipliers are never negative.
    ///
    /// Inlined into the step loop, so that it is compiled for the machine's widest vectors too.
    #[inline(always)]
    pub fn solve<W: SymmetricOperator>(
        &mut self,
        w: &W,
        q: &[f64],
        tolerance: f64,
    ) -> Result<(), ComplementarityError> {
        let size = w.size();
        if !any_below(q, 0.0) {
            self.clear_active();
            self.gap.copy_from_slice(q);
            return Ok(());
        }
        self.statistics.problems += 1;
        let limit = 100 + 10 * size;
        let mut fewest = usize::MAX;
        let mut grace = GRACE;
        for _ in 0..limit {
            self.statistics.candidates += 1;
            self.solve_active(w, q)?;
            if !any_below(&self.lambda, 0.0) && !any_below(&self.gap, -tolerance) {
                return Ok(());
            }
            self.find_violated(tolerance + self.round_off(w));
            if self.violated.is_empty() {
                return Ok(());
            }
            if self.violated.len() < fewest {
                fewest = self.violated.len();
                grace = GRACE;
            } else if grace > 0 {
                grace -= 1;
            } else if let Some(&last) = self.violated.last() {
                self.violated.clear();
                self.violated.push(last);
            }
            self.exchange_violated();
        }
        Err(ComplementarityError::NotSolved { pivots: limit })
    }

    /// Active indices, ascending.
    pub fn active(&self) -> &[usize] {
        &self.active
    }

    /// λ of the active indices, in their order.
    pub fn lambda(&self) -> &[f64] {
        &self.lambda
    }

    /// g = q + Wλ of every index that the forces could have brought near zero, q of the others.
    pub fn gap(&self) -> &[f64] {
        &self.gap
    }

    /// Work done so far.
    pub fn statistics(&self) -> PivotStatistics {
        self.statistics
    }

    fn clear_active(&mut self) {
        for &i in &self.active {
            self.is_active[i] = false;
        }
        self.active.clear();
        self.lambda.clear();
    }

    /// Round-off of g = q + Wλ, whose terms may be much larger than their sum where W is nearly singular.
    fn round_off<W: SymmetricOperator>(&self, w: &W) -> f64 {
        let terms = self.active.iter().zip(&self.lambda).map(|(&i, lambda)| w.entry(i, i) * lambda.abs());
        4.0 * f64::EPSILON * terms.sum::<f64>()
    }

    /// λ with g = 0 on the active set, and g everywhere.
    #[inline(always)]
    fn solve_active<W: SymmetricOperator>(&mut self, w: &W, q: &[f64]) -> Result<(), ComplementarityError> {
        if self.factored != self.active {
            self.factorise(w)?;
        }
        let n = self.active.len();
        self.lambda.clear();
        self.lambda.extend(self.active.iter().map(|&i| -q[i]));
        for i in 0..n {
            let row = &self.factor[i * (i + 1) / 2..][..=i];
            let known: f64 = row[..i].iter().zip(&self.lambda).map(|(l, x)| l * x).sum();
            self.lambda[i] = (self.lambda[i] - known) / row[i];
        }
        for i in (0..n).rev() {
            let row = &self.factor[i * (i + 1) / 2..][..=i];
            self.lambda[i] /= row[i];
            let x = self.lambda[i];
            for (above, l) in self.lambda[..i].iter_mut().zip(row) {
                *above -= l * x;
            }
        }
        w.gaps(&self.active, &self.lambda, q, &mut self.gap);
        Ok(())
    }

    /// Packed row-wise Cholesky factor of W on the active set.
    #[inline(never)]
    fn factorise<W: SymmetricOperator>(&mut self, w: &W) -> Result<(), ComplementarityError> {
        self.statistics.factorisations += 1;
        self.factored.clear();
        self.factor.clear();
        for (i, &row) in self.active.iter().enumerate() {
            for (j, &column) in self.active[..=i].iter().enumerate() {
                let mut value = w.entry(row, column);
                let (head, current) = self.factor.split_at(i * (i + 1) / 2);
                let other = if j < i { &head[j * (j + 1) / 2..][..=j] } else { current };
                for (a, b) in current[..j].iter().zip(other) {
                    value -= a * b;
                }
                let entry = if j < i {
                    value / other[j]
                } else if value > 0.0 {
                    value.sqrt()
                } else {
                    return Err(ComplementarityError::NotPositiveDefinite { active: self.active.len() });
                };
                self.factor.push(entry);
            }
        }
        self.factored.extend_from_slice(&self.active);
        Ok(())
    }

    #[inline(never)]
    fn find_violated(&mut self, tolerance: f64) {
        self.violated.clear();
        let mut active = self.active.iter().zip(&self.lambda).peekable();
        for (i, &gap) in self.gap.iter().enumerate() {
            match active.peek() {
                Some(&(&a, &lambda)) if a == i => {
                    active.next();
                    if lambda < 0.0 {
                        self.violated.push(i);
                    }
                }
                _ if gap < -tolerance => self.violated.push(i),
                _ => {}
            }
        }
    }

    fn exchange_violated(&mut self) {
        for &i in &self.violated {
            self.is_active[i] = !self.is_active[i];
        }
        self.active.clear();
        self.active.extend(self.is_active.iter().enumerate().filter_map(|(i, &on)| on.then_some(i)));
    }
}

/// Whether any value is below `limit`: lane by lane and without an early exit, so that it vectorises.
#[inline(always)]
pub(crate) fn any_below(values: &[f64], limit: f64) -> bool {
    let mut lanes = [limit; 8];
    let mut chunks = values.chunks_exact(8);
    for chunk in &mut chunks {
        for (low, &value) in lanes.iter_mut().zip(chunk) {
            *low = if value < *low { value } else { *low };
        }
    }
    let mut below = chunks.remainder().iter().any(|&value| value < limit);
    for low in lanes {
        below |= low < limit;
    }
    below
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    struct Dense(Vec<Vec<f64>>);

    impl SymmetricOperator for Dense {
        fn size(&self) -> usize {
            self.0.len()
        }

        fn entry(&self, i: usize, j: usize) -> f64 {
            self.0[i][j]
        }

        fn gaps(&self, active: &[usize], lambda: &[f64], q: &[f64], gap: &mut [f64]) {
            for ((row, q), gap) in self.0.iter().zip(q).zip(gap) {
                *gap = q + active.iter().zip(lambda).map(|(&j, l)| row[j] * l).sum::<f64>();
            }
        }
    }

    /// Literal truth: tries every subset of up to 10 indices.
    fn enumerate(w: &Dense, q: &[f64]) -> Vec<f64> {
        let n = q.len();
        for set in 0..1usize << n {
            let active: Vec<_> = (0..n).filter(|i| set >> i & 1 == 1).collect();
            let block =
                nalgebra::DMatrix::from_fn(active.len(), active.len(), |a, b| w.0[active[a]][active[b]]);
            let rhs = nalgebra::DVector::from_fn(active.len(), |a, _| -q[active[a]]);
            let solved = if set == 0 { Some(rhs) } else { block.lu().solve(&rhs) };
            let Some(solved) = solved else { continue };
            let mut lambda = vec![0.0; n];
            for (a, &i) in active.iter().enumerate() {
                lambda[i] = solved[a];
            }
            let gap = |i: usize| q[i] + (0..n).map(|j| w.0[i][j] * lambda[j]).sum::<f64>();
            if lambda.iter().all(|&l| l >= -1e-9) && (0..n).all(|i| gap(i) >= -1e-9) {
                return lambda;
            }
        }
        unreachable!("a positive definite problem has a solution")
    }

    proptest! {
        /// W = AᵀA + εI from well conditioned to nearly singular, q of both signs; a sequence of problems shares one
        /// solver, so warm starts from unrelated sets are tried too.
        #[test]
        fn agrees_with_enumeration(
            n in 1usize..7,
            a in prop::collection::vec(-1.0f64..1.0, 49),
            ridge in prop::sample::select(vec![1.0, 1e-2, 1e-5]),
            qs in prop::collection::vec(-1.0f64..1.0, 28),
        ) {
            let dot = |i: usize, j: usize| (0..n).map(|k| a[7 * k + i] * a[7 * k + j]).sum::<f64>();
            let w = Dense((0..n).map(|i| (0..n).map(|j| dot(i, j) + if i == j { ridge } else { 0.0 }).collect()).collect());
            let mut solver = ActiveSetSolver::new(n);
            for q in qs.chunks_exact(7) {
                let q = &q[..n];
                solver.solve(&w, q, 1e-13).unwrap();
                let mut lambda = vec![0.0; n];
                for (&i, &l) in solver.active().iter().zip(solver.lambda()) {
                    prop_assert!(l >= 0.0);
                    lambda[i] = l;
                    // λg = 0, to the round-off of W λ.
                    prop_assert!((l * solver.gap()[i]).abs() < 1e-10 * (1.0 + l * l));
                }
                prop_assert!(solver.gap().iter().all(|&g| g >= -1e-9));
                let expected = enumerate(&w, q);
                for (found, expected) in lambda.iter().zip(&expected) {
                    prop_assert!((found - expected).abs() < 1e-7 / ridge, "{lambda:?} {expected:?}");
                }
            }
        }
    }

    #[test]
    fn keeps_a_lasting_contact_factored() {
        let w = Dense(vec![vec![2.0, -0.5], vec![-0.5, 1.0]]);
        let mut solver = ActiveSetSolver::new(2);
        for step in 0..100 {
            solver.solve(&w, &[-1.0 - 0.01 * f64::from(step), -0.5], 1e-14).unwrap();
            assert_eq!(solver.active(), [0, 1]);
        }
        assert_eq!(solver.statistics().factorisations, 1);
    }
}
