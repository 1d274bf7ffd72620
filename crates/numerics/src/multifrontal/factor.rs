//! The factor of the inside of a matrix, and the Schur complement on its boundary.

use faer::Mat;
use faer::sparse::SparseColMat;
use rayon::iter::{IntoParallelRefIterator, ParallelIterator};

use super::analysis::Analysis;
use super::eliminate;
use super::eliminated::{Breakdown, Eliminated};

/// L, D and S of one matrix.
#[derive(Debug)]
pub struct PartialFactor<'a> {
    pub(super) analysis: &'a Analysis,
    /// Per front: its columns of L, pivot rows first; the strict upper triangle of the pivot rows means nothing.
    pub(super) lower: Vec<Mat<f64>>,
    /// D.
    pub(super) pivots: Vec<f64>,
    /// S, lower triangle.
    pub(super) schur: Mat<f64>,
}

impl<'a> PartialFactor<'a> {
    /// Factors Σ factor · matrix over `terms`: symmetric, in elimination order, with patterns inside the analysed one;
    /// entries on and below the diagonal are read.
    ///
    /// Subtrees of fronts run in parallel on the current rayon pool; every sum has one fixed order, so the result is
    /// the same bits on any number of threads.
    pub fn new(
        analysis: &'a Analysis,
        terms: &[(f64, &SparseColMat<usize, f64>)],
    ) -> Result<Self, Breakdown> {
        let fronts = &analysis.fronts;
        let mut lower: Vec<Mat<f64>> = (0..fronts.len()).map(|_| Mat::new()).collect();
        let mut pivots = vec![0.0; analysis.eliminated];
        let mut updates: Vec<Option<Mat<f64>>> = vec![None; fronts.len()];
        let mut keep = |done: Eliminated| {
            pivots[fronts[done.front].start..][..done.pivots.len()].copy_from_slice(&done.pivots);
            lower[done.front] = done.lower;
        };

        let run = |place: &mut eliminate::Place, subtree: &Vec<usize>| {
            let mut waiting: Vec<Option<Mat<f64>>> = vec![None; subtree.len()];
            let mut done = Vec::with_capacity(subtree.len());
            for (position, &front) in subtree.iter().enumerate() {
                // A subtree is a run of consecutive fronts that ends with its root.
                let child = |child: usize| waiting[child - subtree[0]].take();
                let (eliminated, update) = eliminate::eliminate(analysis, front, terms, child, place)?;
                waiting[position] = Some(update);
                done.push(eliminated);
            }
            Ok((done, waiting.pop().flatten()))
        };
        let answers: Vec<Result<_, Breakdown>> =
            analysis.subtrees.par_iter().map_init(|| eliminate::Place::new(analysis.size), run).collect();
        for (subtree, answer) in analysis.subtrees.iter().zip(answers) {
            let (done, update) = answer?;
            done.into_iter().for_each(&mut keep);
            if let Some(&root) = subtree.last() {
                updates[root] = update;
            }
        }
        let mut place = eliminate::Place::new(analysis.size);
        for &front in &analysis.top {
            let child = |child: usize| updates[child].take();
            let (eliminated, update) = eliminate::eliminate(analysis, front, terms, child, &mut place)?;
            keep(eliminated);
            updates[front] = Some(update);
        }
        let schur = eliminate::boundary(analysis, |front| updates[front].take());
        Ok(Self { analysis, lower, pivots, schur })
    }

    /// D, in elimination order.
    pub fn pivots(&self) -> &[f64] {
        &self.pivots
    }

    /// S = −A_FI A_II⁻¹ A_IF, lower triangle.
    pub fn schur(&self) -> &Mat<f64> {
        &self.schur
    }

    /// Negative eigenvalues of A_II (Sylvester).
    pub fn negative_pivots(&self) -> usize {
        self.pivots.iter().filter(|&&d| d < 0.0).count()
    }

    /// Largest Σ_j L_ij² |D_j| over the rows i of L and L_F: the size of the numbers that were subtracted from each
    /// other. Divided by the largest entry of A it bounds the loss of accuracy without pivoting; 1 where A is positive
    /// definite.
    pub fn growth(&self) -> f64 {
        let mut sums = vec![0.0; self.analysis.size];
        for (front, lower) in self.analysis.fronts.iter().zip(&self.lower) {
            for (j, column) in lower.col_iter().enumerate() {
                let d = self.pivots[front.start + j].abs();
                sums[front.start + j] += d;
                for i in j + 1..lower.nrows() {
                    sums[front.row(i)] += column[i] * column[i] * d;
                }
            }
        }
        sums.into_iter().fold(0.0, f64::max)
    }
}
