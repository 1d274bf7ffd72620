//! Contact with obstacles that give way: λ_i = law_i(x_i) at every index, x = −(q + Wλ) being the penetrations.
//!
//! The laws are monotone and piecewise linear ([`BilinearLaw`]). A candidate gives every index one branch of its law; as on an
//! active set the forces then follow from one factorisation,
//!
//! ```text
//! (W + diag(dx/dλ)) λ = −(q + x(λ = 0))        over the indices with a force
//! ```
//!
//! Indices whose point lies beyond the ends of their branch all change it at once, and after a few steps without progress the last
//! of them alone moves to the neighbouring branch. Those single moves end for every P-matrix W, by the argument of Murty's
//! rule: with all indices before it solved, the penetration of an index falls strictly as its force grows, so that a point
//! above a branch means a solution above it, and no branch is tried twice. Block moves are those of Júdice and Pires with bounds
//! (Computers & Operations Research 19, 1992), or of Newton's method.

use super::active_set::PivotStatistics;
use super::factor::{Cholesky, Factor};
use super::law::{BilinearLaw, Branch, Side};
use super::{ComplementarityError, ContactOperator, any_below};

/// Solver with its workspace and the last branches; F factorises W plus a diagonal.
#[derive(Debug, Clone)]
pub struct BranchSolver<F: Factor = Cholesky> {
    branches: Vec<Branch>,
    active: Vec<usize>,
    /// Law of every active index, and (x at λ = 0, dx/dλ) of its branch.
    laws: Vec<BilinearLaw>,
    lines: Vec<(f64, f64)>,
    lambda: Vec<f64>,
    gap: Vec<f64>,
    /// Index, its side of the branch it is on, and the branch that a block move takes it to.
    violated: Vec<(usize, Side, Branch)>,
    /// Index and dx/dλ of every active index that `factor` was made for.
    factored: Vec<(usize, f64)>,
    /// Compliance dx/dλ of every index.
    compliance: Vec<f64>,
    factor: F,
    /// Whether W has changed since it was factored.
    stale: bool,
    statistics: PivotStatistics,
}

/// Block moves without progress before single moves begin.
const GRACE: usize = 3;

/// Gaps checked together.
const CHUNK: usize = 8;

impl<F: Factor> BranchSolver<F> {
    /// A solver for problems of `size` indices.
    pub fn new(size: usize) -> Self {
        Self {
            branches: vec![Branch::Open; size],
            active: Vec::with_capacity(size),
            laws: Vec::with_capacity(size),
            lines: Vec::with_capacity(size),
            lambda: Vec::with_capacity(size),
            gap: vec![0.0; size],
            violated: Vec::with_capacity(size),
            factored: Vec::with_capacity(size),
            compliance: vec![0.0; size],
            factor: F::default(),
            stale: false,
            statistics: PivotStatistics::default(),
        }
    }

    /// Solves for `q` (entries of +∞ never touch), `law(i)` being that of index i. Branches are extended by `tolerance` at their ends;
    /// forces are never negative.
    #[inline(always)]
    pub fn solve<W: ContactOperator>(
        &mut self,
        w: &W,
        law: impl Fn(usize) -> BilinearLaw,
        q: &[f64],
        tolerance: f64,
    ) -> Result<(), ComplementarityError> {
        if !any_below(q, 0.0) {
            self.clear();
            self.gap.copy_from_slice(q);
            return Ok(());
        }
        self.statistics.problems += 1;
        let limit = 100 + 30 * w.size();
        let (mut fewest, mut grace) = (usize::MAX, GRACE);
        for _ in 0..limit {
            self.statistics.candidates += 1;
            self.solve_branches(w, &law, q)?;
            let round_off = F::round_off(|i, j| w.entry(i, j), &self.active, &self.lambda);
            self.find_violated(&law, tolerance + round_off);
            if self.violated.is_empty() {
                return Ok(());
            }
            let mut single = false;
            if self.violated.len() < fewest {
                fewest = self.violated.len();
                grace = GRACE;
            } else if grace > 0 {
                grace -= 1;
            } else {
                single = true;
            }
            self.change_branches(single);
        }
        Err(ComplementarityError::NotSolved { pivots: limit })
    }

    /// Takes note that W has changed: a factor that was kept is of no use any more.
    pub fn operator_changed(&mut self) {
        self.stale = true;
    }

