//! Half solves with many right-hand sides at once.
//!
//! Right-hand sides are the *rows* of X (`width × size`): all values of one unknown lie together, so gathering and
//! scattering the rows of a front moves contiguous memory.

use faer::linalg::matmul::matmul;
use faer::linalg::triangular_solve::{
    solve_unit_lower_triangular_in_place, solve_unit_upper_triangular_in_place,
};
use faer::prelude::{Reborrow, ReborrowMut};
use faer::{Accum, Mat, MatMut, Par};

use super::factor::PartialFactor;

impl PartialFactor<'_> {
    /// x_I ← L⁻¹ x_I, x_F ← x_F − L_F L⁻¹ x_I for every row of `x`.
    pub fn forward(&self, mut x: MatMut<'_, f64>) {
        let mut scratch = self.scratch(x.nrows());
        for (front, lower) in self.analysis.fronts.iter().zip(&self.lower) {
            let (top, below) = lower.split_at_row(front.pivots);
            let mut pivots = x.rb_mut().subcols_mut(front.start, front.pivots);
            solve_unit_lower_triangular_in_place(top, pivots.rb_mut().transpose_mut(), Par::Seq);
            let mut update = scratch.subcols_mut(0, front.rows.len());
            matmul(update.rb_mut(), Accum::Replace, pivots.rb(), below.transpose(), 1.0, Par::Seq);
            for (i, &row) in front.rows.iter().enumerate() {
                x.rb_mut().col_mut(row).iter_mut().zip(update.rb().col(i).iter()).for_each(|(x, u)| *x -= u);
            }
        }
    }

    /// x_I ← L⁻ᵀ (x_I − L_Fᵀ x_F) for every row of `x`; x_F stays.
    pub fn backward(&self, mut x: MatMut<'_, f64>) {
        let mut scratch = self.scratch(x.nrows());
        for (front, lower) in self.analysis.fronts.iter().zip(&self.lower).rev() {
            let (top, below) = lower.split_at_row(front.pivots);
            let mut known = scratch.subcols_mut(0, front.rows.len());
            for (i, &row) in front.rows.iter().enumerate() {
                known.rb_mut().col_mut(i).copy_from(x.rb().col(row));
            }
            let mut pivots = x.rb_mut().subcols_mut(front.start, front.pivots);
            matmul(pivots.rb_mut(), Accum::Add, known.rb(), below, -1.0, Par::Seq);
            solve_unit_upper_triangular_in_place(top.transpose(), pivots.transpose_mut(), Par::Seq);
        }
    }

    /// Room for the rows below the pivots of any front.
    fn scratch(&self, width: usize) -> Mat<f64> {
        Mat::zeros(width, self.analysis.fronts.iter().map(|front| front.rows.len()).max().unwrap_or(0))
    }
}
