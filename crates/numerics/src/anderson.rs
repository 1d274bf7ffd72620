//! Anderson acceleration of fixed-point iterations x ← P(x) (Walker and Ni, SIAM J. Numer. Anal. 49, 2011).
//!
//! With residuals f = P(x) − x, the next iterate is the fixed point of a linear model through the last ones:
//!
//! ```text
//! x⁺ = P(x) − Σ_j γ_j ΔP_j,   γ = argmin ‖f − Σ_j γ_j Δf_j‖
//! ```
//!
//! over the differences of consecutive iterates. Where some are linearly dependent, to a tolerance, only part of them is used.

use std::collections::VecDeque;

use faer::prelude::SolveLstsq;
use faer::{Mat, MatRef};

/// Diagonal entry of R, relative to the largest, from which on a difference counts as dependent on those before it.
const SAME: f64 = 1e-10;

/// Accelerator of a fixed-point iteration, with its last iterates.
#[derive(Debug, Clone)]
pub struct Anderson {
    depth: usize,
    last: Option<Iterate>,
    /// Differences of residuals and of images, the oldest first.
    differences: VecDeque<Iterate>,
}

/// A residual and the image it belongs to, or their differences.
#[derive(Debug, Clone)]
struct Iterate {
    residual: Vec<f64>,
    image: Vec<f64>,
}

impl Anderson {
    /// Creates an accelerator that uses the last `depth` differences.
    pub fn new(depth: usize) -> Self {
        Self { depth, last: None, differences: VecDeque::with_capacity(depth) }
    }

    /// Forgets all iterates: the next is the beginning.
    pub fn restart(&mut self) {
        self.last = None;
        self.differences.clear();
    }

    /// Next iterate to map, after `x` was mapped to `image`.
    pub fn next(&mut self, x: &[f64], image: &[f64]) -> Vec<f64> {
        let residual: Vec<f64> = image.iter().zip(x).map(|(image, x)| image - x).collect();
        let this = Iterate { residual, image: image.to_vec() };
        if let Some(last) = self.last.take() {
            if self.differences.len() == self.depth {
                self.differences.pop_front();
            }
            self.differences.push_back(this.minus(&last));
        }
        let weights = self.weights(&this.residual);
        let mut next = this.image.clone();
        for (difference, weight) in self.differences.iter().zip(weights) {
            for (next, difference) in next.iter_mut().zip(&difference.image) {
                *next -= weight * difference;
            }
        }
        self.last = Some(this);
        next
    }

    /// Weights γ of the differences.
    fn weights(&self, residual: &[f64]) -> Vec<f64> {
        let count = self.differences.len();
        let lengths: Vec<f64> = self.differences.iter().map(|one| length(&one.residual)).collect();
        // Of length one each, so that the rank is one of directions. What did not move says nothing.
        let told: Vec<usize> = (0..count).filter(|&j| lengths[j] > 0.0).collect();
        let columns = Mat::from_fn(residual.len(), told.len(), |i, j| {
            self.differences[told[j]].residual[i] / lengths[told[j]]
        });
        let mut weights = vec![0.0; count];
        for (j, weight) in independent(columns.as_ref(), residual) {
            weights[told[j]] = weight / lengths[told[j]];
        }
        weights
    }
}

impl Iterate {
    fn minus(&self, other: &Self) -> Self {
        let minus = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a - b).collect();
        Self { residual: minus(&self.residual, &other.residual), image: minus(&self.image, &other.image) }
    }
}

fn length(values: &[f64]) -> f64 {
    values.iter().map(|value| value * value).sum::<f64>().sqrt()
}

/// Least-squares weights of the linearly independent columns, with the numbers of these columns.
fn independent(columns: MatRef<'_, f64>, wanted: &[f64]) -> Vec<(usize, f64)> {
    if columns.ncols() == 0 {
        return Vec::new();
    }
    let pivoted = columns.col_piv_qr();
    let r = pivoted.thin_R();
    let rank = (0..r.nrows()).take_while(|&j| r[(j, j)].abs() > SAME * r[(0, 0)].abs()).count();
    let (order, _) = pivoted.P().arrays();
    let chosen = Mat::from_fn(columns.nrows(), rank, |i, j| columns[(i, order[j])]);
    let wanted = Mat::from_fn(wanted.len(), 1, |i, _| wanted[i]);
    let weights = chosen.qr().solve_lstsq(&wanted);
    (0..rank).map(|j| (order[j], weights[(j, 0)])).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Turns every pair of neighbours by an angle.
    fn turn(x: &mut [f64], angle: f64) {
        let (sin, cos) = angle.sin_cos();
        for i in 1..x.len() {
            (x[i - 1], x[i]) = (x[i - 1] * cos - x[i] * sin, x[i - 1] * sin + x[i] * cos);
        }
    }

    /// Map x ← A x + b, A being these numbers between two rotations.
    fn affine(stretches: &[f64]) -> impl Fn(&[f64]) -> Vec<f64> {
        move |x| {
            let mut image = x.to_vec();
            turn(&mut image, 0.3);
            image.iter_mut().zip(stretches).for_each(|(x, stretch)| *x = *x * stretch + 1.0);
            turn(&mut image, 0.2);
            image
        }
    }

    fn iterate(map: impl Fn(&[f64]) -> Vec<f64>, size: usize, depth: usize, times: usize) -> f64 {
        let mut anderson = Anderson::new(depth);
        let mut x = vec![0.0; size];
        for _ in 0..times {
            x = anderson.next(&x, &map(&x));
        }
        let off: Vec<f64> = map(&x).iter().zip(&x).map(|(image, x)| image - x).collect();
        length(&off) / length(&x)
    }

    /// Linear problems are solved by as many differences as unknowns, also where iterating alone runs away.
    #[test]
    fn a_linear_map_is_solved_in_as_many_steps_as_it_has_unknowns() {
        for stretches in [[0.9, 0.5, -0.7, 0.1, -0.95], [3.0, -2.0, 0.5, 1.5, -0.1]] {
            assert!(iterate(affine(&stretches), 5, 5, 7) < 1e-11);
        }
    }

    #[test]
    fn more_differences_than_there_are_directions_do_no_harm() {
        assert!(iterate(affine(&[0.9, 0.5]), 2, 10, 12) < 1e-12);
        // One that is at its fixed point from the beginning.
        assert!(iterate(|_| vec![1.0, 2.0], 2, 3, 6) == 0.0);
    }

    /// Scalar equations cos x = x, and x = ½(x + 2/x).
    #[test]
    fn scalar_equations_are_solved() {
        assert!(iterate(|x| vec![x[0].cos(), 0.5 * (x[1] + 2.0 / x[1].max(0.1))], 2, 2, 20) < 1e-12);
    }
}