    /// Indices with a force, ascending.
    pub fn active(&self) -> &[usize] {
        &self.active
    }

    /// Forces λ of the active indices, in their order.
    pub fn lambda(&self) -> &[f64] {
        &self.lambda
    }

    /// Gaps −x = q + Wλ of every index that the forces could have brought near zero, q of the others.
    pub fn gap(&self) -> &[f64] {
        &self.gap
    }

    /// Work done so far.
    pub fn statistics(&self) -> PivotStatistics {
        self.statistics
    }

    fn clear(&mut self) {
        for &i in &self.active {
            self.branches[i] = Branch::Open;
        }
        self.active.clear();
        self.lambda.clear();
    }

    /// Solves for λ with every active index on the line of its branch, and for the gaps everywhere.
    #[inline(always)]
    fn solve_branches<W: ContactOperator>(
        &mut self,
        w: &W,
        law: &impl Fn(usize) -> BilinearLaw,
        q: &[f64],
    ) -> Result<(), ComplementarityError> {
        self.laws.clear();
        self.laws.extend(self.active.iter().map(|&i| law(i)));
        self.lines.clear();
        let lines = self.active.iter().zip(&self.laws).map(|(&i, law)| law.line(self.branches[i]));
        self.lines.extend(lines);
        let wanted = || self.active.iter().zip(&self.lines).map(|(&i, &(_, slope))| (i, slope));
        if self.stale || !wanted().eq(self.factored.iter().copied()) {
            self.factorise(w)?;
            self.stale = false;
        }
        self.lambda.clear();
        self.lambda.extend(self.active.iter().zip(&self.lines).map(|(&i, &(start, _))| -(q[i] + start)));
        self.factor.solve(&mut self.lambda);
        w.gaps(&self.active, &self.lambda, q, &mut self.gap);
        Ok(())
    }

    #[inline(never)]
    fn factorise<W: ContactOperator>(&mut self, w: &W) -> Result<(), ComplementarityError> {
        self.statistics.factorisations += 1;
        self.factored.clear();
        for (&i, &(_, slope)) in self.active.iter().zip(&self.lines) {
            self.compliance[i] = slope;
        }
        let compliance = &self.compliance;
        let entry = |i: usize, j: usize| w.entry(i, j) + if i == j { compliance[i] } else { 0.0 };
        self.factor.factorise(entry, &self.active)?;
        self.factored.extend(self.active.iter().zip(&self.lines).map(|(&i, &(_, slope))| (i, slope)));
        Ok(())
    }

    #[inline(never)]
    fn find_violated(&mut self, law: &impl Fn(usize) -> BilinearLaw, tolerance: f64) {
        self.violated.clear();
        let lines = self.laws.iter().zip(&self.lines).zip(&self.lambda);
        let mut active = self.active.iter().copied().zip(lines).peekable();
        for (number, chunk) in self.gap.chunks(CHUNK).enumerate() {
            let chunk_end = (number + 1) * CHUNK;
            // No law begins outside the obstacle: most gaps need no look of their own.
            if active.peek().is_none_or(|&(a, _)| a >= chunk_end) && !any_below(chunk, -tolerance) {
                continue;
            }
            for (i, &gap) in (number * CHUNK..).zip(chunk) {
                let (law, x, lambda) = match active.next_if(|&(a, _)| a == i) {
                    Some((_, ((law, (start, slope)), lambda))) => (*law, start + slope * lambda, *lambda),
                    None if gap >= -tolerance => continue,
                    None => (law(i), -gap, 0.0),
                };
                let branch = self.branches[i];
                let side = law.side(branch, x, lambda, tolerance);
                if side != Side::Within {
                    self.violated.push((i, side, law.jump(branch, x, lambda)));
                }
            }
        }
    }

    fn change_branches(&mut self, single: bool) {
        if single {
            if let Some(&(i, side, _)) = self.violated.last() {
                self.branches[i] = self.branches[i].neighbour(side);
            }
        } else {
            for &(i, _, next) in &self.violated {
                self.branches[i] = next;
            }
        }
        self.active.clear();
        let touching = |(i, &branch): (usize, &Branch)| (branch != Branch::Open).then_some(i);
        self.active.extend(self.branches.iter().enumerate().filter_map(touching));
    }
}
