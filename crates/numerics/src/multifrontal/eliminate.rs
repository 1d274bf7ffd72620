//! Elimination of one front: assembles it, eliminates its pivots, passes the update on.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::ldlt::factor::{cholesky_in_place, cholesky_in_place_scratch};
use faer::linalg::matmul::matmul;
use faer::linalg::matmul::triangular::{self, BlockStructure};
use faer::linalg::triangular_solve::solve_unit_lower_triangular_in_place;
use faer::prelude::{Reborrow, ReborrowMut};
use faer::sparse::SparseColMat;
use faer::{Accum, Mat, MatMut, MatRef, Par};
use rayon::iter::{IntoParallelIterator, ParallelIterator};

use super::analysis::{Analysis, Front};
use super::eliminated::{Breakdown, Eliminated};

/// Pivots eliminated at once, and columns updated at once: wide enough for level-3 speed.
const PANEL: usize = 192;

/// Position in a front of each row of the matrix that the front holds.
pub(super) struct FrontPositions(Vec<u32>);

impl FrontPositions {
    pub(super) fn new(size: usize) -> Self {
        Self(vec![u32::MAX; size])
    }

    fn enter(&mut self, front: &Front) {
        for i in 0..front.pivots + front.rows.len() {
            self.0[front.row(i)] = i as u32;
        }
    }

    fn of(&self, row: usize) -> usize {
        self.0[row] as usize
    }
}

/// Eliminates `front`; `child` gives, once, the update of each of its children.
pub(super) fn eliminate(
    analysis: &Analysis,
    front: usize,
    terms: &[(f64, &SparseColMat<usize, f64>)],
    child: &mut dyn FnMut(usize) -> Option<Mat<f64>>,
    positions: &mut FrontPositions,
) -> Result<Eliminated, Breakdown> {
    let front = &analysis.fronts[front];
    let (p, r) = (front.pivots, front.rows.len());
    positions.enter(front);
    let mut lower = Mat::zeros(p + r, p);
    for (factor, matrix) in terms {
        for j in 0..p {
            let column = front.start + j;
            for (row, value) in matrix.row_idx_of_col(column).zip(matrix.val_of_col(column)) {
                if row >= column {
                    lower[(positions.of(row), j)] += factor * value;
                }
            }
        }
    }
    let mut update = Mat::zeros(r, r);
    for &below in &front.children {
        let Some(passed) = child(below) else {
            unreachable!("a child is eliminated once, before its parent")
        };
        let rows: Vec<usize> = analysis.fronts[below].rows.iter().map(|&row| positions.of(row)).collect();
        for (j, &column) in rows.iter().enumerate() {
            let from = passed.col(j);
            if column < p {
                let to = &mut lower.col_mut(column);
                (j..rows.len()).for_each(|i| to[rows[i]] += from[i]);
            } else {
                let to = &mut update.col_mut(column - p);
                (j..rows.len()).for_each(|i| to[rows[i] - p] += from[i]);
            }
        }
    }
    let pivots = factor(lower.as_mut(), front.start)?;
    let below = lower.subrows(p, r);
    let weighted = Mat::from_fn(r, p, |i, j| below[(i, j)] * pivots[j]);
    subtract_product(update.as_mut(), below, weighted.as_ref());
    Ok(Eliminated { lower, pivots, update })
}

/// Schur complement of the boundary: the sum of the updates that reach it.
pub(super) fn boundary(analysis: &Analysis, mut update: impl FnMut(usize) -> Option<Mat<f64>>) -> Mat<f64> {
    let size = analysis.size - analysis.eliminated;
    let mut schur = Mat::zeros(size, size);
    for &root in &analysis.roots {
        let Some(passed) = update(root) else { unreachable!("every root has been eliminated") };
        let rows = &analysis.fronts[root].rows;
        for (j, &column) in rows.iter().enumerate() {
            for (i, &row) in rows.iter().enumerate().skip(j) {
                schur[(row - analysis.eliminated, column - analysis.eliminated)] += passed[(i, j)];
            }
        }
    }
    schur
}

/// Factorises the leading square of `lower` to L D Lᵀ in place, the rows below it carried along. Returns D.
fn factor(mut lower: MatMut<'_, f64>, first_row: usize) -> Result<Vec<f64>, Breakdown> {
    let (m, p) = (lower.nrows(), lower.ncols());
    let mut pivots = Vec::with_capacity(p);
    for start in (0..p).step_by(PANEL) {
        let width = PANEL.min(p - start);
        let (left, right) = lower.rb_mut().split_at_col_mut(start + width);
        let panel = left.subcols_mut(start, width).subrows_mut(start, m - start);
        let (mut diagonal, mut below) = panel.split_at_row_mut(width);
        let scratch = cholesky_in_place_scratch::<f64>(width, Par::Seq, faer::prelude::default());
        let done = cholesky_in_place(
            diagonal.rb_mut(),
            faer::prelude::default(),
            Par::Seq,
            MemStack::new(&mut MemBuffer::new(scratch)),
            faer::prelude::default(),
        );
        let found: Vec<f64> = (0..width).map(|j| diagonal[(j, j)]).collect();
        let broken = found.iter().position(|d| !d.is_normal());
        if let Some(j) = broken.or(done.is_err().then_some(0)) {
            return Err(Breakdown { row: first_row + start + j });
        }
        solve_unit_lower_triangular_in_place(diagonal.rb(), below.rb_mut().transpose_mut(), Par::Seq);
        // L_21 D, then L_21.
        let weighted = below.to_owned();
        for (j, d) in found.iter().enumerate() {
            below.rb_mut().col_mut(j).iter_mut().for_each(|value| *value /= d);
        }
        pivots.extend(found);
        subtract_product(right.subrows_mut(start + width, m - start - width), below.rb(), weighted.as_ref());
    }
    Ok(pivots)
}

/// Computes A ← A − B Cᵀ on and below the diagonal of A, which may have more rows than columns; B has A's rows, C at least as many rows as
/// A has columns. Runs over panels of columns in parallel.
fn subtract_product(a: MatMut<'_, f64>, b: MatRef<'_, f64>, c: MatRef<'_, f64>) {
    if b.ncols() == 0 {
        return;
    }
    let (rows, columns) = (a.nrows(), a.ncols());
    let mut panels = Vec::with_capacity(columns.div_ceil(PANEL));
    let mut rest = a;
    for start in (0..columns).step_by(PANEL) {
        let width = PANEL.min(columns - start);
        let (panel, right) = rest.split_at_col_mut(width);
        panels.push((start, panel.subrows_mut(start, rows - start)));
        rest = right;
    }
    let run = |(start, panel): (usize, MatMut<'_, f64>)| {
        let width = panel.ncols();
        let (square, below) = panel.split_at_row_mut(width);
        let across = c.subrows(start, width).transpose();
        triangular::matmul(
            square,
            BlockStructure::TriangularLower,
            Accum::Add,
            b.subrows(start, width),
            BlockStructure::Rectangular,
            across,
            BlockStructure::Rectangular,
            -1.0,
            Par::Seq,
        );
        let under = b.subrows(start + width, rows - start - width);
        matmul(below, Accum::Add, under, across, -1.0, Par::Seq);
    };
    if panels.len() == 1 {
        panels.into_iter().for_each(run);
    } else {
        panels.into_par_iter().for_each(run);
    }
}
