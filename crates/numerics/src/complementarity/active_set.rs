//! Block principal pivoting (Júdice and Pires, Computers & Operations Research 21, 1994).
//!
//! Every candidate active set is solved by a factorisation, all violated indices change sides at once, and after a few steps
//! without progress single exchanges of the last violated index (Murty) guarantee an end for every P-matrix. The search
//! starts from the previous solution's set, whose factor is kept: a contact that lasts costs one small solve a step.

use super::factor::{Cholesky, Factor};
use super::{ComplementarityError, ContactOperator, any_below};

/// Work counters over the life of a solver.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct PivotStatistics {
    /// Problems that began with a violated index.
    pub problems: u64,
    /// Candidate active sets examined.
    pub candidates: u64,
    /// Factorisations of an active block.
    pub factorisations: u64,
}

/// Solver with its workspace and the last active set; F factorises W on it.
#[derive(Debug, Clone)]
pub struct ActiveSetSolver<F: Factor = Cholesky> {
    active: Vec<usize>,
    is_active: Vec<bool>,
    lambda: Vec<f64>,
    gap: Vec<f64>,
    violated: Vec<usize>,
    factored: Vec<usize>,
    factor: F,
    /// Whether W has changed since it was factored.
    stale: bool,
    statistics: PivotStatistics,
}

/// Block exchanges without progress before single exchanges begin.
const GRACE: usize = 3;

impl<F: Factor> ActiveSetSolver<F> {
    /// A solver for problems of `size` indices.
    pub fn new(size: usize) -> Self {
        Self {
            active: Vec::with_capacity(size),
            is_active: vec![false; size],
            lambda: Vec::with_capacity(size),
            gap: vec![0.0; size],
            violated: Vec::with_capacity(size),
            factored: Vec::with_capacity(size),
            factor: F::default(),
            stale: false,
            statistics: PivotStatistics::default(),
        }
    }

    /// Solves for `q` (entries of +∞ never become active). An inactive g counts as satisfied from −`tolerance`;
    /// multipliers are never negative.
    ///
    /// Inlined into the step loop, so that it is compiled for the machine's widest vectors too.
    #[inline(always)]
    pub fn solve<W: ContactOperator>(
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
            let round_off = F::round_off(|i, j| w.entry(i, j), &self.active, &self.lambda);
            self.find_violated(tolerance + round_off);
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

    /// Takes note that W has changed: a factor that was kept is of no use any more.
    pub fn operator_changed(&mut self) {
        self.stale = true;
    }

    /// Active indices, ascending.
    pub fn active(&self) -> &[usize] {
        &self.active
    }

    /// Forces λ of the active indices, in their order.
    pub fn lambda(&self) -> &[f64] {
        &self.lambda
    }

    /// Gaps g = q + Wλ of every index that the forces could have brought near zero, q of the others.
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

    /// Solves for λ with g = 0 on the active set, and for g everywhere.
    #[inline(always)]
    fn solve_active<W: ContactOperator>(&mut self, w: &W, q: &[f64]) -> Result<(), ComplementarityError> {
        if self.stale || self.factored != self.active {
            self.factorise(w)?;
            self.stale = false;
        }
        self.lambda.clear();
        self.lambda.extend(self.active.iter().map(|&i| -q[i]));
        self.factor.solve(&mut self.lambda);
        w.gaps(&self.active, &self.lambda, q, &mut self.gap);
        Ok(())
    }

    #[inline(never)]
    fn factorise<W: ContactOperator>(&mut self, w: &W) -> Result<(), ComplementarityError> {
        self.statistics.factorisations += 1;
        self.factored.clear();
        self.factor.factorise(|i, j| w.entry(i, j), &self.active)?;
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
