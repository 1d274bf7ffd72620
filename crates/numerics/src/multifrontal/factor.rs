//! The factor of the inside of a matrix, and the Schur complement on its boundary.

use faer::sparse::SparseColMat;
use faer::{Mat, MatRef};
use rayon::iter::{IntoParallelRefIterator, ParallelIterator};

use super::analysis::{Analysis, Front};
use super::eliminate;
use super::eliminated::{Breakdown, Eliminated};
use super::slab::Slab;

/// Factors L and D and Schur complement S of one matrix.
#[derive(Debug)]
pub struct PartialFactor<'a> {
    pub(super) analysis: &'a Analysis,
    /// Entries of L and L_F, per front.
    pub(super) slabs: Vec<Vec<Slab>>,
    pivots: Vec<f64>,
    schur: Mat<f64>,
}

/// Inertia of a matrix and its Schur complement, found by elimination without storing L.
#[derive(Debug)]
pub struct Inertia {
    /// Negative eigenvalues of A_II (Sylvester).
    pub negative: usize,
    /// Schur complement S = −A_FI A_II⁻¹ A_IF, lower triangle.
    pub schur: Mat<f64>,
    /// Largest Σ_j L_ij² |D_j| over the rows i of L and L_F: the size of the numbers that were subtracted from each
    /// other. Divided by the largest entry of A it bounds the loss of accuracy without pivoting; 1 where A is positive
    /// definite.
    pub growth: f64,
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
        let keep = |front: &Front, lower: MatRef<'_, f64>, _: &[f64]| Slab::pack(front.start, lower);
        let Elimination { pivots, schur, kept } = eliminate_all(analysis, terms, keep)?;
        Ok(Self { analysis, slabs: kept, pivots, schur })
    }

    /// Diagonal D, in elimination order.
    pub fn pivots(&self) -> &[f64] {
        &self.pivots
    }

    /// Schur complement S = −A_FI A_II⁻¹ A_IF, lower triangle.
    pub fn schur(&self) -> &Mat<f64> {
        &self.schur
    }
}

impl Inertia {
    /// Eliminates Σ factor · matrix over `terms` as [`PartialFactor::new`] does, without storing L.
    pub fn new(analysis: &Analysis, terms: &[(f64, &SparseColMat<usize, f64>)]) -> Result<Self, Breakdown> {
        let row_sums = |_: &Front, lower: MatRef<'_, f64>, pivots: &[f64]| {
            let mut sums = vec![0.0; lower.nrows()];
            for (j, (column, d)) in lower.col_iter().zip(pivots).enumerate() {
                sums[j] += d.abs();
                for (sum, l) in sums.iter_mut().zip(column.iter()).skip(j + 1) {
                    *sum += l * l * d.abs();
                }
            }
            sums
        };
        let Elimination { pivots, schur, kept } = eliminate_all(analysis, terms, row_sums)?;
        let mut sums = vec![0.0; analysis.size];
        for (front, of_front) in analysis.fronts.iter().zip(kept) {
            of_front.iter().enumerate().for_each(|(i, sum)| sums[front.row(i)] += sum);
        }
        Ok(Self {
            negative: pivots.iter().filter(|&&d| d < 0.0).count(),
            schur,
            growth: sums.into_iter().fold(0.0, f64::max),
        })
    }
}

struct Elimination<T> {
    pivots: Vec<f64>,
    schur: Mat<f64>,
    /// Result of `keep` for each front's columns of L.
    kept: Vec<T>,
}

/// Eliminates all fronts; `keep` sees each front's columns of L, pivot rows first, and its part of D.
fn eliminate_all<T: Send + Default>(
    analysis: &Analysis,
    terms: &[(f64, &SparseColMat<usize, f64>)],
    keep: impl Fn(&Front, MatRef<'_, f64>, &[f64]) -> T + Sync,
) -> Result<Elimination<T>, Breakdown> {
    let fronts = &analysis.fronts;
    let mut kept: Vec<T> = (0..fronts.len()).map(|_| T::default()).collect();
    let mut pivots = vec![0.0; analysis.eliminated];
    let mut updates: Vec<Option<Mat<f64>>> = vec![None; fronts.len()];
    let eliminate = |front,
                     child: &mut dyn FnMut(usize) -> Option<Mat<f64>>,
                     positions: &mut eliminate::FrontPositions| {
        let Eliminated { lower, pivots, update } =
            eliminate::eliminate(analysis, front, terms, child, positions)?;
        Ok((keep(&fronts[front], lower.as_ref(), &pivots), pivots, update))
    };

    let run = |positions: &mut eliminate::FrontPositions, subtree: &Vec<usize>| {
        let mut waiting: Vec<Option<Mat<f64>>> = vec![None; subtree.len()];
        let mut done = Vec::with_capacity(subtree.len());
        for (position, &front) in subtree.iter().enumerate() {
            // A subtree is a run of consecutive fronts that ends with its root.
            let (kept, pivots, update) =
                eliminate(front, &mut |child| waiting[child - subtree[0]].take(), positions)?;
            waiting[position] = Some(update);
            done.push((kept, pivots));
        }
        Ok((done, waiting.pop().flatten()))
    };
    let answers: Vec<Result<_, Breakdown>> = analysis
        .subtrees
        .par_iter()
        .map_init(|| eliminate::FrontPositions::new(analysis.size), run)
        .collect();
    let mut store = |front: usize, found: T, of_front: &[f64]| {
        pivots[fronts[front].start..][..of_front.len()].copy_from_slice(of_front);
        kept[front] = found;
    };
    for (subtree, answer) in analysis.subtrees.iter().zip(answers) {
        let (done, update) = answer?;
        for (&front, (found, of_front)) in subtree.iter().zip(done) {
            store(front, found, &of_front);
        }
        if let Some(&root) = subtree.last() {
            updates[root] = update;
        }
    }
    let mut positions = eliminate::FrontPositions::new(analysis.size);
    for &front in &analysis.top {
        let (found, of_front, update) = eliminate(front, &mut |child| updates[child].take(), &mut positions)?;
        store(front, found, &of_front);
        updates[front] = Some(update);
    }
    let schur = eliminate::boundary(analysis, |front| updates[front].take());
    Ok(Elimination { pivots, schur, kept })
}
